#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "coupling/bed_cache.hpp"
#include "validation/quantity.hpp"

namespace layerloop::validation {

/// What one run of a verb says, by reading_name().
struct RunReadings {
  std::map<std::string, Reading> readings;
  std::string stopped = {};  ///< the guard that stopped it; empty: it ran to its end
};
std::string reading_name(std::string const& quantity, Spot const& spot);

/// What was computed before, by content: a run is known by its verb, its resolved case, the files that the case names
/// and the version of the program; a spread bed by what spreading reads of all that. Several processes may share one.
class StageCache {
 public:
  StageCache(std::filesystem::path folder, Communicator const& comm);

  /// Name of a run. \param measured  what is asked of it beside the plain quantities
  static std::string key(Verb verb, Case const& checked, std::string const& measured = {});

  /// Collective.
  std::optional<RunReadings> find(std::string const& key) const;
  void keep(std::string const& key, RunReadings const& run) const;

  /// The layers that the recoater spreads, from the cache or spread now. Collective.
  /// \throws PhysicsError, StoppedBySignal
  coupling::BedCache::Bed spread(Case const& checked) const { return beds_.spread(checked, comm_); }

  /// A folder of this process alone.
  std::filesystem::path private_folder() const;

 private:
  std::filesystem::path folder_;
  Communicator const& comm_;
  coupling::BedCache beds_;
};

}  // namespace layerloop::validation
