#include "validation/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "core/case_values.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"
#include "core/spelling.hpp"
#include "core/write_file.hpp"
#include "validation/study_tables.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;

/// What is wrong with one file.
struct FileFaults {
  fs::path path;
  std::vector<Fault> faults = {};
};

void throw_if_any(std::vector<FileFaults>& files) {
  std::string all;
  for (FileFaults& file : files) {
    std::ranges::stable_sort(file.faults, {}, &Fault::place);
    for (Fault const& fault : file.faults)
      all += fmt::format("{}{}:{}:{}: {}", all.empty() ? "" : "\n", file.path.string(), fault.place.line,
                         fault.place.column, fault.message);
  }
  if (!all.empty()) throw InputError(all);
}

std::string text_of(TomlEntry const& entry, std::vector<Fault>& faults) {
  auto const* const text = std::get_if<std::string>(&entry.value.content);
  if (text && !text->empty()) return *text;
  faults.push_back(
      {entry.place, fmt::format("{} = {} (must be text in quotation marks)", entry.key, shown(entry.value))});
  return "";
}

/// Text of [study], by key.
std::map<std::string, std::string> study_keys(std::vector<TomlTable> const& tables, std::vector<Fault>& faults) {
  std::vector<std::string> const known{"name", "case", "conditions", "measurements"};
  std::map<std::string, std::string> keys{{"conditions", "conditions.csv"}, {"measurements", "measurements.csv"}};
  bool found = false;
  for (TomlTable const& table : tables) {
    if (table.name == "calibration") continue;
    if (table.name != "study" && !table.name.empty())
      faults.push_back({table.place, fmt::format("unknown table [{}] (known: [study], [[calibration]]){}", table.name,
                                                 did_you_mean(table.name, {"study", "calibration"}))});
    for (TomlEntry const& entry : table.entries) {
      if (table.name.empty())
        faults.push_back({entry.place, fmt::format("unknown key \"{}\" outside of any table (known: [study], "
                                                   "[[calibration]])",
                                                   entry.key)});
      if (table.name != "study") continue;
      if (std::ranges::find(known, entry.key) == known.end()) {
        faults.push_back({entry.place, fmt::format("unknown key \"{}\" in [study] (known: {}){}", entry.key,
                                                   fmt::join(known, ", "), did_you_mean(entry.key, known))});
      } else {
        keys[entry.key] = text_of(entry, faults);
      }
    }
    found = found || table.name == "study";
    if (table.name == "study" && !keys.contains("case"))
      faults.push_back({table.place, "missing key \"case\" in [study] (the case file of the model that is compared)"});
  }
  if (!found) faults.push_back({{}, "missing table [study] (it holds name, case, conditions, measurements)"});
  return keys;
}

CsvTable read_table(FileFaults& file, std::vector<Fault>& of_study, std::string const& key) {
  if (!fs::is_regular_file(file.path)) {
    of_study.push_back({{},
                        fmt::format("{} = \"{}\" is not a file (looked for {})", key, file.path.filename().string(),
                                    file.path.string())});
    return {};
  }
  return parse_csv(read_file(file.path), file.faults);
}

bool has_role(CsvTable const& table, std::string const& role) {
  auto const column = std::ranges::find(table.header, "role", &CsvField::text) - table.header.begin();
  return std::ranges::any_of(table.rows, [&](auto const& row) {
    return column < static_cast<std::ptrdiff_t>(row.size()) && row[static_cast<std::size_t>(column)].text == role;
  });
}

/// Every look at what was held out leaves a line; scripts and readers count them.
void log_holdout_look(fs::path const& folder) {
  auto const now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  fs::path const path = folder / "holdout_looks.log";
  std::ofstream file(path, std::ios::app);
  file << fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z layerloop {}\n", utc.tm_year + 1900, utc.tm_mon + 1,
                      utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec, LAYERLOOP_VERSION);
  file.close();
  if (!file) throw FileError(fmt::format("cannot write {} (looks at the holdout are counted there)", path.string()));
}

std::vector<TomlTable> tables_of(FileFaults& file) {
  try {
    return parse_tables(read_file(file.path));
  } catch (SyntaxFault const& syntax) {
    std::vector<FileFaults> all{{file.path, {syntax.fault}}};
    throw_if_any(all);
  }
  return {};
}

}  // namespace

Study read_study(fs::path const& folder, Role which) {
  fs::path const file = fs::is_directory(folder) ? folder / "study.toml" : folder;
  if (!fs::is_regular_file(file))
    throw FileError(
        fmt::format("cannot read the study {} (no such file; a study is a folder with study.toml)", file.string()));
  std::vector<FileFaults> files{{file}};
  std::vector<TomlTable> const tables = tables_of(files[0]);
  std::map<std::string, std::string> keys = study_keys(tables, files[0].faults);
  Study study;
  study.folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
  study.name = keys.contains("name") ? keys["name"] : fs::absolute(study.folder).lexically_normal().filename().string();
  study.case_file = study.folder / keys["case"];
  if (keys.contains("case") && !keys["case"].empty() && !fs::is_regular_file(study.case_file))
    files[0].faults.push_back(
        {{}, fmt::format("case = \"{}\" is not a file (looked for {})", keys["case"], study.case_file.string())});
  files.push_back({study.folder / keys["conditions"]});
  files.push_back({study.folder / keys["measurements"]});
  CsvTable const conditions = read_table(files[1], files[0].faults, "conditions");
  CsvTable const measurements = read_table(files[2], files[0].faults, "measurements");
  if (!conditions.header.empty()) study.conditions = read_conditions(conditions, files[1].faults);
  if (!measurements.header.empty()) read_measurements(measurements, which, study, files[2].faults);
  study.calibration = read_calibration(tables, study.conditions, files[0].faults);
  throw_if_any(files);
  std::vector<std::string> const limits = limits_of(study, has_role(measurements, "holdout"));
  study.limits.insert(study.limits.end(), limits.begin(), limits.end());
  if (which == Role::holdout && Communicator().is_root()) log_holdout_look(study.folder);  // one look, of all ranks
  return study;
}

}  // namespace layerloop::validation
