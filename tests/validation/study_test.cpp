// Every bad study of tests/bad_study is the good one with the files that stand behind `== FILE` in the place of its
// own, and is refused with exactly the faults that its first lines announce: `# expect: file:line:column fragment`.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "core/error.hpp"
#include "core/write_file.hpp"
#include "validation/study_file.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;

fs::path const corpus = fs::path(LAYERLOOP_SOURCE_DIR) / "tests/bad_study";

std::vector<std::string> lines_of(std::string const& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// A copy of the good study that goes away.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("layerloop_study_" + std::to_string(::getpid()));
  Folder() {
    fs::remove_all(path);
    fs::copy(corpus / "good", path);
  }
  ~Folder() { fs::remove_all(path); }
  void put(std::string const& file, std::string const& text) const { write_file(path / file, text); }
  Study read(Role which = Role::train) const { return read_study(path, which); }
  std::vector<std::string> faults() const {
    try {
      read();
    } catch (InputError const& error) {
      return lines_of(error.what());
    }
    return {};
  }
};

std::vector<fs::path> bad_studies() {
  std::vector<fs::path> paths;
  for (auto const& entry : fs::directory_iterator(corpus))
    if (entry.path().extension() == ".txt") paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

class BadStudy : public testing::TestWithParam<fs::path> {};

TEST_P(BadStudy, IsRefusedWhereItIsWrong) {
  Folder const folder;
  std::vector<std::string> expected;
  std::string file, text;
  for (std::string const& line : lines_of(read_file(GetParam()) + "\n== ")) {
    if (line.starts_with("# expect: ")) expected.push_back(line.substr(10));
    if (line.starts_with("== ")) {
      if (!file.empty()) folder.put(file, text);
      file = line.substr(3), text.clear();
    } else {
      text += line + "\n";
    }
  }
  ASSERT_FALSE(expected.empty());
  std::vector<std::string> const faults = folder.faults();
  EXPECT_EQ(faults.size(), expected.size()) << testing::PrintToString(faults);
  for (std::string const& one : expected) {
    std::size_t const blank = one.find(' ');
    std::string const place = (folder.path / one.substr(0, blank)).string() + ": ";
    EXPECT_TRUE(std::ranges::any_of(faults,
                                    [&](std::string const& fault) {
                                      return fault.starts_with(place) &&
                                             fault.find(one.substr(blank + 1)) != std::string::npos;
                                    }))
        << "expected " << one << "\nfound " << testing::PrintToString(faults);
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, BadStudy, testing::ValuesIn(bad_studies()),
                         [](auto const& info) { return info.param.stem().string(); });

TEST(GoodStudy, IsReadInSiUnits) {
  Folder const folder;
  Study const study = folder.read();
  EXPECT_EQ(study.name, "316L tracks");
  EXPECT_EQ(study.conditions.size(), 4U);
  EXPECT_DOUBLE_EQ(study.conditions[1].inputs.at("laser.power"), 90);
  EXPECT_DOUBLE_EQ(study.conditions[1].inputs.at("scan.scan_speed"), 0.8);
  EXPECT_DOUBLE_EQ(study.conditions[0].u_inputs.at("laser.spot_diameter"), 4e-6);
  EXPECT_EQ(study.conditions[2].labels.at("machine"), "B");
  ASSERT_EQ(study.observations.size(), 6U);  // one is a word, one excluded, one held out
  EXPECT_EQ(study.observables.size(), 6U);   // two replicates share one; the word has its own
  EXPECT_EQ(study.observations[0].observable, study.observations[1].observable);
  EXPECT_DOUBLE_EQ(study.observations[2].value, 21e-6);
  EXPECT_DOUBLE_EQ(study.observations[2].u_stat, 1e-6);
  EXPECT_DOUBLE_EQ(study.observations[5].value, 0.35);
  EXPECT_DOUBLE_EQ(study.observations[5].u_stat, 0.02);
  ASSERT_EQ(study.categories.size(), 1U);
  EXPECT_EQ(study.categories[0].word, "conduction");
}

TEST(GoodStudy, HasOneCalibrationNumberALabelAndOneErrorAnInput) {
  Folder const folder;
  Study const study = folder.read();
  ASSERT_EQ(study.calibration.size(), 4U);
  EXPECT_EQ(study.calibration[0].name, "laser.absorptivity of machine A");
  EXPECT_EQ(study.calibration[1].acts_on, (std::vector<bool>{false, false, true, true}));
  EXPECT_DOUBLE_EQ(study.calibration[2].mean, 298.15);
  EXPECT_DOUBLE_EQ(study.calibration[2].sd, 5);  // a difference of degC is one of K
  EXPECT_EQ(study.calibration[3].name, "error of laser.spot_diameter");
  EXPECT_TRUE(study.calibration[3].relative);
  EXPECT_DOUBLE_EQ(study.calibration[3].sd, 0.05);
}

TEST(GoodStudy, SaysWhatItCannotTell) {
  Folder const folder;
  auto const has = [](Study const& study, std::string const& words) {
    return std::ranges::any_of(study.limits,
                               [&](std::string const& limit) { return limit.find(words) != std::string::npos; });
  };
  Study const good = folder.read();
  EXPECT_TRUE(has(good, "1 row left out: the section was torn"));
  EXPECT_TRUE(has(good, "one level only of laser.spot_diameter"));
  EXPECT_TRUE(has(good, "a single reading of absorptivity"));
  EXPECT_FALSE(has(good, "no replicates"));
  EXPECT_FALSE(has(good, "no holdout"));
  folder.put("measurements.csv",
             "obs_id,condition_id,quantity,value,unit,u_stat\n1,slow,pool.width,80,um,2\n2,fast,pool.width,70,um,2\n");
  Study const poor = folder.read();
  EXPECT_TRUE(has(poor, "no replicates"));
  EXPECT_TRUE(has(poor, "no holdout"));
  EXPECT_TRUE(has(poor, "2 readings for 4 calibration numbers"));
}

TEST(GoodStudy, TakesAMissingScatterFromReplicates) {
  Folder const folder;
  folder.put("measurements.csv",
             "obs_id,condition_id,quantity,value,unit\n1,slow,pool.width,98,um\n2,slow,pool.width,102,um\n"
             "3,fast,pool.width,50,um\n");
  Study const study = folder.read();
  double const relative = std::sqrt(2 * 0.02 * 0.02);  // of two values 2 % on either side of their mean
  EXPECT_NEAR(study.observations[2].u_stat, relative * 50e-6, 1e-12);
  EXPECT_NE(study.limits.front().find("give no u_stat"), std::string::npos);
}

TEST(GoodStudy, ToleratesCommentsQuotesAndWindowsLines) {
  Folder const folder;
  folder.put("conditions.csv",
             "\xEF\xBB\xBF# made in the lab\r\n\"condition_id\",scan.scan_speed [mm/s],laser.spot_diameter [\xC2\xB5m],"
             "machine\r\n\r\n\"slow, \"\"first\"\"\",500,80,A\r\n");
  folder.put("measurements.csv",
             "obs_id,condition_id,quantity,value,unit,u_stat,x [mm]\r\n1,\"slow, \"\"first\"\"\",pool.width,80,"
             "\xC2\xB5m,2,0.5\r\n");
  EXPECT_EQ(folder.faults(), std::vector<std::string>{});
  Study const study = folder.read();
  EXPECT_EQ(study.conditions[0].id, "slow, \"first\"");
  EXPECT_DOUBLE_EQ(study.observations[0].value, 80e-6);
  EXPECT_DOUBLE_EQ(*study.observables[0].x, 5e-4);
}

TEST(Holdout, IsReadOnlyWhenAskedForAndEveryLookIsLogged) {
  Folder const folder;
  folder.read();
  EXPECT_FALSE(fs::exists(folder.path / "holdout_looks.log"));
  Study const held = folder.read(Role::holdout);
  folder.read(Role::holdout);
  ASSERT_EQ(held.observations.size(), 1U);
  EXPECT_EQ(held.observations[0].id, "9");
  EXPECT_EQ(held.conditions[held.observations[0].condition].id, "kept");
  EXPECT_EQ(lines_of(read_file(folder.path / "holdout_looks.log")).size(), 2U);
}

}  // namespace
}  // namespace layerloop::validation
