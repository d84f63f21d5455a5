#pragma once
#include <set>

#include "validation/stage_cache.hpp"

namespace layerloop::validation {

/// The verb that gives a quantity. \param scans  the case has a scan, so that light is traced along it
Verb verb_for(Observable const& observable, bool scans);

/// Whether another seed gives other readings: tracks on a plate with a given absorptivity draw nothing.
bool depends_on_seed(Verb verb, Case const& checked);

/// Readings of one run and what had to be computed for it.
struct StageRun {
  RunReadings readings;
  int computed = 0;  ///< runs: of a bed, and of what happens on it
};

/// Runs a verb, or finds it in the cache. Every quantity that the verb gives is read, and those at `places`.
/// Collective. \throws InputError, FileError, StoppedBySignal; a physics guard makes it a run without readings
StageRun run_stage(Verb verb, Case const& checked, std::set<std::pair<std::string, Spot>> const& places,
                   StageCache const& cache, Communicator const& comm);

}  // namespace layerloop::validation
