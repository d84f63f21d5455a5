#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/write_file.hpp"
#include "coupling/file_lock.hpp"
#include "coupling/melt_study.hpp"
#include "coupling/sweep/sweep_cost.hpp"
#include "coupling/sweep/sweep_run.hpp"
#include "tests/plate_track.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string const track = plate_track + "ambient_temperature = \"298 K\"\n[sweep]\nverb = \"melt\"\n";

/// A layer of powder under even light.
std::string layer() {
  return read_file(fs::path(LAYERLOOP_SOURCE_DIR) / "tests/loop/spread_small.toml") +
         "[laser]\nwavelength = \"1070 nm\"\n[optics]\nuniform_beam = true\n[absorb]\ntarget_standard_error = 0.01\n"
         "[sweep]\nverb = \"absorb\"\n";
}

/// A sweep file in a folder that goes away.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("layerloop_sweep_" + std::to_string(::getpid()));
  explicit Folder(std::string const& text) {
    fs::remove_all(path);
    fs::create_directories(path);
    write_file(file(), text);
  }
  ~Folder() { fs::remove_all(path); }
  fs::path file() const { return path / "sweep.toml"; }
  SweepPlan plan(std::vector<std::string> const& set = {}) const { return read_sweep(file(), set); }
  SweepOptions options() const {
    SweepOptions options;
    options.folder = path / "out";
    options.quiet = true;
    return options;
  }
  json summary() const { return json::parse(read_file(path / "out" / "summary.json")); }
};

std::string complaint(std::string const& text) {
  try {
    Folder(text).plan();
  } catch (InputError const& fault) {
    return fault.what();
  }
  return "";
}

TEST(SweepPlan, GridHasEveryValueWithEveryOther) {
  SweepPlan const plan =
      Folder(track +
             "replicates = 2\n[sweep.vary]\nscan.scan_speed = [0.5, \"800 mm/s\"]\nlaser.power = [60, 70, 80]\n")
          .plan();
  ASSERT_EQ(plan.cases.size(), 12u);
  EXPECT_EQ(plan.points, 6u);
  EXPECT_EQ(plan.keys[0].name, "scan.scan_speed");  // as in the file; the last runs fastest
  EXPECT_EQ(words_of(plan, plan.cases[2]), "scan.scan_speed = 500 mm/s, laser.power = 70 W");
  EXPECT_EQ(plan.cases[3].checked.laser.power, 70);
  EXPECT_EQ(plan.cases[3].checked.seed, plan.cases[2].checked.seed + 1);
  EXPECT_EQ(plan.cases[11].checked.scan.scan_speed, 0.8);
}

TEST(SweepPlan, ListGoesTogether) {
  SweepPlan const plan =
      Folder(track + "design = \"list\"\n[sweep.vary]\nlaser.power = [60, 70]\nscan.scan_speed = [0.5, 0.6]\n").plan();
  ASSERT_EQ(plan.cases.size(), 2u);
  EXPECT_EQ(plan.cases[1].checked.laser.power, 70);
  EXPECT_EQ(plan.cases[1].checked.scan.scan_speed, 0.6);
}

TEST(SweepPlan, FillsTheRange) {
  for (char const* design : {"latin_hypercube", "sobol"}) {
    SweepPlan const plan =
        Folder(track + "cases = 8\ndesign = \"" + design + "\"\n[sweep.vary]\nlaser.power = [\"60 W\", \"100 W\"]\n")
            .plan();
    ASSERT_EQ(plan.cases.size(), 8u);
    std::vector<double> power;
    for (SweepCase const& one : plan.cases) power.push_back(one.checked.laser.power);
    std::ranges::sort(power);
    for (std::size_t k = 0; k < 8; ++k) {  // one in each eighth
      EXPECT_GE(power[k], 60 + 5.0 * static_cast<double>(k));
      EXPECT_LE(power[k], 65 + 5.0 * static_cast<double>(k));
    }
  }
}

TEST(SweepPlan, WordsKeepTheirQuotes) {
  SweepPlan const plan = Folder(track + "[sweep.vary]\ncase.name = [\"7\", \"true\", \"a\\\"b, c\"]\n").plan();
  EXPECT_EQ(plan.cases[0].checked.name, "7");
  EXPECT_EQ(plan.cases[1].checked.name, "true");
  EXPECT_EQ(plan.cases[2].checked.name, "a\"b, c");
}

TEST(SweepPlan, RefusesAnOptionForASweptKey) {
  Folder const folder(track + "[sweep.vary]\nlaser.power = [50, 60]\n");
  EXPECT_THROW(folder.plan({"laser.power=55 W"}), InputError);
}

