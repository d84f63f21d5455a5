#pragma once
#include <cstdint>
#include <vector>

#include "core/powder_bed.hpp"

namespace layerloop::dem {

/// Grains that each grain touches or overlaps (from the positions alone; walls do not count), periodic along y.
/// Shape: bed.size().
std::vector<std::int32_t> touching_grains(PowderBed const& bed, double period);

}  // namespace layerloop::dem
