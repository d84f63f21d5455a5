#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/heat_source.hpp"
#include "core/melt_record.hpp"
#include "thermal/heat_cells.hpp"

namespace layerloop::thermal {

/// Width and depth of what was hotter than the isotherm in the transverse plane of cells i.
///
/// Only metal counts, and of it the largest patch that is connected in the plane. Edges: linear interpolation between
/// the cell centres on both sides of the isotherm; half a cell beyond the centre where there is no metal next to it.
/// Depth is counted from the mean top of the solid under the patch, i.e. the surface that the powder was spread on.
/// \param temperature  peak temperature [K], shape grid.size()
/// \param solid        volume fraction before the exposure, shape grid.size()
/// \param track_y      of the beam's line; the plane of a periodic grid is unrolled around it [m]
/// Returns nothing when no metal was that hot. `length` is left at zero.
std::optional<PoolSize> measure_section(HeatCells const& cells, std::span<float const> temperature,
                                        std::span<double const> solid, std::int32_t i, double track_y, double isotherm);

/// Length of the stretch around the hottest entry of a profile along x that is above the isotherm [m], ends
/// interpolated.
double measure_length(std::span<float const> profile, double cell, double isotherm);

/// Sizes of one track's pool, and how much its sections (width, depth) and instants (length) scatter.
struct TrackPool {
  PoolSize mean, variance;
};

/// \param sections  of one track; \param lengths at several instants near mid-track
TrackPool summarise(std::span<PoolSize const> sections, std::span<double const> lengths);

}  // namespace layerloop::thermal
