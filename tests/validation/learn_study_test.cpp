// The verb learn where the answer is known: the void above a bare plate is as thick as the layer, at any speed.
#include "validation/learning/learn_study.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/write_file.hpp"
#include "validation/learning/learn_output.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;

std::string const layers = R"([powder]
material = "IN718"
basis = "number"
diameters = ["21 um", "25 um"]
fractions = [0.5, 0.5]
particles = 60
[contact]
youngs_modulus = "5 MPa"
poisson_ratio = 0.3
restitution = 0.7
sliding_friction = 0.7
rolling_friction = 0.15
cohesion = "none"
[machine]
layer_thickness = "50 um"
recoating_speed = "150 mm/s"
accumulation_length = "150 um"
accumulation_depth = "40 um"
gap_length = "50 um"
deposition_length = "150 um"
width = "130 um"
blade_width = "50 um"
edge_radius = "5 um"
[run]
bins = 5
pictures = false
checkpoint = false
[sweep]
verb = "spread"
design = "latin_hypercube"
cases = 5
[sweep.vary]
machine.layer_thickness = ["30 um", "60 um"]
machine.recoating_speed = ["150 mm/s", "300 mm/s"]
)";
std::string const thinnest = "[learn]\noutput = \"void_layer\"\ngoal = \"minimise\"\nruns = 4\n";

struct Folder {
  fs::path path = fs::temp_directory_path() / ("layerloop_learn_" + std::to_string(::getpid()));
  Folder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  LearnStudy learn(std::string const& text, std::string const& results,
                   std::vector<std::string> const& set = {}) const {
    write_file(path / "learn.toml", text);
    coupling::SweepOptions options;
    options.folder = path / results;
    options.quiet = options.resume = true;
    return run_learning(path / "learn.toml", set, options, Communicator());
  }
  std::string complaint(std::string const& text, std::string const& results = "none",
                        std::vector<std::string> const& set = {}) const {
    try {
      learn(text, results, set);
    } catch (InputError const& fault) {
      return fault.what();
    }
    return "";
  }
};

TEST(LearnStudy, FindsTheThinnestVoidAndGoesOnAsIfItHadNotBeenStopped) {
  Folder const folder;
  LearnStudy const whole = folder.learn(layers + thinnest, "whole");
  ASSERT_EQ(whole.trials.size(), 9U);
  for (LearnedRun const& trial : whole.trials) EXPECT_NEAR(trial.value, trial.place[0], 1e-12);
  LearnResults const results = results_of(whole);
  EXPECT_NEAR(results.optimum.place[0], 30e-6, 0.5e-6);
  EXPECT_NEAR(results.optimum.value.mean, 30e-6, 0.5e-6);
  EXPECT_LE(results.optimum.value_low, results.optimum.value_high);
  EXPECT_LE(results.optimum.place_high[0], 33e-6);
  EXPECT_GT(results.optimum.place_high[1] - results.optimum.place_low[1], 0.075);  // any speed will do
  EXPECT_GT(results.surrogates.front().skill.q2, 0.99);
  EXPECT_LT(results.history.back().best, 30.5e-6);
  EXPECT_EQ(results.history.size(), 5U);

  folder.learn(layers + thinnest, "parts", {"learn.runs=2"});
  LearnStudy const parts = folder.learn(layers + thinnest, "parts");
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_EQ(parts.trials[k].place, whole.trials[k].place) << k;
    EXPECT_EQ(parts.trials[k].value, whole.trials[k].value) << k;
  }

  write_learning(whole, results, folder.path / "whole");
  auto const summary = nlohmann::json::parse(read_file(folder.path / "whole" / "summary.json"));
  EXPECT_EQ(summary["cases"].size(), 9U);
  EXPECT_DOUBLE_EQ(summary["learn"]["optimum"]["value"], results.optimum.value.mean);
  for (char const* file : {"learn.csv", "left_out.csv", "surrogates.csv", "slices.csv", "report.html", "cases.html"})
    EXPECT_TRUE(fs::is_regular_file(folder.path / "whole" / file)) << file;
}

