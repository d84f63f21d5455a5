#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/sweep/case_state.hpp"
#include "coupling/sweep/sweep_table.hpp"

namespace layerloop::coupling {

/// report.html of a sweep: every quantity against what was varied, with error bars over the seeds, and every case one
/// click away.
std::string sweep_page(SweepPlan const& plan, std::vector<CaseRecord> const& records, SweepTable const& table);

/// window_N.csv beside the page, one for each processing window on it. \throws FileError
void write_windows(SweepPlan const& plan, SweepTable const& table, std::filesystem::path const& folder);

}  // namespace layerloop::coupling
