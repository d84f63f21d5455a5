// Which folder may include which, and where third-party headers may appear.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "core/write_file.hpp"

namespace layerloop {
namespace {

std::filesystem::path const source_dir = LAYERLOOP_SOURCE_DIR;

using Names = std::set<std::string>;

std::map<std::string, Names> const may_include = {
    {"core", {"core"}},
    {"dem", {"dem", "core"}},
    {"raytrace", {"raytrace", "core"}},
    {"thermal", {"thermal", "core"}},
    {"coupling", {"coupling", "dem", "raytrace", "thermal", "core"}},
    {"validation", {"validation", "coupling", "dem", "raytrace", "thermal", "core"}},
    {"apps", {"apps", "validation", "coupling", "dem", "raytrace", "thermal", "core"}},
};

/// A library and the folders it may be used in; `doctor` asks every library for its version.
struct Island {
  std::regex header;
  Names folders;
  bool headers_too;  ///< whether .hpp files of these folders may include it
};

std::vector<Island> const islands = {
    {std::regex("toml\\+\\+/.*"), {"core"}, false},
    {std::regex("(hdf5|H5.*)\\.h"), {"core", "apps"}, false},
    {std::regex("png\\.h"), {"core", "apps"}, false},
    {std::regex("embree3/.*"), {"raytrace", "apps"}, false},
    {std::regex("petsc.*"), {"thermal", "apps"}, true},
    {std::regex("CGAL/.*"), {"coupling", "apps"}, false},
    {std::regex("CLI/.*"), {"apps"}, true},
};

struct Include {
  std::filesystem::path file;
  std::string folder, header;
  bool quoted;  // "..." rather than <...>
};

std::vector<Include> all_includes() {
  static std::regex const pattern("^\\s*#\\s*include\\s*([<\"])([^>\"]+)[>\"].*");
  std::vector<Include> found;
  for (auto const& [folder, allowed] : may_include) {
    for (auto const& entry : std::filesystem::recursive_directory_iterator(source_dir / folder)) {
      std::string const extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      std::istringstream text(read_file(entry.path()));
      for (std::string line; std::getline(text, line);) {
        std::smatch match;
        if (std::regex_match(line, match, pattern)) found.push_back({entry.path(), folder, match[2], match[1] == "\""});
      }
    }
  }
  return found;
}

TEST(IncludeGraph, OnlyAllowedEdges) {
  std::size_t edges = 0;
  for (Include const& include : all_includes()) {
    if (!include.quoted) continue;
    std::size_t const slash = include.header.find('/');
    if (slash == std::string::npos) {  // only what the build generates has no folder
      EXPECT_FALSE(std::filesystem::exists(source_dir / include.folder / include.header))
          << include.file << " includes \"" << include.header << "\": write the folder, as in \"core/case.hpp\"";
      continue;
    }
    std::string const target = include.header.substr(0, slash);
    ASSERT_TRUE(may_include.contains(target)) << include.file << " includes " << include.header;
    EXPECT_TRUE(may_include.at(include.folder).contains(target)) << include.file << " includes " << include.header;
    ++edges;
  }
  EXPECT_GT(edges, 100U);  // the walk has seen the code
}

TEST(IncludeGraph, LibrariesStayOnTheirIslands) {
  for (Include const& include : all_includes()) {
    for (Island const& island : islands) {
      if (!std::regex_match(include.header, island.header)) continue;
      EXPECT_TRUE(island.folders.contains(include.folder)) << include.file << " includes " << include.header;
      EXPECT_TRUE(island.headers_too || include.file.extension() == ".cpp")
          << include.file << " passes " << include.header << " on to all who include it";
    }
  }
}

TEST(IncludeGraph, OnlyTheBlindTestKnowsTheTruth) {
  std::size_t users = 0;
  for (Include const& include : all_includes()) {
    bool const truth = include.header.starts_with("validation/truth/"),
               blind = include.header.starts_with("validation/blind/");
    if (!truth && !blind) continue;
    std::string const file = std::filesystem::relative(include.file, source_dir).string();
    bool const tester = file.starts_with("validation/blind/") || file == "apps/blind.cpp";
    EXPECT_TRUE(tester || (truth && file.starts_with("validation/truth/")))
        << file << " includes " << include.header << ": a diagnosis must not be able to look at what is hidden";
    ++users;
  }
  EXPECT_GT(users, 5U);
}

}  // namespace
}  // namespace layerloop
