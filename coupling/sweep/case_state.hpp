#pragma once
#include <filesystem>
#include <string>

namespace layerloop::coupling {

/// waiting: not begun. interrupted: begun and not ended (killed, stopped, a full disk), to be tried again. failed: the
/// model cannot do it, and would say so again. running: a process is at it now.
enum class CaseState { waiting, interrupted, done, failed, running };

std::string const& name_of(CaseState state);

/// How far a case of a sweep has come; state.json in its folder.
struct CaseRecord {
  CaseState state = CaseState::waiting;
  std::string content;  ///< what was asked, by its hash
  std::string reason;   ///< why it failed or was interrupted
  int attempts = 0;
  double wall_time = 0;  ///< of the last attempt [s]
};

/// What the folder says; damaged files make it waiting, or a case that was done interrupted. \throws FileError
CaseRecord read_record(std::filesystem::path const& folder);
/// The same, with `running` where another process holds the lock.
CaseRecord read_record_now(std::filesystem::path const& folder);
/// The file that the process at work on a case holds.
std::filesystem::path lock_of(std::filesystem::path const& folder);
void write_record(std::filesystem::path const& folder, CaseRecord const& record);

}  // namespace layerloop::coupling
