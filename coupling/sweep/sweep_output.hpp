#pragma once
#include <filesystem>
#include <vector>

#include "coupling/sweep/case_state.hpp"
#include "coupling/sweep/sweep_plan.hpp"

namespace layerloop::coupling {

/// What a sweep came to: summary.json with every case and the figures of its verb, cases.csv with one row a case,
/// points.csv with means over the seeds and their 95 % intervals, report.html. \param records  by SweepPlan::cases
/// \throws FileError
void write_sweep(SweepPlan const& plan, std::vector<CaseRecord> const& records, std::filesystem::path const& folder);

}  // namespace layerloop::coupling
