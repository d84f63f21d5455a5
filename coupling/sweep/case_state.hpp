#pragma once
#include <filesystem>
#include <string>

namespace layerloop::coupling {

/// waiting: not begun. interrupted: begun and not ended (killed, stopped, a full disk), to be tried again. failed: the
/// model cannot do it, and would say so again.
enum class CaseState { waiting, interrupted, done, failed };

std::string const& name_of(CaseState state);

/// How far a case of a sweep has come; state.json in its folder.
struct CaseRecord {
  CaseState state = CaseState::waiting;
  std::string content;  ///< what was asked, by its hash
  std::string reason;   ///< why it failed or was interrupted
  int attempts = 0;
  double wall_time = 0;  ///< of the last attempt [s]
};

/// \throws FileError
CaseRecord read_record(std::filesystem::path const& folder);
void write_record(std::filesystem::path const& folder, CaseRecord const& record);

}  // namespace layerloop::coupling
