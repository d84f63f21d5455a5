#include "core/cell_content.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/compensated_sum.hpp"

namespace layerloop {
namespace {

PowderBed one_grain(Vec3 const& centre, double radius) {
  PowderBed bed;
  bed.add(0, centre, radius, 0);
  return bed;
}

double sum(std::vector<GrainShare> const& shares) {
  CompensatedSum total;
  for (GrainShare const& s : shares) total.add(s.volume);
  return total.value();
}

TEST(GrainShares, SumToTheVolumeOfTheSphere) {
  VoxelGrid const grid{Vec3(-50e-6, 0, -50e-6), 5e-6, {20, 20, 20}};
  for (double radius : {1e-7, 6.5e-6, 10.5e-6, 21e-6}) {
    PowderBed const bed = one_grain(Vec3(1.3e-6, 51.7e-6, 2.9e-6), radius);
    EXPECT_NEAR(sum(grain_shares(bed, 0, grid, 0)) / bed.volume(0), 1, 1e-15) << radius;
  }
}

/// A sphere centred on a corner of the lattice: every cell of one octant is known from its mirror images, and the cap
/// above a lattice plane has the closed form pi h^2 (3 r - h) / 3.
TEST(GrainShares, CapsHaveTheirClosedFormVolume) {
  VoxelGrid const grid{Vec3::Zero(), 5e-6, {20, 20, 20}};
  double const r = 21e-6;
  PowderBed const bed = one_grain(Vec3(50e-6, 50e-6, 50e-6), r);
  std::array<std::map<std::int32_t, double>, 3> slice;
  for (GrainShare const& s : grain_shares(bed, 0, grid, 0)) {
    for (std::size_t a = 0; a < 3; ++a) slice[a][grid.coordinates(s.cell)[a]] += s.volume;
  }
  auto const cap = [&](double h) { return h > 0 ? std::numbers::pi * h * h * (3 * r - h) / 3 : 0.0; };
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::int32_t layer = 10; layer < 15; ++layer) {
      double const low = (layer - 10) * 5e-6, expected = cap(r - low) - cap(r - low - 5e-6);
      EXPECT_NEAR(slice[a][layer], expected, 2e-3 * bed.volume(0)) << "axis " << a << " layer " << layer;
      EXPECT_NEAR(slice[a][layer], slice[a][19 - layer], 1e-12 * bed.volume(0));
    }
  }
}

TEST(GrainShares, WrapAroundThePeriod) {
  VoxelGrid const grid{Vec3::Zero(), 5e-6, {20, 10, 20}};
  PowderBed const middle = one_grain(Vec3(50e-6, 25e-6, 50e-6), 12e-6),
                  border = one_grain(Vec3(50e-6, 0, 50e-6), 12e-6);
  std::vector<GrainShare> const a = grain_shares(middle, 0, grid, 50e-6), b = grain_shares(border, 0, grid, 50e-6);
  EXPECT_NEAR(sum(b) / border.volume(0), 1, 1e-15);
  std::map<std::int64_t, double> moved;
  for (GrainShare const& s : b) {
    auto const c = grid.coordinates(s.cell);
    moved[grid.index(c[0], (c[1] + 5) % 10, c[2])] = s.volume;
  }
  ASSERT_EQ(moved.size(), a.size());
  for (GrainShare const& s : a) EXPECT_NEAR(moved[s.cell], s.volume, 1e-12 * middle.volume(0));
  for (std::size_t s = 1; s < b.size(); ++s) EXPECT_LT(b[s - 1].cell, b[s].cell);
}

TEST(GrainShares, LeaveOutWhatLiesBeyondTheGrid) {
  VoxelGrid const grid{Vec3::Zero(), 5e-6, {20, 20, 20}};
  PowderBed const half_outside = one_grain(Vec3(0, 50e-6, 50e-6), 12e-6);
  EXPECT_NEAR(sum(grain_shares(half_outside, 0, grid, 0)) / half_outside.volume(0), 0.5, 1e-12);
  EXPECT_TRUE(grain_shares(one_grain(Vec3(-20e-6, 50e-6, 50e-6), 12e-6), 0, grid, 0).empty());
}

}  // namespace
}  // namespace layerloop
