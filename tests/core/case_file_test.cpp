#include "core/case_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "core/case_schema.hpp"
#include "core/error.hpp"
#include "core/spelling.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

std::filesystem::path const source_dir = LAYERLOOP_SOURCE_DIR;
std::filesystem::path const example = source_dir / "examples/in718_two_layers.toml";
std::filesystem::path const thesis = source_dir / "tests/bad_input/good/thesis_preset.toml";

Case read_text(std::string const& text) {
  std::filesystem::path const path = std::filesystem::path(testing::TempDir()) / "case_file_test.toml";
  write_file(path, text);
  return read_case(path, {});
}

std::string refusal(std::filesystem::path const& path, std::vector<std::string> const& overrides) {
  try {
    read_case(path, overrides);
  } catch (InputError const& fault) {
    return fault.what();
  }
  return "accepted";
}

TEST(CaseFile, ExampleIsReadInSi) {
  Case const c = read_case(example, {});
  EXPECT_EQ(c.powder.diameters, (std::vector<double>{13e-6, 21e-6, 28e-6, 42e-6}));
  EXPECT_EQ(c.powder.basis, SizeBasis::number);
  EXPECT_EQ(c.powder.particles, 1600);
  EXPECT_EQ(c.contact.youngs_modulus, 2e8);
  EXPECT_EQ(c.contact.wall_friction, c.contact.sliding_friction);
  EXPECT_EQ(c.machine.layer_thickness, 60e-6);
  EXPECT_EQ(c.machine.deposition_begin(), 510e-6);
  EXPECT_EQ(c.laser.wavelength, 1070e-9);
  EXPECT_EQ(c.laser.spot_radius(), 50e-6);
  EXPECT_EQ(c.scan.tracks, 3);
  EXPECT_EQ(c.run.layers, 2);
  EXPECT_TRUE(c.effect_enabled("evaporation"));
  EXPECT_TRUE(c.effect_enabled("latent_heat"));
  EXPECT_FALSE(c.effect_enabled("surface_losses"));
  EXPECT_EQ(c.material.name, "IN718");
  EXPECT_EQ(c.material.density, 8190);
}

TEST(CaseFile, PresetGivesDefaultsThatTheFileOverrides) {
  Case const c = read_case(thesis, {});
  EXPECT_EQ(c.material.density, 9187);
  EXPECT_EQ(c.contact.cohesion_energy_density, 9e4);
  EXPECT_EQ(c.contact.rolling_friction, 0.15);
  EXPECT_EQ(read_case(thesis, {"contact.restitution=0.5"}).contact.restitution, 0.5);
  EXPECT_EQ(read_case(thesis, {"material.IN718.density=8190"}).material.density, 8190);
}

TEST(CaseFile, OverridesComeAfterTheFile) {
  Case const c = read_case(example, {"laser.power=180W", "laser.power=190 W", "run.unsafe_time_step=true",
                                     "powder.diameters=[\"10 um\", 2e-5, \"30 um\", \"40 um\"]", "case.name=two words",
                                     "effects.surface_losses.enabled=true", "material.IN718.emissivity=0.3",
                                     "scan.tracks = 2", "laser.spot_diameter=\"70 um\""});
  EXPECT_EQ(c.laser.power, 190);
  EXPECT_TRUE(c.run.unsafe_time_step);
  EXPECT_EQ(c.powder.diameters.at(1), 2e-5);
  EXPECT_EQ(c.name, "two words");
  EXPECT_TRUE(c.effect_enabled("surface_losses"));
  EXPECT_EQ(c.material.emissivity, 0.3);
  EXPECT_EQ(c.scan.tracks, 2);
  EXPECT_EQ(c.laser.spot_diameter, 70e-6);
}

