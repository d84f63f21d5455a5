#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/case.hpp"

namespace layerloop::coupling {

/// report.html over runs that differ in their seed only, and beside it layers.csv and profiles.csv: means with the half
/// widths of their 95 % t-intervals. \param summary  of summary_over_replicates() \param folders  of the runs, inside
/// `folder`; pictures are those of the first \note root rank only \throws FileError
void write_replicate_report(std::filesystem::path const& folder, Case const& checked, nlohmann::json const& summary,
                            std::vector<std::string> const& folders);

}  // namespace layerloop::coupling
