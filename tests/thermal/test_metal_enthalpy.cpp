#include <gtest/gtest.h>

#include "core/material.hpp"
#include "thermal/enthalpy_table.hpp"

namespace layerloop::thermal {
namespace {

/// Enthalpy of 316L above 298 K [kJ/kg] as the heat solver has it.
double steel_enthalpy(double T) {
  static Material const steel = built_in_materials().at("316L");
  static EnthalpyTable const table(steel, 298, 3000);
  return table.enthalpy(T) / steel.density * 1e-3;
}

/// Fits to the pulse-heated wires and calorimetry of Pichler et al. 2020, uncertainty 2.5 to 2.9 %. Below 600 K the
/// first fit, that does not pass through zero at 298 K (4 kJ/kg), is held to that.
TEST(MetalEnthalpy, SteelFollowsPichler) {
  for (double T = 500; T <= 1250; T += 50) {
    double const fit = -139 + 0.459 * T + 7.16e-5 * T * T;
    EXPECT_NEAR(steel_enthalpy(T), fit, std::max(4.3, 0.025 * fit)) << T;
  }
  for (double T = 1350; T <= 1670; T += 20) EXPECT_NEAR(steel_enthalpy(T) / (-374 + 0.714 * T), 1, 0.025) << T;
  for (double T = 1710; T <= 2900; T += 70) EXPECT_NEAR(steel_enthalpy(T) / (-335 + 0.847 * T), 1, 0.01) << T;
}

/// From 822 kJ/kg at the solidus to 1112 at the liquidus: 290 for all of melting, specific heat included.
TEST(MetalEnthalpy, SteelMeltsFrom822To1112) {
  Material const& steel = built_in_materials().at("316L");
  EXPECT_NEAR(steel_enthalpy(1675), 822, 0.0125 * 822);
  EXPECT_NEAR(steel_enthalpy(1708), 1112, 0.01 * 1112);
  EXPECT_NEAR(steel_enthalpy(1708) - steel_enthalpy(1675), 1111.7 - 822.0, 1);
  EXPECT_NEAR(steel.latent_heat * 1e-3 + 33 * 0.5 * (0.714 + 0.847), 290, 1);
}

/// The diffusivity sets the explicit step: no property may make it jump. 316L: that of its hottest melt, k / (rho cp).
TEST(MetalEnthalpy, HottestMeltLimitsTheStep) {
  Material const& steel = built_in_materials().at("316L");
  EXPECT_NEAR(EnthalpyTable(steel, 298, 3000).max_diffusivity() / (41 / (7904 * 847.0)), 1, 0.01);
}

}  // namespace
}  // namespace layerloop::thermal