TEST(CaseFile, FaultsOfOverridesNameTheOption) {
  EXPECT_EQ(refusal(example, {"laser.powr=180W"}),
            "--set laser.powr=180W: unknown key \"powr\" in [laser]; did you mean \"power\"?");
  EXPECT_EQ(refusal(example, {"laser.power=180mm"}),
            "--set laser.power=180mm: laser.power = \"180mm\" is a length (must be a power: W, mW, kW)");
  EXPECT_NE(refusal(example, {"contact.time_step_fraction=0.2"}).find("unsafe_time_step"), std::string::npos);
  EXPECT_EQ(refusal(example, {"contact.time_step_fraction=0.2", "run.unsafe_time_step=true"}), "accepted");
  for (char const* const option : {"", "=", "laser.power", "power=3", ".power=3", "laser.=3", "laser.power=",
                                   "laser.power=[1", "laser.power=\"3 W", "laser.power=1\nrun.layers=3"}) {
    EXPECT_EQ(refusal(example, {option}).rfind("--set ", 0), 0U) << option;
  }
}

TEST(CaseFile, OpticsIndexReplacesTheMaterials) {
  EXPECT_EQ(read_case(example, {"optics.refractive_index=[3.1, 5.2]"}).material.refractive_index,
            std::complex<double>(3.1, 5.2));
}

TEST(CaseFile, SpotRadiusIsThatOfTheIntensity) {
  LaserSettings laser;
  laser.spot_diameter = 80e-6;
  EXPECT_EQ(laser.spot_radius(), 40e-6);
  laser.spot_definition = SpotDefinition::d4sigma;
  EXPECT_EQ(laser.spot_radius(), 40e-6);
  laser.spot_definition = SpotDefinition::fwhm;  // half of the peak where r is half of the diameter
  double const w = laser.spot_radius();
  EXPECT_NEAR(std::exp(-2 * 40e-6 * 40e-6 / (w * w)), 0.5, 1e-14);
}

TEST(CaseFile, ResolvedCaseReadsBackEqual) {
  for (auto const& file : std::filesystem::directory_iterator(source_dir / "tests/bad_input/good")) {
    std::string const resolved =
        resolved_toml(read_case(file.path(), {"laser.absorptivity=0.37", "case.seed=12345678901"}));
    EXPECT_EQ(resolved_toml(read_text(resolved)), resolved) << file.path();  // the text holds every member, exactly
  }
}

TEST(CaseFile, MixtureHasItsMaterialsAndPairs) {
  std::filesystem::path const path = source_dir / "examples/alsi10mg_cu_spread.toml";
  Case const c = read_case(path, {"contact.wall.AlSi10Mg.restitution=0.3", "material.Cu.density=8900"}, Process::spreading);
  ASSERT_EQ(c.materials().size(), 2U);
  EXPECT_EQ(c.materials()[0].name, "AlSi10Mg");
  EXPECT_EQ(c.materials()[1].name, "Cu");
  EXPECT_EQ(c.density(0), 2670);
  EXPECT_EQ(c.density(1), 8900);
  EXPECT_EQ(c.powder.mixture.at("Cu"), 0.04);
  EXPECT_EQ(c.bodies.at("Cu").youngs_modulus, 0.34e9);
  EXPECT_TRUE(std::isinf(c.bodies.at(walls_name).youngs_modulus.value()));
  EXPECT_FALSE(c.bodies.at(walls_name).poisson_ratio.has_value());
  EXPECT_EQ(c.pairs.at({"AlSi10Mg", "Cu"}).restitution, 0.5);
  EXPECT_EQ(c.pairs.at({"Cu", "wall"}).sliding_friction, 0.4);
  EXPECT_EQ(c.pairs.at({"AlSi10Mg", "wall"}).restitution, 0.3);  // the order does not matter

  std::string const resolved = resolved_toml(c);
  std::filesystem::path const again = std::filesystem::path(testing::TempDir()) / "mixture.toml";
  write_file(again, resolved);
  EXPECT_EQ(resolved_toml(read_case(again, {}, Process::spreading)), resolved);
  for (Process const process : {Process::melting, Process::calibrating})
    EXPECT_THROW(read_case(path, {}, process), InputError);
}

