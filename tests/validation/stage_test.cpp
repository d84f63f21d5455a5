#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/write_file.hpp"
#include "coupling/melt_study.hpp"
#include "tests/plate_track.hpp"
#include "validation/stage_model.hpp"
#include "validation/study_file.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;

std::string const plate = plate_track + "ambient_temperature = \"298 K\"\n";

/// One thin layer of soft grains on a plate, and a short track on it.
constexpr char const* powder = R"([case]
seed = 5
[powder]
material = "IN718"
basis = "number"
diameters = ["21 um", "25 um"]
fractions = [0.5, 0.5]
particles = 160
[contact]
youngs_modulus = "5 MPa"
poisson_ratio = 0.3
restitution = 0.7
sliding_friction = 0.7
rolling_friction = 0.15
cohesion = "none"
[machine]
layer_thickness = "50 um"
recoating_speed = "60 mm/s"
accumulation_length = "150 um"
accumulation_depth = "40 um"
gap_length = "50 um"
deposition_length = "200 um"
width = "130 um"
blade_width = "50 um"
edge_radius = "5 um"
[laser]
power = "40 W"
absorptivity = 0.4
wavelength = "1070 nm"
spot_diameter = "60 um"
spot_definition = "1/e2"
[scan]
kind = "track"
scan_speed = "1 m/s"
track_length = "80 um"
[heat]
cell_size = "10 um"
substrate_depth = "60 um"
ambient_temperature = "300 K"
[run]
layers = 1
bins = 5
)";

/// A study and its cache, in a folder that goes away.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("layerloop_stage_" + std::to_string(::getpid()));
  Communicator comm;
  Folder(std::string const& base, std::string const& conditions, std::string const& measurements,
         std::string const& calibration = "") {
    fs::remove_all(path);
    fs::create_directories(path);
    write_file(path / "case.toml", base);
    write_file(path / "study.toml", "[study]\ncase = \"case.toml\"\n" + calibration);
    write_file(path / "conditions.csv", conditions);
    write_file(path / "measurements.csv", "obs_id,condition_id,quantity,value,unit,u_stat\n" + measurements);
  }
  ~Folder() { fs::remove_all(path); }
  std::unique_ptr<Model> model(std::vector<Candidate> const& candidates = {}, std::int64_t beds = 1) const {
    return stage_model(read_study(path), candidates, {.cache = path / "cache", .beds = beds, .quiet = true}, comm);
  }
  std::ptrdiff_t kept(char const* what) const {
    return std::distance(fs::directory_iterator(path / "cache" / what), fs::directory_iterator());
  }
};

ModelPoint at(std::vector<double> const& calibration, std::vector<double> const& strengths = {}) {
  auto const vector = [](std::vector<double> const& v) {
    return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd const>(v.data(), static_cast<Eigen::Index>(v.size())));
  };
  return {vector(calibration), vector(strengths), 0};
}

constexpr char const* two_powers = "condition_id,laser.power [W],u(laser.power) [W]\nlow,50,1\nhigh,70,1.4\n";
constexpr char const* two_widths = "1,low,pool.width,60,um,2\n2,high,pool.width,70,um,2\n3,high,pool.depth,25,um,2\n";

TEST(StageModel, IsTheVerbUnderEachCondition) {
  Folder const folder(plate, two_powers, two_widths);
  Prediction const prediction = folder.model()->predict(at({-0.1}));  // all powers are 10 % lower
  for (auto const& [power, width] : {std::pair("laser.power=45", 0), std::pair("laser.power=63", 1)}) {
    Case const checked = case_of_text(plate, folder.path / "case.toml", {power}, Process::exposing);
    coupling::MeltStudy const study =
        coupling::run_melt(checked, {.folder = {}, .bed = {}, .spread = {}, .quiet = true}, folder.comm);
    EXPECT_EQ(prediction.value[width], study.melted.heat.melt.pool.width);
    if (width == 1) {
      EXPECT_EQ(prediction.value[2], study.melted.heat.melt.pool.depth);
    }
  }
}

TEST(StageModel, TakesTheErrorOfTheMeshFromASecondGridAtTheBasePoint) {
  Folder const folder(plate, two_powers, two_widths);
  Prediction const base = folder.model()->predict(at({0})), other = folder.model()->predict(at({-0.1}));
  Case const two =
      case_of_text(plate, folder.path / "case.toml", {"laser.power=50", "melt.two_grids=true"}, Process::exposing);
  coupling::MeltStudy const study =
      coupling::run_melt(two, {.folder = {}, .bed = {}, .spread = {}, .quiet = true}, folder.comm);
  EXPECT_EQ(base.u_numerical[0], study.u_num.width);
  EXPECT_EQ(other.u_numerical[0], base.u_numerical[0]) << "whatever point was asked first";
}

