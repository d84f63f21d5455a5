#pragma once
#include <filesystem>

#include "core/case.hpp"
#include "core/communicator.hpp"

namespace layerloop::coupling {

/// Beds that were spread before, by the content of what spreading reads: one bed serves many lasers. Several processes
/// may share the folder; where two want the same bed, the later waits for the earlier.
class BedCache {
 public:
  explicit BedCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  struct Bed {
    std::filesystem::path folder;  ///< with its checkpoint
    bool computed;                 ///< just now
  };
  /// The layers that the recoater spreads, as they were or spread now. Collective. \throws PhysicsError, FileError,
  /// StoppedBySignal
  Bed spread(Case const& checked, Communicator const& comm) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace layerloop::coupling
