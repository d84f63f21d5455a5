#pragma once
#include "core/case.hpp"

namespace layerloop {

/// Mean volume of the grains by number [m^3], from fractions by number or by volume.
double mean_grain_volume(PowderSettings const& powder);

}  // namespace layerloop
