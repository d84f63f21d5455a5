#include "coupling/melt_study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;

/// The metal and beam of the reference pool, 60 W absorbed of 100 W: nothing but conduction.
constexpr char const* reference = R"(
[powder]
material = "constant"
[material.constant]
density = 7300
conductivity = 24
specific_heat = 789
latent_heat = 1e3
solidus = 1707
liquidus = 1708
boiling_point = 8000
heat_of_vaporisation = 6e6
molar_mass = 0.056
emissivity = 0
source = "Eagar and Tsai's half space"
[laser]
power = 100
absorptivity = 0.6
wavelength = "1070 nm"
spot_diameter = "80 um"
spot_definition = "D4sigma"
[scan]
kind = "track"
scan_speed = 0.8
track_length = "600 um"
[heat]
cell_size = "5 um"
ambient_temperature = 298
[effects.latent_heat]
enabled = false
)";

/// Exposes the reference with changes, in a folder of its own that goes away.
MeltStudy study_of(std::vector<std::string> const& changes) {
  fs::path const folder = fs::temp_directory_path() / ("layerloop_melt_" + std::to_string(::getpid()));
  Case const checked = case_of_text(reference, "reference.toml", changes, Process::exposing);
  MeltStudy study = run_melt(checked, {.folder = folder, .bed = {}, .quiet = true}, Communicator());
  for (char const* file : {"summary.json", "sections.csv", "tracks.csv", "probe.csv", "report.html", "heat_0001.h5",
                           "case_resolved.toml", "log.jsonl"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  fs::remove_all(folder);
  return study;
}

/// Eagar and Tsai, integrated elsewhere to 1e-4 um: 102.0976 x 41.1274 x 302.5155 um.
TEST(Melt, ReferencePoolOnAPlateThatItChooses) {
  MeltStudy const study = study_of({"scan.track_length=\"1000 um\""});
  PoolSize const pool = study.melted.heat.melt.pool;
  std::printf("width %.3f depth %.3f length %.3f um, edge %.0f K\n", pool.width * 1e6, pool.depth * 1e6,
              pool.length * 1e6, study.melted.heat.peak_temperature);
  EXPECT_NEAR(pool.width, 102.0976e-6, 1e-6);
  EXPECT_NEAR(pool.depth, 41.1274e-6, 1e-6);
  EXPECT_NEAR(pool.length, 302.5155e-6, 0.015 * 302.5e-6);
  EXPECT_EQ(study.regime, Regime::transition) << "what boils is shallower than the spot radius";
  EXPECT_LT(study.melted.heat.heat_energy_relative_error, 1e-10);
}

TEST(Melt, PoolDoesNotDependOnTheDirectionOfTheTrack) {
  PoolSize const along_x = study_of({}).melted.heat.melt.pool;
  for (auto const& [turn, share] : {std::pair{"90 deg", 1e-9}, std::pair{"45 deg", 0.015}}) {
    PoolSize const turned = study_of({std::string("scan.direction=") + turn}).melted.heat.melt.pool;
    std::printf("%s: width %.3f of %.3f, depth %.3f of %.3f, length %.3f of %.3f um\n", turn, 1e6 * turned.width,
                1e6 * along_x.width, 1e6 * turned.depth, 1e6 * along_x.depth, 1e6 * turned.length,
                1e6 * along_x.length);
    EXPECT_NEAR(turned.width, along_x.width, share * along_x.width);
    EXPECT_NEAR(turned.depth, along_x.depth, share * along_x.depth);
    EXPECT_NEAR(turned.length, along_x.length, share * along_x.length);
  }
}

TEST(Melt, SecondGridTellsTheErrorOfTheFirst) {
  MeltStudy const study = study_of({"melt.two_grids=true", "heat.cell_size=\"7 um\""});
  ASSERT_TRUE(study.second_grid);
  PoolSize const pool = study.melted.heat.melt.pool;
  EXPECT_NEAR(study.u_num.depth, std::abs(study.second_grid->pool.depth - pool.depth) / 1.25, 0.1e-6)
      << "sections hardly differ";
  EXPECT_LT(std::abs(pool.depth - 41.1274e-6), 3 * study.u_num.depth + 0.5e-6);
}

/// A formula of the user's acts on what an effect that is switched off leaves, not under it.
TEST(Melt, ModifierActsWithoutVariableConductivity) {
  std::vector<std::string> const changes{"heat.cell_size=\"7 um\"", "effects.variable_conductivity.enabled=false"};
  auto const pool_with = [&](std::vector<std::string> more) {
    more.insert(more.end(), changes.begin(), changes.end());
    return study_of(more).melted.heat.melt.pool;
  };
  PoolSize const by_formula =
      pool_with({"modifiers.better.target=material.conductivity", "modifiers.better.expression=\"1.5*k\""});
  PoolSize const better = pool_with({"material.constant.conductivity=36"});
  EXPECT_NEAR(by_formula.width, better.width, 5e-8) << "its table has other steps";
  EXPECT_NEAR(by_formula.depth, better.depth, 5e-8);
  EXPECT_GT(std::abs(better.width - pool_with({}).width), 1e-6);
}

/// One layer of some fifty soft grains, and a track on it.
constexpr char const* layer = R"(
[powder]
material = "316L"
basis = "number"
diameters = ["26 um"]
fractions = [1]
particles = 90
[contact]
youngs_modulus = "4 MPa"
poisson_ratio = 0.3
restitution = 0.6
sliding_friction = 0.5
rolling_friction = 0
cohesion = "none"
[machine]
layer_thickness = "55 um"
recoating_speed = "40 mm/s"
accumulation_length = "130 um"
accumulation_depth = "50 um"
gap_length = "30 um"
deposition_length = "168 um"
width = "120 um"
blade_width = "50 um"
edge_radius = "5 um"
[laser]
power = "70 W"
wavelength = "1070 nm"
spot_diameter = "60 um"
spot_definition = "1/e2"
[optics]
rays = 1000
[scan]
kind = "track"
scan_speed = "800 mm/s"
track_length = "90 um"
[heat]
cell_size = "8 um"
substrate_depth = "60 um"
[run]
layers = 1
pictures = false
[effects.evaporation]
enabled = true
)";

/// On a spread layer the second grid is the first that divides width and length: 10 x 14 cells for 15 x 21. Spread anew
/// in such cells, which is another way through the program, the layer melts the same.
TEST(Melt, SecondGridOfASpreadLayerIsTheLayerInLargerCells) {
  fs::path const folder = fs::temp_directory_path() / ("layerloop_two_grids_" + std::to_string(::getpid()));
  auto const melted = [&](char const* name, std::vector<std::string> const& changes) {
    Case const checked = case_of_text(layer, "layer.toml", changes, Process::exposing);
    return run_melt(checked, {.folder = folder / name, .bed = {}, .quiet = true}, Communicator());
  };
  MeltStudy const fine = melted("fine", {"melt.two_grids=true"}),
                  coarse = melted("coarse", {"heat.cell_size=\"12 um\""});
  ASSERT_TRUE(fine.second_grid);
  double const absorptivity = fine.melted.exposure.mean.absorptivity,
               in_large_cells = coarse.melted.exposure.mean.absorptivity;
  std::printf("absorptivity %.4f in 8 um, %.4f in 12 um\n", absorptivity, in_large_cells);
  EXPECT_NEAR(fine.second_grid->cell_size, 12e-6, 1e-12);
  EXPECT_NEAR(fine.second_grid->absorptivity, in_large_cells, 1e-6);
  EXPECT_NEAR(fine.second_grid->pool.width, coarse.melted.heat.melt.pool.width, 1e-9);
  EXPECT_NEAR(fine.absorptivity_u_mesh, std::abs(in_large_cells - absorptivity) / 0.5, 1e-6);
  EXPECT_GT(fine.absorptivity_u_mesh, 3 * fine.melted.exposure.mean.standard_error) << "the rays would tell";
  MeltStudy const cold = melted("cold", {"melt.two_grids=true", "laser.power=2"});
  EXPECT_LT(cold.absorptivity_u_mesh, 2 * cold.melted.exposure.mean.standard_error)
      << "grains that do not melt are spheres, whatever the cells";
  fs::remove_all(folder);
}

/// The cells of a spread layer divide it.
TEST(Melt, NoSecondGridWhereNoCellsDivideTheLayer) {
  std::vector<std::string> const changes{"heat.cell_size=\"10 um\"", "machine.width=\"130 um\"",
                                         "machine.deposition_length=\"170 um\""};
  Case const checked = case_of_text(layer, "layer.toml", changes, Process::exposing);
  EXPECT_FALSE(second_cell(checked));
}

/// Two tracks whose pools do not meet leave between them what their widths leave; those that meet leave nothing.
TEST(Melt, TracksThatDoNotMeetLeaveSurfaceUnmelted) {
  std::vector<std::string> const coarse{"scan.kind=hatch", "scan.tracks=2", "heat.cell_size=\"7 um\"",
                                        "scan.track_length=\"400 um\"", "scan.dwell=\"1 ms\""};
  auto const with_hatch = [&](char const* spacing) {
    std::vector<std::string> changes = coarse;
    changes.push_back(std::string("scan.hatch_spacing=") + spacing);
    return study_of(changes);
  };
  MeltStudy const apart = with_hatch("160 um"), joined = with_hatch("60 um");
  ASSERT_TRUE(apart.fusion && joined.fusion);
  double const cell_share = 7.0 / 160;
  EXPECT_NEAR(apart.fusion->unmelted_surface, 1 - apart.melted.heat.melt.pool.width / 160e-6, 2 * cell_share);
  EXPECT_EQ(apart.fusion->overlap_depth, 0);
  EXPECT_EQ(joined.fusion->unmelted_surface, 0);
  EXPECT_NEAR(joined.fusion->overlap_depth, joined.fusion->elliptic_overlap_depth, 7e-6);
  EXPECT_GT(joined.fusion->overlap_depth, 0);
}

TEST(Melt, WayOfAFileIsTheHatchBitForBit) {
  fs::path const file = fs::temp_directory_path() / "layerloop_way.csv";
  write_file(file,
             "x [um],y [um],power [W],speed [mm/s]\n"
             "-150,-40,0,800\n150,-40,100,800\n150,40,0,800\n-150,40,100,800\n");
  std::vector<std::string> const coarse{"heat.cell_size=\"8 um\"", "heat.size=[\"500 um\", \"300 um\", \"100 um\"]"};
  std::vector<std::string> hatch = coarse, way = coarse;
  for (char const* change : {"scan.kind=hatch", "scan.tracks=2", "scan.hatch_spacing=\"80 um\"",
                             "scan.track_length=\"300 um\"", "scan.dwell=\"100 us\""})
    hatch.push_back(change);
  for (std::string const& change : {std::string("scan.kind=file"), "scan.path=" + file.string()}) way.push_back(change);
  MeltStudy const a = study_of(hatch), b = study_of(way);
  EXPECT_EQ(a.melted.heat.melt.peak_temperature, b.melted.heat.melt.peak_temperature);
  EXPECT_EQ(a.melted.heat.melt.pool.width, b.melted.heat.melt.pool.width);
  EXPECT_EQ(a.melted.heat.melt.pool.length, b.melted.heat.melt.pool.length);
  fs::remove(file);
}

TEST(Melt, CaseNeedsNeitherPowderNorMachine) {
  auto const fault = [](std::vector<std::string> const& changes) -> std::string {
    try {
      Case const checked = case_of_text(reference, "reference.toml", changes, Process::exposing);
      with_plate(checked, estimate_pool(checked));
    } catch (InputError const& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(fault({}), "");
  EXPECT_NE(fault({"heat.size=[1e-3, 1e-3]"}).find("three are needed"), std::string::npos);
  EXPECT_NE(fault({"heat.size=[5e-4, 1e-3, 1e-4]"}).find("beam off the plate"), std::string::npos);
  EXPECT_NE(fault({"heat.cell_size=5e-5"}).find("must resolve the beam"), std::string::npos);
  EXPECT_NE(fault({"melt.bed=spread"}).find("missing table [machine]"), std::string::npos);
}

}  // namespace
}  // namespace layerloop::coupling
