#pragma once
#include "core/case.hpp"
#include "core/powder_bed.hpp"

namespace layerloop::coupling {

/// The grains of powder.bed, y brought into [0, width); none without the key.
/// Materials are those of the file where the case has a mixture.
/// \throws InputError the file is damaged, a material is not of the case, or a grain lies outside the zones or in their
/// floor (the plate's top is at z = 0 before layer 1); FileError
PowderBed first_bed(Case const& checked);

}  // namespace layerloop::coupling
