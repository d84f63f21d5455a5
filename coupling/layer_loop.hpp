#pragma once
#include <filesystem>
#include <vector>

#include "core/bed_file.hpp"
#include "core/case.hpp"
#include "core/communicator.hpp"
#include "coupling/run_record.hpp"

namespace layerloop::coupling {

struct RunOptions {
  std::filesystem::path folder;            ///< results go here; made when missing
  bool resume = false;                     ///< go on from the newest good checkpoint in the folder
  bool quiet = false;                      ///< no progress
  std::vector<BedFormat> exports;          ///< in which every bed is written besides bed_NNNN.h5
  std::filesystem::path first_layer = {};  ///< folder where the first layer was spread before; empty: it is spread
};

/// The layer loop: dose, spread, measure, trace, heat, consolidate, mesh, lower, `run.layers` times; without a laser
/// the zone to be frozen takes the place of the stages after the measuring, or the powder stays as it is. Leaves in the
/// folder bed_NNNN.h5, heat_NNNN.h5, solid_NNNN.stl, pictures and a checkpoint per layer, and at the end summary.json,
/// CSV tables and report.html. \note Collective \throws PhysicsError a guard or a ledger stopped the run;
/// StoppedBySignal after a checkpoint; FileError
RunRecord run_layer_loop(Case const& checked, RunOptions const& options, Communicator const& comm);

}  // namespace layerloop::coupling
