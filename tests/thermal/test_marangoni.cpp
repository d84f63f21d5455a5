#include <gtest/gtest.h>

#include "heated_block.hpp"
#include "thermal/bulk_flow.hpp"
#include "thermal/effects/marangoni.hpp"

namespace layerloop::thermal {
namespace {

/// Rise of enthalpy in one short explicit step of the cell in the middle of a bar of three liquid cells along an axis,
/// which lie 100 K apart and the last 50 K.
double rise(std::size_t axis, double strength) {
  std::array<std::int32_t, 3> n{1, 1, 1};
  n[axis] = 3;
  HeatedBlock bar(solid_block(5e-6, n), constant_metal(24, 7300, 789));
  bar.system.conduction.liquid = marangoni(bar.table, strength, 3, 1.5);
  std::int32_t m = 0;
  for (double const T : {2000.0, 2100.0, 2150.0}) {
    std::array<std::int32_t, 3> at{0, 0, 0};
    at[axis] = m++;
    bar.enthalpy(at[0], at[1], at[2]) = bar.table.enthalpy(T);
  }
  finish_step(bar.system, 0);
  std::array<std::int32_t, 3> middle{0, 0, 0};
  middle[axis] = 1;
  double const before = bar.enthalpy(middle[0], middle[1], middle[2]);
  explicit_step(bar.system, {}, 1e-9);
  return bar.enthalpy(middle[0], middle[1], middle[2]) - before;
}

TEST(Marangoni, LiquidConductsAsMuchBetterAlongEachDirection) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double const table = rise(axis, 0), factor = axis == 2 ? 1.5 : 3;
    EXPECT_NEAR(rise(axis, 1) / table, factor, 1e-9) << axis;
    EXPECT_NEAR(rise(axis, 0.25) / table, 1 + 0.25 * (factor - 1), 1e-9) << axis;
  }
}

/// Heat of a point in an anisotropic liquid spreads as <x^2> = 2 a t times the factor of the direction.
TEST(Marangoni, SpreadGrowsWithTheFactorOfItsDirection) {
  HeatedBlock block(solid_block(5e-6, {31, 31, 31}), constant_metal(24, 7300, 789), {infinite, infinite}, 0,
                    SideY::adiabatic, 9000);
  block.system.conduction.liquid = marangoni(block.table, 1, 3, 1.5);
  double const base = block.table.enthalpy(2000);
  block.for_cells([&](auto i, auto j, auto k, Vec3 const&) { block.enthalpy(i, j, k) = base; });
  block.enthalpy(15, 15, 15) += 3e9;
  finish_step(block.system, 0);
  double const dt = 0.9 * stable_step(block.system.conduction, block.table);
  int const steps = 40;
  for (int s = 0; s < steps; ++s) explicit_step(block.system, {}, dt);
  double const a = 24 / (7300.0 * 789), t = steps * dt;
  std::array<double, 3> moment{};
  double sum = 0;
  block.for_cells([&](auto i, auto j, auto k, Vec3 const&) {
    double const excess = block.enthalpy(i, j, k) - base;
    std::array<std::int32_t, 3> const at{i, j, k};
    for (std::size_t axis = 0; axis < 3; ++axis) moment[axis] += excess * std::pow((at[axis] - 15) * 5e-6, 2);
    sum += excess;
  });
  EXPECT_NEAR(sum, 3e9, 1e-6 * 3e9);
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(moment[axis] / sum, 2 * (axis == 2 ? 1.5 : 3) * a * t, 0.01 * 2 * a * t) << axis;
}

}  // namespace
}  // namespace layerloop::thermal
