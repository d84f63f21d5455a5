#include "raytrace/beam.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace layerloop::raytrace {
namespace {

TEST(Beam, GaussianHoldsTheSharesOfItsDefinition) {
  // Inside radius r: 1 - exp(-2 r^2/w^2); standard deviation of each coordinate: w/2.
  Beam const beam{.centre = {3, -2, 0}, .power = 1, .radius = 5};
  std::int64_t const points = 1 << 16;
  double inside = 0, squares = 0, mean_x = 0;
  for (std::int64_t i = 0; i < points; ++i) {
    auto const p = ray_start(beam, i, {0.3, 0.8});
    inside += std::hypot(p[0] - 3, p[1] + 2) < 5;
    squares += (p[1] + 2) * (p[1] + 2);
    mean_x += p[0];
  }
  EXPECT_NEAR(inside / points, 1 - std::exp(-2.0), 1e-4);
  EXPECT_NEAR(squares / points, 6.25, 6.25e-3);
  EXPECT_NEAR(mean_x / points, 3, 2e-3);
}

TEST(Beam, UniformFillsItsRectangleEvenly) {
  Beam const beam{.centre = {1, 1, 0}, .power = 1, .profile = BeamProfile::uniform, .size_x = 2, .size_y = 2};
  int quarter = 0;
  for (std::int64_t i = 0; i < 4096; ++i) {
    auto const p = ray_start(beam, i, {0.1, 0.2});
    ASSERT_TRUE(p[0] >= 0 && p[0] <= 2 && p[1] >= 0 && p[1] <= 2);
    quarter += p[0] < 1 && p[1] < 1;
  }
  EXPECT_NEAR(quarter / 4096.0, 0.25, 2e-3);
}

}  // namespace
}  // namespace layerloop::raytrace
