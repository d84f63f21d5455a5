// Every bad file of this folder is refused with exactly the faults that its first lines announce,
// `# expect: line:column fragment`, before any computing; every file of good/ is accepted.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

std::filesystem::path const folder = std::filesystem::path(LAYERLOOP_SOURCE_DIR) / "tests/bad_input";

std::vector<std::filesystem::path> cases_in(std::filesystem::path const& where) {
  std::vector<std::filesystem::path> paths;
  for (auto const& entry : std::filesystem::directory_iterator(where)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<std::string> lines_of(std::string const& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Faults of a case, one a line; takes less than a second.
std::vector<std::string> faults_of(std::filesystem::path const& path) {
  auto const start = std::chrono::steady_clock::now();
  std::string message;
  try {
    read_case(path, {});
  } catch (InputError const& fault) {
    message = fault.what();
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
  return lines_of(message);
}

std::string test_name(testing::TestParamInfo<std::filesystem::path> const& info) { return info.param.stem().string(); }

class BadInput : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(BadInput, IsRefusedWhereItIsWrong) {
  std::string const marker = "# expect: ";
  std::vector<std::string> expected;
  for (std::string const& line : lines_of(read_file(GetParam()))) {
    if (!line.starts_with(marker)) break;
    expected.push_back(line.substr(marker.size()));
  }
  ASSERT_FALSE(expected.empty());
  std::vector<std::string> const faults = faults_of(GetParam());
  EXPECT_EQ(faults.size(), expected.size()) << testing::PrintToString(faults);
  for (std::size_t i = 0; i < std::min(faults.size(), expected.size()); ++i) {
    std::size_t const blank = expected[i].find(' ');
    std::string const place = GetParam().string() + ":" + expected[i].substr(0, blank) + ": ";
    EXPECT_TRUE(faults[i].starts_with(place)) << faults[i] << "\nexpected at " << expected[i];
    EXPECT_NE(faults[i].find(expected[i].substr(blank + 1)), std::string::npos)
        << faults[i] << "\nexpected " << expected[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, BadInput, testing::ValuesIn(cases_in(folder)), test_name);

class GoodInput : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(GoodInput, RaisesNoFalseAlarm) { EXPECT_EQ(faults_of(GetParam()), std::vector<std::string>{}); }

INSTANTIATE_TEST_SUITE_P(Corpus, GoodInput, testing::ValuesIn(cases_in(folder / "good")), test_name);

TEST(HostileInput, LargeFileIsRefused) {
  std::filesystem::path const path = std::filesystem::path(testing::TempDir()) / "large.toml";
  std::string text;
  while (text.size() < (2 << 20)) text += "# a comment that goes on and on\n";
  write_file(path, text);
  std::vector<std::string> const faults = faults_of(path);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].find("larger than 1 MiB"), std::string::npos);
}

TEST(HostileInput, DepthIsRefused) {
  std::filesystem::path const path = std::filesystem::path(testing::TempDir()) / "deep.toml";
  for (std::string const piece : {"a.", "[", "{a=", "\"a\".", "a . 1.1 . "}) {
    std::string text = piece.ends_with('.') || piece.ends_with(' ') ? "" : "a = ";
    for (int depth = 0; depth < 100000; ++depth) text += piece;
    write_file(path, text + "a = 1\n");
    EXPECT_EQ(faults_of(path).size(), 1U) << piece;
  }
}

/// Cut anywhere, or with any byte replaced, a good case is read or refused, never worse.
TEST(HostileInput, DamagedCasesAreReadOrRefused) {
  std::string const good = read_file(folder / "good/own_material.toml");
  std::filesystem::path const path = std::filesystem::path(testing::TempDir()) / "damaged.toml";
  auto const survives = [&](std::string const& text) {
    std::ofstream(path, std::ios::binary) << text;
    try {
      read_case(path, {});
    } catch (InputError const&) {
    }
  };
  for (std::size_t cut = 0; cut < good.size(); cut += 3) survives(good.substr(0, cut));
  for (char const byte : {'[', '{', '}', '"', '.', '=', '\n', '\0', '\x80', '-'}) {
    for (std::size_t at = 0; at < good.size(); at += 11) {
      std::string damaged = good;
      damaged[at] = byte;
      survives(damaged);
    }
  }
}

}  // namespace
}  // namespace layerloop
