#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "coupling/sweep/case_state.hpp"
#include "coupling/sweep/sweep_plan.hpp"

namespace layerloop::coupling {

struct SweepOptions {
  std::filesystem::path folder;
  bool resume = false;                ///< go on with what lies in the folder
  std::optional<std::int64_t> index;  ///< this case only, from 1
  int groups = 1;                     ///< of ranks, each with a case of its own at a time
  bool only_report = false;           ///< compute nothing, write tables and report of what is there
  bool quiet = false;
};

/// "case_0012"
std::string case_folder(std::int64_t number);

/// Whether a layer loop may take its first layer from the cache of beds: what is frozen there is part of the solid.
bool shares_first_layer(Case const& checked);

/// Nothing of another sweep or verb may be mixed in or lost. \throws InputError  or the index is none of a case;
/// without a folder that alone is looked at
void refuse_strangers(SweepPlan const& plan, SweepOptions const& options);

/// Runs every case that is not done yet, in the order of the plan, each in its own folder; beds that several cases
/// need are spread once. A case that a guard stops does not stop the others. Several processes may work on one folder
/// at a time: a case belongs to the one that holds its lock. Whoever finds no case waiting writes the tables and the
/// report. Collective. \throws InputError  the folder holds another sweep, or results without `resume`; FileError;
/// StoppedBySignal after the case at hand has left its checkpoint
void run_sweep(SweepPlan const& plan, SweepOptions const& options, Communicator const& world);

/// What the folder says of each case, by SweepPlan::cases.
std::vector<CaseRecord> read_records(SweepPlan const& plan, std::filesystem::path const& folder);

}  // namespace layerloop::coupling
