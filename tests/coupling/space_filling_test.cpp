#include "coupling/sweep/space_filling.hpp"

#include <gtest/gtest.h>

#include <set>

namespace layerloop::coupling {
namespace {

/// Which of `slices` equal slices of [0, 1) a value lies in.
int slice(double value, int slices) { return static_cast<int>(value * slices); }

TEST(LatinHypercube, HasOnePointInEverySliceOfEveryDimension) {
  for (std::uint64_t const seed : {1, 2, 7}) {
    UnitPoints const points = latin_hypercube(13, 4, seed);
    for (std::size_t d = 0; d < 4; ++d) {
      std::set<int> taken;
      for (auto const& point : points) taken.insert(slice(point[d], 13));
      EXPECT_EQ(taken.size(), 13u) << "dimension " << d;
    }
  }
}

TEST(LatinHypercube, IsThatOfItsSeed) {
  EXPECT_EQ(latin_hypercube(10, 3, 5), latin_hypercube(10, 3, 5));
  EXPECT_NE(latin_hypercube(10, 3, 5), latin_hypercube(10, 3, 6));
}

/// A digital (t, m, 2)-net in base 2 with t = 0: 2^m points, one in each of the 2^m boxes of any shape 2^-a by
/// 2^-(m-a).
TEST(Sobol, FirstTwoDimensionsAreANet) {
  constexpr int m = 6;
  UnitPoints const points = sobol_points(1 << m, 2, 11);
  for (int a = 0; a <= m; ++a) {
    std::set<std::pair<int, int>> taken;
    for (auto const& point : points) taken.emplace(slice(point[0], 1 << a), slice(point[1], 1 << (m - a)));
    EXPECT_EQ(taken.size(), points.size()) << "boxes of 2^-" << a << " by 2^-" << m - a;
  }
}

TEST(Sobol, MorePointsContinueTheSequence) {
  UnitPoints const few = sobol_points(5, 3, 2), many = sobol_points(20, 3, 2);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
}

/// The integral of x y z over the unit cube is 1/8; a plain Monte Carlo estimate from 4096 points is off by some
/// 0.0022.
TEST(Sobol, IntegratesBetterThanChance) {
  double sum = 0;
  UnitPoints const points = sobol_points(4096, 3, 3);
  for (auto const& p : points) sum += p[0] * p[1] * p[2];
  EXPECT_NEAR(sum / static_cast<double>(points.size()), 0.125, 2e-4);
}

}  // namespace
}  // namespace layerloop::coupling
