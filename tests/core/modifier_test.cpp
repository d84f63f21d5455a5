// [modifiers.NAME]: formulas in the case file.
#include "core/modifier.hpp"

#include <gtest/gtest.h>

#include "core/case_file.hpp"
#include "core/error.hpp"

namespace layerloop {
namespace {

std::string const track = R"case(
[powder]
material = "316L"
[laser]
power = "48 W"
wavelength = "1070 nm"
spot_diameter = "60 um"
spot_definition = "1/e2"
absorptivity = 0.3
[scan]
kind = "track"
scan_speed = "500 mm/s"
track_length = "600 um"
)case";

Case read(std::string const& modifiers, std::vector<std::string> const& set = {}) {
  return case_of_text(track + modifiers, "track.toml", set, Process::exposing);
}

std::string const hot = R"case([modifiers.hot]
target = "material.conductivity"
expression = "k*(1 + s*(T - 300)/1000)"
)case";

TEST(Modifier, PutsTheFormulaInThePlaceOfTheTable) {
  Case const checked = read(hot + "strength = 0.5\n");
  Material const metal = modified_material(checked);
  for (double const T : {298.0, 300.0, 1000.0, 1312.5, 1708.0, 2800.0, 4000.0})
    EXPECT_NEAR(metal.conductivity(T), checked.material.conductivity(T) * (1 + 0.5 * (T - 300) / 1000), 0.02) << T;
  EXPECT_EQ(metal.specific_heat.value, checked.material.specific_heat.value);
}

TEST(Modifier, AtStrengthZeroOrOffEveryBitIsAsWithout) {
  for (char const* null : {"strength = 0\n", "enabled = false\n"}) {
    Case const checked = read(hot + null);
    EXPECT_EQ(modified_material(checked).conductivity.value, read("").material.conductivity.value);
    EXPECT_EQ(modified_material(checked).conductivity.temperature, read("").material.conductivity.temperature);
  }
  EXPECT_FALSE(ModifiedAbsorption(read(hot)).acts());
}

TEST(Modifier, ChangesTheAbsorbedPower) {
  ModifiedAbsorption const cleaned(read(R"case([modifiers.cleaning]
target = "laser.absorbed_power"
expression = "absorbed*(1 - s*v) + 0*t*x*y*incident"
strength = 0.2
)case"));
  ASSERT_TRUE(cleaned.acts());
  EXPECT_DOUBLE_EQ(cleaned({.incident = 100, .absorbed = 40, .speed = 0.5}), 36);
  EXPECT_THROW(cleaned({.incident = 100, .absorbed = 40, .speed = -10}), InputError) << "120 W of 100 W";
}

TEST(Modifier, StandsInTheResolvedCase) {
  Case const checked = read(hot, {"modifiers.hot.strength=0.25"});
  std::string const resolved = resolved_toml(checked);
  Case const again = case_of_text(resolved, "resolved.toml", {}, Process::exposing);
  EXPECT_EQ(resolved_toml(again), resolved);
  EXPECT_EQ(again.modifiers.at("hot").strength, 0.25);
  EXPECT_EQ(again.modifiers.at("hot").expression, "k*(1 + s*(T - 300)/1000)");
}

std::string fault(std::string const& modifiers) {
  try {
    read(modifiers);
  } catch (InputError const& error) {
    return error.what();
  }
  return "";
}

TEST(Modifier, FaultsAreNamedAtTheirLine) {
  std::string const target = "[modifiers.m]\ntarget = \"material.conductivity\"\n";
  auto const at = [](int line) { return "track.toml:" + std::to_string(line) + ":"; };
  EXPECT_NE(fault(target + "expression = \"k*(1+\"\n").find(at(16)), std::string::npos);
  EXPECT_NE(fault(target + "expression = \"k*q\"\n").find("names \"q\" (known here: k, s, T)"), std::string::npos);
  EXPECT_NE(fault(target).find("missing key \"expression\" in [modifiers.m]"), std::string::npos);
  EXPECT_NE(fault("[modifiers.m]\ntarget = \"material.colour\"\nexpression = \"1\"\n").find("must be one of"),
            std::string::npos);
  EXPECT_NE(fault("[modifiers.keyhole]\ntarget = \"material.conductivity\"\nexpression = \"k\"\n")
                .find("has the name of an effect"),
            std::string::npos);
  EXPECT_NE(fault(hot + "strengh = 1\n").find("did you mean \"strength\"?"), std::string::npos);
}

TEST(Modifier, MustLeaveThePropertyPositive) {
  EXPECT_THROW(modified_material(read(hot + "strength = -10\n")), InputError);
}

}  // namespace
}  // namespace layerloop
