#include "coupling/pool_overlap.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace layerloop::coupling {
namespace {

constexpr std::array patterns{HatchPattern::aligned, HatchPattern::shifted, HatchPattern::rotated};

PoolArray pools(double width, double depth, double hatch, double layer) {
  return {.width = 1e-6 * width, .depth = 1e-6 * depth, .hatch_spacing = 1e-6 * hatch, .layer_thickness = 1e-6 * layer};
}

/// Points thrown into the bottom layer of a stack, each held against every ellipse of every layer above.
double thrown(PoolArray const& array, HatchPattern pattern, int count) {
  std::mt19937_64 bits(7);
  std::uniform_real_distribution<double> unit(0, 1);
  double const h = array.hatch_spacing, L = array.layer_thickness;
  int missed = 0;
  for (int n = 0; n < count; ++n) {
    double const y = h * unit(bits), z = -L * unit(bits);
    bool hit = false;
    for (int layer = 0; layer * L < array.depth; ++layer) {
      double phase = 0;
      if (pattern == HatchPattern::shifted) phase = 0.5 * h * layer;
      if (pattern == HatchPattern::rotated) phase = h * unit(bits);
      for (int track = -40; track <= 40; ++track) {
        double const across = (y - phase - track * h) / (0.5 * array.width), down = (z - layer * L) / array.depth;
        hit = hit || across * across + down * down < 1;
      }
    }
    missed += hit ? 0 : 1;
  }
  return static_cast<double>(missed) / count;
}

TEST(PoolOverlap, NumberIsThatOfTangAndInfiniteWithoutAPool) {
  EXPECT_NEAR(overlap_number(pools(150, 100, 90, 60)), 0.36 + 0.36, 1e-12);
  EXPECT_EQ(overlap_number(pools(0, 0, 90, 30)), std::numeric_limits<double>::infinity());
  for (HatchPattern const pattern : patterns) EXPECT_EQ(unmelted_share(pools(0, 0, 90, 30), pattern), 1);
}

TEST(PoolOverlap, NothingStaysUnmeltedUpToOne) {
  for (double const ratio : {0.3, 0.6, 0.9}) {  // hatch over width, with the depth that gives Q = 1
    double const depth = 30 / std::sqrt(1 - ratio * ratio);
    PoolArray const deep = pools(100, 1.0001 * depth, 100 * ratio, 30),
                    shallow = pools(100, 0.99 * depth, 100 * ratio, 30);
    for (HatchPattern const pattern : patterns) EXPECT_EQ(unmelted_share(deep, pattern), 0);
    for (HatchPattern const pattern : {HatchPattern::aligned, HatchPattern::rotated}) {
      EXPECT_GT(unmelted_share(shallow, pattern), 0);
      EXPECT_LT(unmelted_share(shallow, pattern), 1e-2);
    }
  }
}

TEST(PoolOverlap, ShiftedTracksCloseTheJointsBelowThem) {
  // At the bottom of a layer pools of Q = 1.12 cover 0.87 of it, those of the next layer, under the joints, 0.14 more.
  PoolArray const array = pools(150, 61, 150, 21.3);
  ASSERT_GT(overlap_number(array), 1.1);
  EXPECT_EQ(unmelted_share(array, HatchPattern::shifted), 0);
  EXPECT_GT(unmelted_share(array, HatchPattern::aligned), 0);
  EXPECT_GT(unmelted_share(array, HatchPattern::rotated), 0);
}

TEST(PoolOverlap, SeparateShallowPoolsLeaveWhatTheyDoNotCover) {
  // Apart from one another and no deeper than a layer: half an ellipse, pi W D / 4, of every h L.
  double const covered = std::numbers::pi * 80 * 25 / 4 / (200 * 30);
  for (HatchPattern const pattern : patterns)
    EXPECT_NEAR(unmelted_share(pools(80, 25, 200, 30), pattern), 1 - covered, 1e-9);
}

TEST(PoolOverlap, DeepPoolsThatDoNotTouchLeaveStrips) {
  // Walls nearly upright over the layer: W / h in aligned layers, twice that when shifted.
  EXPECT_NEAR(unmelted_share(pools(40, 3e4, 200, 30), HatchPattern::aligned), 1 - 0.2, 1e-6);
  EXPECT_NEAR(unmelted_share(pools(40, 3e4, 200, 30), HatchPattern::shifted), 1 - 0.4, 1e-6);
  // Two layers deep, rotated: the second pool finds what the first one left.
  double const below = std::sqrt(1 - 0.25);  // at the layer's boundary, where the pool is two layers deep
  double const share = unmelted_share(pools(40, 60, 200, 30), HatchPattern::rotated);
  EXPECT_LT(share, 1 - 0.2 * below);
  EXPECT_GT(share, (1 - 0.2) * (1 - 0.2));
}

TEST(PoolOverlap, AgreesWithThrownPoints) {
  constexpr int count = 40000;
  for (HatchPattern const pattern : patterns)
    for (PoolArray const& array : {pools(120, 50, 130, 30), pools(150, 35, 130, 30), pools(60, 200, 150, 40),
                                   pools(90, 45, 170, 60), pools(110, 140, 130, 90)}) {
      double const expected = thrown(array, pattern, count), found = unmelted_share(array, pattern);
      double const error = std::sqrt(std::max(expected * (1 - expected), 1.0 / count) / count);
      EXPECT_NEAR(found, expected, 4 * error) << "width " << array.width << " depth " << array.depth;
    }
}

TEST(PoolOverlap, QuadratureMeetsTheClosedFormWhereLayersDoNotReachEachOther) {
  // Pools no deeper than a layer: the pattern cannot matter, and the aligned closed form must come out of all.
  for (double const width : {80.0, 140.0, 300.0}) {
    PoolArray const array = pools(width, 28, 120, 30);
    double const exact = unmelted_share(array, HatchPattern::aligned);
    EXPECT_NEAR(unmelted_share(array, HatchPattern::shifted), exact, 1e-9);
    EXPECT_NEAR(unmelted_share(array, HatchPattern::rotated), exact, 1e-9);
  }
}

TEST(PoolOverlap, PatternsThatSpreadTheTracksLeaveLess) {
  for (double const depth : {35.0, 60.0, 120.0}) {
    PoolArray const array = pools(100, depth, 140, 30);
    double const aligned = unmelted_share(array, HatchPattern::aligned);
    EXPECT_LT(unmelted_share(array, HatchPattern::rotated), aligned);
    EXPECT_LT(unmelted_share(array, HatchPattern::shifted), aligned);
    EXPECT_DOUBLE_EQ(relative_density(array, HatchPattern::aligned), 1 - aligned);
  }
}

}  // namespace
}  // namespace layerloop::coupling
