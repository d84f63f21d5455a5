#pragma once
#include <vector>

#include "core/case.hpp"
#include "core/powder_bed.hpp"
#include "coupling/run_record.hpp"

namespace layerloop::coupling {

/// Mass of each material in a bed [kg], by PowderBed::material; one value where the powder is of one material.
std::vector<double> mass_by_material(PowderBed const& bed, Case const& checked);

double sum_of(std::vector<double> const& masses);

/// Shares of the materials in the mass that was fed and in that of the spread layer: the grains in the deposition zone
/// whose ids are not in `before` (ascending).
std::vector<MaterialShare> material_shares(PowderBed const& bed, std::vector<std::int64_t> const& before,
                                           std::vector<double> const& mass_fed, Case const& checked);

}  // namespace layerloop::coupling