TEST(SweepPlan, RefusesWhatIsWrongAtItsPlace) {
  EXPECT_NE(complaint(track + "[sweep.vary]\nlaser.powr = [60]\n").find("sweep.toml:20:7: unknown key \"laser.powr\""),
            std::string::npos);
  EXPECT_NE(complaint(track + "[sweep.vary]\nlaser.powr = [60]\n").find("did you mean \"laser.power\"?"),
            std::string::npos);
  EXPECT_NE(complaint(track + "desing = \"grid\"\n[sweep.vary]\nlaser.power = [60]\n").find("did you mean \"design\"?"),
            std::string::npos);
  EXPECT_NE(complaint(track + "[sweep.vary]\nlaser.power = [\"60 m\"]\n").find("is a length"), std::string::npos);
  EXPECT_NE(complaint(track + "[sweep.vary]\nlaser.power = [60, 9e9]\n").find("sweep.toml:20:7: laser.power = "),
            std::string::npos);
  EXPECT_NE(complaint(track + "[sweep.vary]\nlaser.power = [60, 9e9]\n").find("in 1 of 2 points"), std::string::npos);
  EXPECT_NE(complaint(track + "[sweep.vary]\nlaser.power = [60, 70, 60]\n").find("60 twice"), std::string::npos);
  EXPECT_NE(complaint(track + "[sweep.vary]\ncase.name = [{a = 1}]\n").find("must be a value"), std::string::npos);
  std::string many = "[sweep.vary]\n";
  for (char const* key : {"laser.power", "scan.scan_speed", "laser.wavelength", "laser.spot_diameter", "scan.dwell"}) {
    many += key + std::string(" = [1");
    for (int k = 2; k <= 60; ++k) many += ", " + std::to_string(k);
    many += "]\n";
  }
  EXPECT_NE(complaint(track + many).find("vary less"), std::string::npos);
  EXPECT_NE(complaint(track).find("missing table [sweep.vary]"), std::string::npos);
  EXPECT_NE(complaint(track + "[sweep.vary]\ncase.seed = [1, 2]\n").find("replicates"), std::string::npos);
  EXPECT_NE(complaint(track + "design = \"list\"\n[sweep.vary]\nlaser.power = [60]\nscan.scan_speed = [0.5, 0.6]\n")
                .find("give as many"),
            std::string::npos);
  EXPECT_NE(complaint(track + "design = \"sobol\"\n[sweep.vary]\nlaser.power = [60, 70]\n").find("\"cases\""),
            std::string::npos);
  EXPECT_NE(complaint(track + "design = \"sobol\"\ncases = 2\n[sweep.vary]\nlaser.power = [70, 60]\n")
                .find("the lower first"),
            std::string::npos);
}

TEST(Sweep, ACaseIsWhatTheVerbAloneGives) {
  Folder const folder(track + "[sweep.vary]\nlaser.power = [50, 60]\n");
  SweepPlan const plan = folder.plan();
  run_sweep(plan, folder.options(), Communicator());
  json const all = folder.summary();
  ASSERT_EQ(all["cases"].size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    MeltStudy const alone = run_melt(plan.cases[k].checked, {.folder = {}, .bed = {}, .quiet = true}, Communicator());
    EXPECT_EQ(all["cases"][k]["state"], "done");
    EXPECT_EQ(all["cases"][k]["settings"]["laser.power"], plan.cases[k].checked.laser.power);
    EXPECT_EQ(all["cases"][k]["pool"]["width"].get<double>(), alone.melted.heat.melt.pool.width);
  }
  for (char const* file : {"cases.csv", "points.csv", "report.html"})
    EXPECT_TRUE(fs::exists(folder.path / "out" / file));
}

TEST(Sweep, OneThatFailsDoesNotStopTheRest) {
  Folder const folder(track + "[sweep.vary]\nlaser.power = [50, 400, 60]\n");
  run_sweep(folder.plan(), folder.options(), Communicator());
  json const all = folder.summary();
  EXPECT_EQ(all["cases"][0]["state"], "done");
  EXPECT_EQ(all["cases"][1]["state"], "failed");
  EXPECT_NE(all["cases"][1]["reason"].get<std::string>().find("boiled"), std::string::npos);
  EXPECT_EQ(all["cases"][2]["state"], "done");
}

TEST(Sweep, ResumeDoesWhatIsOpenAndNothingElse) {
  Folder const folder(track + "[sweep.vary]\nlaser.power = [50, 60]\n");
  SweepOptions options = folder.options();
  options.index = 2;
  run_sweep(folder.plan(), options, Communicator());
  EXPECT_FALSE(fs::exists(options.folder / "summary.json"));  // case 1 waits
  CaseRecord const first = read_record(options.folder / case_folder(2));
  EXPECT_EQ(first.state, CaseState::done);
  options.index.reset();
  EXPECT_THROW(run_sweep(folder.plan(), options, Communicator()), InputError);  // without --resume
  options.resume = true;
  fs::create_directories(options.folder / case_folder(1));
  write_record(options.folder / case_folder(1), {CaseState::interrupted, "of another sweep", "", 1, 0});
  EXPECT_THROW(run_sweep(folder.plan(), options, Communicator()), InputError);
  fs::remove(options.folder / case_folder(1) / "state.json");
  run_sweep(folder.plan(), options, Communicator());
  EXPECT_EQ(read_record(options.folder / case_folder(1)).state, CaseState::done);
  EXPECT_EQ(read_record(options.folder / case_folder(2)).wall_time, first.wall_time);  // not done again
  EXPECT_EQ(read_record(options.folder / case_folder(2)).attempts, 1);
  EXPECT_THROW(run_sweep(folder.plan({"laser.spot_diameter=70 um"}), options, Communicator()), InputError);
}