TEST(CaseFile, SpreadingNeedsNoLaser) {
  std::filesystem::path const path = source_dir / "tests/loop/spread_small.toml";
  EXPECT_THROW(read_case(path, {}), InputError);
  Case const c = read_case(path, {}, Process::spreading);
  EXPECT_FALSE(c.has_laser());
  EXPECT_FALSE(c.has_part());
  EXPECT_EQ(c.run.replicates, 3);
  EXPECT_DOUBLE_EQ(c.heat.cell_size, 5e-6);  // divides 200 um and 130 um
  EXPECT_DOUBLE_EQ(read_case(path, {"machine.width=126 um"}, Process::spreading).heat.cell_size, 2e-6);
  EXPECT_EQ(read_case(path, {}, std::nullopt).process, Process::spreading);
  EXPECT_EQ(read_case(example, {}, std::nullopt).process, Process::melting);
  EXPECT_TRUE(read_case(example, {}, Process::spreading).heat.cell_size > 0);
  try {
    read_case(path, {"machine.width=130.0007 um"}, Process::spreading);
    FAIL() << "no cell divides such a width";
  } catch (InputError const& fault) {
    EXPECT_NE(std::string(fault.what()).find("cell_size"), std::string::npos) << fault.what();
  }
}

TEST(CaseFile, BedTakesTheFeedsPlaceAndIsSeenFromTheCase) {
  std::filesystem::path const path = source_dir / "tests/loop/spread_small.toml";
  EXPECT_THROW(read_case(path, {"powder.particles=0"}, Process::spreading), InputError);
  Case const c = read_case(path, {"powder.particles=0", "powder.bed=bed.csv"}, Process::spreading);
  EXPECT_EQ(c.powder.bed, (source_dir / "tests/loop/bed.csv").lexically_normal().string());
}

TEST(CaseFile, ResolvedCaseHoldsEveryKey) {
  std::string const resolved = resolved_toml(read_case(
      example, {"laser.absorptivity=0.4", "optics.refractive_index=[3, 5]", "machine.frozen_zone=[6e-4, 8e-4]",
                "machine.blade_friction=0.3", "contact.surface_energy=0.001", "laser.spot_definition=FWHM",
                "optics.grey_reflectance=0.5", "optics.oxide_index=[1.75, 0]", "laser.rayleigh_length=2 mm"}));
  for (CaseKey const& row : case_schema()) {
    if (is_of_names(row)) continue;  // only with names
    EXPECT_NE(resolved.find("\n" + row.key + " = "), std::string::npos) << name_of(row);
  }
}

TEST(CaseFile, SchemaIsSound) {
  std::set<std::string> names;
  for (CaseKey const& row : case_schema()) {
    EXPECT_TRUE(names.insert(name_of(row)).second) << name_of(row) << " has two rows";
    EXPECT_TRUE(row.sentence.ends_with(".")) << name_of(row);
    EXPECT_LE(row.range.min, row.range.max) << name_of(row);
    EXPECT_FALSE(row.range.contains(std::nan(""))) << name_of(row);
    EXPECT_TRUE(row.fallback.empty() || row.need == Need::never) << name_of(row) << " is required and has a default";
  }
}

TEST(CaseFile, MissingFileIsFileTrouble) {
  EXPECT_THROW(read_case("/nowhere/case.toml", {}), FileError);
  EXPECT_THROW(read_case(source_dir, {}), FileError);
}

TEST(CaseFile, PageOfKeysIsUpToDate) {
  EXPECT_TRUE(read_file(source_dir / "docs/case-keys.md") == case_key_page())
      << "run: layerloop check --help-case > docs/case-keys.md";
}

TEST(Spelling, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("powr", "power"), 1);
  EXPECT_EQ(edit_distance("pwoer", "power"), 1);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  std::vector<std::string> const known = {"power", "n", "wavelength"};
  EXPECT_EQ(likely_name("powr", known), "power");
  EXPECT_EQ(likely_name("wavelneght", known), "wavelength");
  EXPECT_EQ(likely_name("foo", known), std::nullopt);  // "n" is near in edits, yet no guess
}

}  // namespace
}  // namespace layerloop
