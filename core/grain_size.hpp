#pragma once
#include "core/case.hpp"

namespace layerloop {

/// Mean volume of the grains by number [m^3], from fractions by number or by volume.
double mean_grain_volume(PowderSettings const& powder);

/// The powder as it is fed: its size distribution, with the fines of effects.fines mixed in.
PowderSettings fed_powder(Case const& checked);

/// 0 without powder [m].
double largest_diameter(PowderSettings const& powder);

}  // namespace layerloop
