#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/case.hpp"
#include "core/heat_source.hpp"

namespace layerloop::coupling {

/// The tracks of one layer in the order they are exposed: parallel to x, centred in the deposition zone and across the
/// width, scanned to and fro; the hatch turns by scan.rotation (a multiple of pi) from layer to layer.
/// Times count from the start of the exposure; between tracks the beam is off for scan.dwell.
std::vector<Track> scan_path(Case const& checked, std::int32_t layer);

/// From where to where along x the exposure heats: the tracks and heat.margin beyond their ends [m].
std::array<double, 2> heated_range(Case const& checked);

}  // namespace layerloop::coupling
