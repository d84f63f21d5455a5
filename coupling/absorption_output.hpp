#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/case.hpp"
#include "coupling/absorption_study.hpp"

namespace layerloop::coupling {

/// Absorbed share seen from above, of the last bed: under even light over that which falls on the pixel (its local
/// absorptivity), under a spot per area [1/m^2]; and the standard error of it.
struct AbsorptionMap {
  AreaMap value, error;
};
AbsorptionMap absorption_map(AbsorptionStudy const& study, Case const& checked);

/// summary.json as the contract names it. \note what has a place is of the last bed
nlohmann::json absorption_summary(Case const& checked, AbsorptionStudy const& study);

/// The grains of a bed as CSV, with periods and floor: --bed takes it again. \note root rank only \throws FileError
void write_lit_bed(std::filesystem::path const& path, LitBed const& lit);

/// Everything else that a study leaves in its folder. \note root rank only \throws FileError
void write_absorption(std::filesystem::path const& folder, Case const& checked, AbsorptionStudy const& study);

/// report.html, one page that needs no network. \param folder  holds the pictures
std::string absorption_page(std::filesystem::path const& folder, Case const& checked, AbsorptionStudy const& study);

}  // namespace layerloop::coupling
