#include <gtest/gtest.h>

#include <algorithm>

#include "core/material.hpp"
#include "core/optical_constants.hpp"

namespace layerloop {
namespace {

TEST(Material, TableIsLinearBetweenPointsAndConstantBeyond) {
  PropertyTable const table{{300, 400, 600}, {10, 20, 10}};
  EXPECT_EQ(table(350), 15);
  EXPECT_EQ(table(550), 12.5);
  EXPECT_EQ(table(400), 20);
  EXPECT_EQ(table(0), 10);
  EXPECT_EQ(table(9999), 10);
}

TEST(Material, BuiltInMetalsAreComplete) {
  for (auto const& [name, m] : built_in_materials()) {
    EXPECT_EQ(name, m.name);
    EXPECT_FALSE(m.source.empty()) << name;
    EXPECT_LE(m.solidus, m.liquidus) << name;
    EXPECT_LT(m.liquidus, m.boiling_point) << name;
    EXPECT_GT(optical_data(m.optical_data)(1070e-9).imag(), 0) << name;
    for (PropertyTable const* table : {&m.conductivity, &m.specific_heat}) {
      ASSERT_EQ(table->temperature.size(), table->value.size()) << name;
      EXPECT_EQ(std::ranges::adjacent_find(table->temperature, std::greater_equal<>()), table->temperature.end())
          << name;
    }
  }
  for (char const* name : {"IN718", "IN625", "316L", "Ti-6Al-4V", "AlSi10Mg", "Al", "Cu"}) {
    EXPECT_TRUE(built_in_materials().contains(name)) << name;
  }
}

/// Polynomials of the sources: IN718 conductivity (298 to 800 K and 1173 to 1375 K) and specific heat; 316L enthalpy
/// slope 459 + 0.1432 T from 500 to 1250 K.
TEST(Material, TablesFollowTheirSources) {
  Material const& in718 = built_in_materials().at("IN718");
  for (double T = 300; T < 800; T += 50) {
    EXPECT_NEAR(in718.conductivity(T), 5.29 + 0.0152 * T + 1.38e-6 * T * T, 0.05);
    EXPECT_NEAR(in718.specific_heat(T), 362 + 0.2118 * T, 1);
  }
  for (double T = 1175; T < 1375; T += 50) EXPECT_NEAR(in718.conductivity(T), 11.75 + 0.011 * T - 9.3e-7 * T * T, 0.05);
  Material const& steel = built_in_materials().at("316L");
  for (double T = 500; T < 1250; T += 50) EXPECT_NEAR(steel.specific_heat(T), 459 + 0.1432 * T, 1);
}

}  // namespace
}  // namespace layerloop
