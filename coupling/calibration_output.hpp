#pragma once
#include <filesystem>

#include "coupling/calibration.hpp"

namespace layerloop::coupling {

/// summary.json (angles in degrees), case_resolved.toml, points.csv, pile_profiles.csv, tilt.csv and report.html.
/// \throws FileError
void write_calibration(std::filesystem::path const& folder, Case const& checked, Calibration const& found);

/// The page alone.
std::string calibration_page(Case const& checked, Calibration const& found);

}  // namespace layerloop::coupling
