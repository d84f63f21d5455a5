#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/case.hpp"
#include "core/heat_source.hpp"

namespace layerloop::coupling {

/// The tracks of one layer in the order they are exposed, about the middle of the deposition zone: those of scan.path,
/// or parallel ones of equal length, scanned to and fro in the order of scan.track_index; the patch runs along
/// scan.direction and turns by scan.rotation from layer to layer. Times count from the start of the exposure; between
/// tracks the beam is off for scan.dwell. \throws InputError a file that cannot be a way, or leaves the deposition zone
std::vector<Track> scan_path(Case const& checked, std::int32_t layer);

/// Corners of the box around tracks, in the plane z = 0 [m].
struct PathBox {
  Vec3 lower, upper;
};
PathBox box_of(std::vector<Track> const& tracks);

/// From where to where along x the exposure heats: the tracks and heat.margin beyond their ends [m].
std::array<double, 2> heated_range(Case const& checked, std::int32_t layer);

/// Time [s] since the beam was next to the middle of each track on the nearest of the tracks before it; nothing for the
/// first.
std::vector<std::optional<double>> return_times(std::vector<Track> const& tracks);

}  // namespace layerloop::coupling
