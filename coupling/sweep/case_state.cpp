#include "coupling/sweep/case_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "coupling/file_lock.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::array<std::string, 5> const names{"waiting", "interrupted", "done", "failed", "running"};

/// Empty where there is none.
json object_in(fs::path const& path) {
  if (!fs::is_regular_file(path)) return json::object();
  json all = json::parse(read_file(path), nullptr, false);
  return all.is_object() ? all : json::object();
}

}  // namespace

std::string const& name_of(CaseState state) { return names.at(static_cast<std::size_t>(state)); }

fs::path lock_of(fs::path const& folder) { return folder / "lock"; }

CaseRecord read_record(fs::path const& folder) {
  json const all = object_in(folder / "state.json");
  auto const word = [&](char const* key) {
    return all.contains(key) && all[key].is_string() ? all[key].get<std::string>() : "";
  };
  auto const state = std::ranges::find(names, word("state"));
  if (state == names.end()) return {};
  CaseRecord record{static_cast<CaseState>(state - names.begin()), word("content"), word("reason"), 0, 0};
  double const attempts = all.contains("attempts") ? number_or_nan(all["attempts"]) : 0,
               time = all.contains("wall_time") ? number_or_nan(all["wall_time"]) : 0;
  record.attempts = std::isfinite(attempts) ? static_cast<int>(attempts) : 0;
  record.wall_time = std::isfinite(time) ? time : 0;
  if (record.state == CaseState::done && object_in(folder / "summary.json").empty()) {
    record.state = CaseState::interrupted;
    record.reason = "its summary.json is lost or damaged";
  }
  return record;
}

CaseRecord read_record_now(fs::path const& folder) {
  CaseRecord record = read_record(folder);
  if (record.state == CaseState::interrupted && FileLock::is_held(lock_of(folder))) {
    record.state = CaseState::running;
    record.reason.clear();
  }
  return record;
}

void write_record(fs::path const& folder, CaseRecord const& record) {
  nlohmann::json const all{{"state", name_of(record.state)},
                           {"content", record.content},
                           {"reason", record.reason},
                           {"attempts", record.attempts},
                           {"wall_time", record.wall_time}};
  write_file(folder / "state.json", all.dump(1) + "\n");
}

}  // namespace layerloop::coupling
