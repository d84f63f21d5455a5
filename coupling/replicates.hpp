#pragma once
#include "core/case.hpp"
#include "core/communicator.hpp"
#include "coupling/layer_loop.hpp"

namespace layerloop::coupling {

/// The layer loop once, or run.replicates times with the seeds seed, seed + 1, ...: each run in its own folder seed_S,
/// and on top summary.json with means and intervals, report.html and CSV tables. \note Collective \throws as
/// run_layer_loop
void run_replicates(Case const& checked, RunOptions const& options, Communicator const& comm);

}  // namespace layerloop::coupling