TEST(LearnStudy, KeepsWhatAnotherSearchLeftInTheFolder) {
  Folder const folder;
  LearnStudy const study = folder.learn(layers + thinnest, "kept");
  write_learning(study, results_of(study), folder.path / "kept");
  auto const everything = [&] {
    std::string all;
    for (char const* file : {"summary.json", "cases.csv", "points.csv", "report.html", "learn.json"})
      all += read_file(folder.path / "kept" / file);
    return all;
  };
  std::string const before = everything();
  std::string const goal = folder.complaint(layers + thinnest, "kept", {"learn.goal=maximise"});
  EXPECT_NE(goal.find("kept holds another search (goal is \"minimise\" there and \"maximise\" here)"),
            std::string::npos)
      << goal;
  fs::remove(folder.path / "kept" / "learn.json");  // then the cases tell
  std::string const other = folder.complaint(layers + thinnest, "kept", {"learn.goal=maximise"});
  EXPECT_NE(other.find("kept holds case 6 of another sweep"), std::string::npos) << other;
  EXPECT_EQ(folder.learn(layers + thinnest, "kept", {"learn.runs=1"}).trials.size(), 9U);
  EXPECT_EQ(nlohmann::json::parse(read_file(folder.path / "kept" / "summary.json"))["cases"].size(), 9U);
  LearnStudy const again = folder.learn(layers + thinnest, "kept");
  write_learning(again, results_of(again), folder.path / "kept");
  EXPECT_EQ(everything(), before);
}

TEST(LearnStudy, SaysWhereTheTableIsWrongBeforeAnythingRuns) {
  Folder const folder;
  EXPECT_NE(folder.complaint(layers).find("learn.toml:1:1: missing table [learn]"), std::string::npos);
  std::string const typos = folder.complaint(layers + "[learn]\noutput = \"void_laye\"\ngoal = \"most\"\nrun = 3\n");
  EXPECT_NE(typos.find("learn.toml:36:1: output = \"void_laye\" (must be a figure"), std::string::npos) << typos;
  EXPECT_NE(typos.find("did you mean \"void_layer\"?"), std::string::npos) << typos;
  EXPECT_NE(typos.find("learn.toml:37:1: goal = \"most\" (must be one of maximise, minimise, know)"),
            std::string::npos);
  EXPECT_NE(typos.find("learn.toml:38:1: unknown key \"run\" in [learn]"), std::string::npos) << typos;
  EXPECT_NE(typos.find("missing key \"runs\" in [learn] (a whole number)"), std::string::npos) << typos;
  std::string const both = folder.complaint(layers + "desing = 1\n[learn]\noutput = \"pool.depth\"\ngoal = \"know\"\n");
  EXPECT_NE(both.find("toml:35:1: unknown key \"desing\" in [sweep.vary]"), std::string::npos) << both;
  EXPECT_NE(both.find("toml:37:1: output = \"pool.depth\" (must be a figure of the verb spread: effective_thickness"),
            std::string::npos)
      << both;
  std::string const listed = layers.substr(0, layers.find("design"));
  std::string const fixed =
      listed + "design = \"list\"\n[sweep.vary]\nmachine.layer_thickness = [\"40 um\"]\npowder.particles = [60]\n";
  std::string const ranges = folder.complaint(fixed + thinnest);
  EXPECT_NE(ranges.find("toml:32:9: machine.layer_thickness has no range"), std::string::npos) << ranges;
  std::string const whole =
      folder.complaint(listed + "design = \"list\"\n[sweep.vary]\npowder.particles = [60, 70]\n" + thinnest);
  EXPECT_NE(whole.find("toml:32:8: powder.particles is a whole number"), std::string::npos) << whole;
  EXPECT_FALSE(fs::exists(folder.path / "none"));
}

TEST(LearnStudy, GoesElsewhereWhenAProposedPlaceIsNoGoodCase) {
  // Ninety grains fill a short or a shallow zone, but in one that is long and deep the blade passes over them.
  Folder const folder;
  std::string text = layers.substr(0, layers.find("design"));
  text.replace(text.find("particles = 60"), 14, "particles = 90");
  LearnStudy const study = folder.learn(text + R"(design = "list"
[sweep.vary]
machine.accumulation_length = ["150 um", "250 um", "180 um"]
machine.accumulation_depth = ["55 um", "30 um", "40 um"]
[learn]
output = "settled_height"
goal = "know"
runs = 4
)",
                                        "corner");
  EXPECT_FALSE(study.refused.empty());
  EXPECT_EQ(study.refused.size() + study.trials.size(), 7U);
  for (LearnedRun const& trial : study.refused) EXPECT_GT(trial.place[0] * trial.place[1], 8e-9);
}

}  // namespace
}  // namespace layerloop::validation
