#pragma once
#include <filesystem>
#include <string>

#include "coupling/sweep/sweep_plan.hpp"

namespace layerloop::coupling {

/// What every point of a sweep will cost and all of it together, as a table for the terminal. A bed that several
/// points share is counted once. Where the folder holds cases that are done, their wall time judges the estimate.
std::string cost_table(SweepPlan const& plan, std::filesystem::path const& folder);

}  // namespace layerloop::coupling
