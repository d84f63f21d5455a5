#include <gtest/gtest.h>

#include "heated_block.hpp"

namespace layerloop::thermal {
namespace {

Material boiling_metal(double boiling_point, double heat_of_vaporisation, double molar_mass) {
  Material metal = constant_metal(28, 7300, 800);
  metal.boiling_point = boiling_point;
  metal.heat_of_vaporisation = heat_of_vaporisation;
  metal.molar_mass = molar_mass;
  return metal;
}

/// 316L and aluminium, computed apart from the program; the digits given are those that are certain.
TEST(Evaporation, FluxesOfSteelAndAluminium) {
  struct Value {
    double temperature, flux, tolerance;
  };
  Evaporation const steel(boiling_metal(3086, 6.3e6, 0.0558), 1), aluminium(boiling_metal(2743, 10.9e6, 0.02698), 1);
  for (Value const& v : {Value{2600, 2.59e7, 5e4}, Value{2800, 7.98e7, 5e4}, Value{3000, 2.11e8, 5e5},
                         Value{3086, 3.08e8, 5e5}, Value{3500, 1.46e9, 5e6}}) {
    EXPECT_NEAR(steel.flux(v.temperature), v.flux, v.tolerance);
  }
  EXPECT_NEAR(aluminium.flux(2400), 6.7e7, 5e5);
  EXPECT_NEAR(aluminium.flux(2743), 3.9e8, 5e6);
}

/// A cell under constant flux, open at the top, comes to rest where evaporation takes all of it, from below and from
/// above, never past that point, and with any step.
TEST(Evaporation, CellSettlesMonotonicallyWithAnyStep) {
  double const cell = 5e-6;
  Material const metal = boiling_metal(3086, 6.3e6, 0.0558);
  Evaporation const evaporation(metal, 1);
  for (double T : {2600.0, 3000.0, 3400.0, 3900.0}) {
    double const flux = evaporation.flux(T), settling = 7300 * 800 * cell / evaporation.slope(T, flux);
    for (double dt : {1e-3 * settling, 0.1 * settling, 10 * settling, 1e3 * settling}) {
      for (double start : {T - 150, T + 150}) {
        HeatedBlock block(solid_block(cell, {1, 1, 1}), metal);
        std::int64_t const at = block.local(0, 0, 0);
        block.system.sink.evaporation = evaporation;
        block.system.sink.cells.push_back({at, cell * cell, cell * cell * cell});
        block.enthalpy(0, 0, 0) = block.table.enthalpy(start);
        CellPower const source{at, flux * cell * cell};
        double away = std::abs(start - T);
        auto const steps = static_cast<int>(30 * std::max(1.0, settling / dt));
        for (int s = 0; s < steps; ++s) {
          explicit_step(block.system, {&source, 1}, dt);
          double const now = block.temperature(0, 0, 0) - T;
          ASSERT_LE(std::abs(now), away + 1e-6 * T);
          ASSERT_GE(now * (start - T), -1e-6 * T * std::abs(start - T)) << "passed " << T << " K from " << start;
          away = std::abs(now);
        }
        EXPECT_LT(away, 1e-6 * T) << "at " << T << " K from " << start << " K, dt / settling time " << dt / settling;
      }
    }
  }
}

}  // namespace
}  // namespace layerloop::thermal