TEST(Sweep, LeavesACaseToTheProcessThatHoldsItsLock) {
  Folder const folder(track + "[sweep.vary]\nlaser.power = [50, 60]\n");
  SweepOptions options = folder.options();
  {
    FileLock const other(lock_of(options.folder / case_folder(1)), FileLock::Wait::no);
    ASSERT_TRUE(other.held());
    SweepPlan const plan = folder.plan();
    run_sweep(plan, options, Communicator());
    EXPECT_EQ(read_record(options.folder / case_folder(1)).state, CaseState::waiting);
    write_record(options.folder / case_folder(1), {CaseState::interrupted, "", "it was killed", 1, 0});
    EXPECT_EQ(read_records(plan, options.folder)[0].state, CaseState::running);
    fs::remove(options.folder / case_folder(1) / "state.json");
    EXPECT_EQ(read_record(options.folder / case_folder(2)).state, CaseState::done);
  }
  options.resume = true;
  run_sweep(folder.plan(), options, Communicator());
  EXPECT_EQ(read_record(options.folder / case_folder(1)).state, CaseState::done);
}

TEST(Sweep, DamagedFilesAreDoneAgain) {
  Folder const folder(track + "[sweep.vary]\nlaser.power = [50, 60]\n");
  SweepOptions options = folder.options();
  run_sweep(folder.plan(), options, Communicator());
  std::string const whole = read_file(options.folder / case_folder(1) / "summary.json");
  options.resume = true;
  for (char const* damaged : {"", "{", "[]", "null"}) {
    write_file(options.folder / case_folder(1) / "summary.json", damaged);
    run_sweep(folder.plan(), options, Communicator());
    EXPECT_EQ(json::parse(read_file(options.folder / case_folder(1) / "summary.json"))["pool"],
              json::parse(whole)["pool"]);
  }
  for (char const* damaged : {"", "[]", "5", "{\"state\": 5}", "{\"state\": \"done\", \"attempts\": \"x\"}"}) {
    write_file(options.folder / case_folder(2) / "state.json", damaged);
    EXPECT_NO_THROW(read_record(options.folder / case_folder(2)));
  }
}

TEST(Sweep, RefusesAFolderOfAnotherVerb) {
  Folder const folder(track + "[sweep.vary]\nlaser.power = [50, 60]\n");
  fs::create_directories(folder.options().folder);
  write_file(folder.options().folder / "case_resolved.toml", "");
  EXPECT_THROW(run_sweep(folder.plan(), folder.options(), Communicator()), InputError);
}

/// At the same energy density everywhere there is one line to draw, not none and not infinitely many.
TEST(Sweep, DrawsAWindowOfOneEnergyDensity) {
  Folder const folder(track +
                      "design = \"list\"\nhatch_spacing = \"50 um\"\nlayer_thickness = \"20 um\"\n[sweep.vary]\n"
                      "laser.power = [50, 55, 60, 65]\nscan.scan_speed = [0.50, 0.55, 0.60, 0.65]\n");
  run_sweep(folder.plan(), folder.options(), Communicator());
  std::string const rows = read_file(folder.options().folder / "window_1.csv");
  EXPECT_EQ(std::ranges::count(rows, '\n'), 5);
}

TEST(Sweep, OneBedServesEveryLight) {
  Folder const folder(layer() + "[sweep.vary]\noptics.grey_reflectance = [0.5, 0.7]\n");
  SweepPlan const plan = folder.plan({"run.layers=1", "run.replicates=1"});
  EXPECT_NE(cost_table(plan, folder.options().folder).find("2 of 2 cases to do"), std::string::npos);
  run_sweep(plan, folder.options(), Communicator());
  json const all = folder.summary();
  EXPECT_GT(all["cases"][0]["absorptivity"].get<double>(), all["cases"][1]["absorptivity"].get<double>());
  std::size_t beds = 0;
  for (auto const& entry : fs::directory_iterator(folder.path / "out" / "beds")) beds += entry.is_directory() ? 1 : 0;
  EXPECT_EQ(beds, 1u);
}

}  // namespace
}  // namespace layerloop::coupling