TEST(StageModel, ComputesNothingTwice) {
  Folder const folder(plate, two_powers, two_widths);
  auto const first = folder.model();
  Prediction const fresh = first->predict(at({0}));
  EXPECT_EQ(first->passes(), 1);
  auto const second = folder.model();
  Prediction const known = second->predict(at({0}));
  EXPECT_EQ(second->passes(), 0);
  EXPECT_EQ(fresh.value, known.value);
  EXPECT_EQ(fresh.u_numerical, known.u_numerical);
}

TEST(StageModel, RefusesEveryBadConditionBeforeItComputes) {
  Folder const folder(plate, "condition_id,scan.track_length [um]\na,250\nb,2000\nc,250\nd,3000\n",
                      "1,a,pool.width,60,um,2\n2,b,pool.width,60,um,2\n3,d,pool.width,60,um,2\n");
  try {
    folder.model();
    FAIL() << "tracks that are longer than the plate";
  } catch (InputError const& error) {
    std::string const faults = error.what();
    EXPECT_NE(faults.find("condition \"b\""), std::string::npos) << faults;
    EXPECT_NE(faults.find("condition \"d\""), std::string::npos) << faults;
    EXPECT_EQ(faults.find("condition \"a\""), std::string::npos) << faults;
  }
  EXPECT_EQ(folder.kept("runs"), 0);
}

/// 400 W in this spot boil the metal far above what the tables hold; the case has no evaporation to stop that.
TEST(StageModel, HasNoAnswerWhereAGuardStopsTheRun) {
  Folder const folder(plate, "condition_id,laser.power [W]\nlow,50\nhigh,400\n",
                      "1,low,pool.width,60,um,2\n2,high,pool.width,70,um,2\n");
  auto const model = folder.model();
  Prediction const prediction = model->predict(at({}));
  EXPECT_TRUE(std::isfinite(prediction.value[0]));
  EXPECT_TRUE(std::isnan(prediction.value[1]));
  ASSERT_EQ(model->notes().size(), 1U);
  EXPECT_TRUE(model->notes().front().starts_with("condition \"high\": ")) << model->notes().front();
}

TEST(StageModel, SpreadsABedOnceForAllLightAndHeat) {
  Folder const folder(powder, "condition_id,laser.power [W]\none,40\n",
                      "1,one,pool.width,60,um,2\n2,one,bed.relative_density,0.5,,0.02\n");
  std::vector<Candidate> const candidates{{"surface_losses", EffectStage::heat}, {"gas_drag", EffectStage::dem}};
  auto const model = folder.model(candidates);
  Prediction const base = model->predict(at({}, {0, 0}));
  EXPECT_EQ(folder.kept("beds"), 1);
  double const passes = model->passes();
  Prediction const warm = model->predict(at({}, {50, 0}));
  EXPECT_EQ(folder.kept("beds"), 1);
  EXPECT_EQ(model->passes(), passes + 0.5) << "the bed was there";
  EXPECT_EQ(base.value[1], warm.value[1]);
  EXPECT_NE(base.value[0], warm.value[0]);
  model->predict(at({}, {0, 1}));
  EXPECT_EQ(folder.kept("beds"), 2);
}

TEST(StageModel, AveragesBedsAndPoolsTheirScatter) {
  Folder const folder(powder, "condition_id,machine.recoating_speed [mm/s]\nslow,60\nfast,80\n",
                      "1,slow,bed.relative_density,0.5,,0.02\n2,fast,bed.relative_density,0.5,,0.02\n");
  double squares = 0;
  std::array<double, 2> mean{};
  for (Eigen::Index c : {0, 1}) {
    std::vector<double> values;
    for (double const seed : {5, 6}) {
      std::string text = powder;
      text.replace(text.find("seed = 5"), 8, "seed = " + std::to_string(static_cast<int>(seed)));
      write_file(folder.path / "case.toml", text);
      values.push_back(folder.model()->predict(at({})).value[c]);
    }
    mean[static_cast<std::size_t>(c)] = 0.5 * (values[0] + values[1]);
    for (double const value : values) squares += std::pow(value / mean[static_cast<std::size_t>(c)] - 1, 2);
  }
  write_file(folder.path / "case.toml", powder);
  auto const model = folder.model({}, 2);
  Prediction const both = model->predict(at({}));
  EXPECT_EQ(model->passes(), 0) << "these beds are known";
  for (Eigen::Index c : {0, 1}) {
    double const m = mean[static_cast<std::size_t>(c)];
    EXPECT_NEAR(both.value[c], m, 1e-14);
    EXPECT_NEAR(both.u_sampling[c], m * std::sqrt(squares / 2) / std::sqrt(2), 1e-12);
  }
}

}  // namespace
}  // namespace layerloop::validation
