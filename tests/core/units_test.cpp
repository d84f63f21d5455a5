#include "core/units.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"

namespace layerloop {
namespace {

TEST(Units, TextBecomesTheNearestSiNumber) {
  EXPECT_EQ(parse_quantity("30 um", Dimension::length), 30e-6);
  EXPECT_EQ(parse_quantity("13um", Dimension::length), 13e-6);
  EXPECT_EQ(parse_quantity(" 1070  nm ", Dimension::length), 1070e-9);
  EXPECT_EQ(parse_quantity("+0.2 GPa", Dimension::pressure), 0.2e9);
  EXPECT_EQ(parse_quantity("90000 J/m^3", Dimension::energy_density), 90000.0);
  EXPECT_EQ(parse_quantity("800 mm/s", Dimension::speed), 0.8);
  EXPECT_EQ(parse_quantity("1.5e-3 s", Dimension::time), 1.5e-3);
  EXPECT_EQ(parse_quantity("8.19 g/cm3", Dimension::density), 8190.0);
  EXPECT_EQ(parse_quantity("11 W/(m*K)", Dimension::conductivity), 11.0);
  EXPECT_EQ(parse_quantity("435 J/(kg K)", Dimension::specific_heat), 435.0);
  EXPECT_EQ(parse_quantity("210 kJ/kg", Dimension::specific_energy), 210e3);
  EXPECT_EQ(parse_quantity("58.7 g/mol", Dimension::molar_mass), 58.7e-3);
  EXPECT_EQ(parse_quantity("25 degC", Dimension::temperature), 298.15);
  EXPECT_EQ(parse_quantity("30 %", Dimension::none), 0.3);
  EXPECT_DOUBLE_EQ(parse_quantity("180 deg", Dimension::angle), std::numbers::pi);
}

/// What a text is refused for.
std::string refusal(std::string_view text, Dimension dimension) {
  try {
    parse_quantity(text, dimension);
  } catch (InputError const& fault) {
    return fault.what();
  }
  return "accepted";
}

TEST(Units, RefusalsNameUnitsThatFit) {
  EXPECT_EQ(refusal("200 um", Dimension::power), "\"200 um\" is a length (must be a power: W, mW, kW)");
  EXPECT_EQ(refusal("200", Dimension::power), "\"200\" has no unit (must be a power: W, mW, kW)");
  EXPECT_EQ(refusal("200 Watt", Dimension::power),
            "\"200 Watt\" has the unknown unit \"Watt\" (must be a power: W, mW, kW)");
  EXPECT_EQ(refusal("0,2 GPa", Dimension::pressure), "\"0,2 GPa\" has a decimal comma (must be a point)");
  for (std::string_view const text :
       {"", " ", "um", "nan um", "inf um", "1e999 um", "--3 um", "+-3 um", "0x1p3 um", "3 u m m"}) {
    EXPECT_NE(refusal(text, Dimension::length), "accepted") << text;
  }
}

TEST(Units, ValuesAreShownInTheUnitPeopleUse) {
  EXPECT_EQ(format_quantity(30e-6, Dimension::length), "30 um");
  EXPECT_EQ(format_quantity(1e-6, Dimension::length), "1 um");
  EXPECT_EQ(format_quantity(999.9e-9, Dimension::length), "999.9 nm");
  EXPECT_EQ(format_quantity(-2e-3, Dimension::length), "-2 mm");
  EXPECT_EQ(format_quantity(0, Dimension::length), "0 m");
  EXPECT_EQ(format_quantity(0.1, Dimension::speed), "100 mm/s");
  EXPECT_EQ(format_quantity(2e8, Dimension::pressure), "200 MPa");
  EXPECT_EQ(format_quantity(3.592e-8, Dimension::time), "35.92 ns");
  EXPECT_EQ(format_quantity(8190, Dimension::density), "8190 kg/m3");
  EXPECT_EQ(format_quantity(0.7, Dimension::none), "0.7");
  EXPECT_EQ(format_quantity(std::numbers::pi, Dimension::angle), "180 deg");
}

TEST(Units, ShownValuesReadBack) {
  for (Dimension const dimension :
       {Dimension::length, Dimension::speed, Dimension::time, Dimension::mass, Dimension::density, Dimension::pressure,
        Dimension::energy_density, Dimension::power, Dimension::temperature, Dimension::angle, Dimension::conductivity,
        Dimension::specific_heat, Dimension::specific_energy, Dimension::molar_mass, Dimension::none}) {
    for (double const value : {1.234e-7, 4.5e-5, 0.6789, 12.5, 98765.0, 4.2e8}) {
      EXPECT_NEAR(parse_quantity(format_quantity(value, dimension), dimension), value, 5e-4 * value);
    }
  }
}

}  // namespace
}  // namespace layerloop
