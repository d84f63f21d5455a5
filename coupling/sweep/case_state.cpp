#include "coupling/sweep/case_state.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/write_file.hpp"

namespace layerloop::coupling {
namespace {

std::array<std::string, 4> const names{"waiting", "interrupted", "done", "failed"};

}  // namespace

std::string const& name_of(CaseState state) { return names.at(static_cast<std::size_t>(state)); }

CaseRecord read_record(std::filesystem::path const& folder) {
  std::filesystem::path const path = folder / "state.json";
  if (!std::filesystem::is_regular_file(path)) return {};
  auto const all = nlohmann::json::parse(read_file(path), nullptr, false);
  if (all.is_discarded()) return {};  // damaged: done again
  auto const state = std::ranges::find(names, all.value("state", ""));
  if (state == names.end()) return {};
  return {static_cast<CaseState>(state - names.begin()), all.value("content", ""), all.value("reason", ""),
          all.value("attempts", 0), all.value("wall_time", 0.0)};
}

void write_record(std::filesystem::path const& folder, CaseRecord const& record) {
  nlohmann::json const all{{"state", name_of(record.state)},
                           {"content", record.content},
                           {"reason", record.reason},
                           {"attempts", record.attempts},
                           {"wall_time", record.wall_time}};
  write_file(folder / "state.json", all.dump(1) + "\n");
}

}  // namespace layerloop::coupling
