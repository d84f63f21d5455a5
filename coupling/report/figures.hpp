#pragma once
#include <string>

#include "coupling/report/report_input.hpp"

namespace layerloop::coupling {

// Each returns figures as HTML; empty where the run has nothing to show.
std::string bed_pictures(ReportInput const& input);
std::string surface_maps(ReportInput const& input);
std::string profiles_and_sizes(ReportInput const& input);
std::string energy_maps(ReportInput const& input);
std::string melt_section_figures(ReportInput const& input);
std::string part_surface_maps(ReportInput const& input);
std::string trends(ReportInput const& input);
std::string wall_time_bar(ReportInput const& input);

}  // namespace layerloop::coupling
