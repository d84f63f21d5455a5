#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/heat_source.hpp"
#include "core/melt_record.hpp"
#include "thermal/heat_cells.hpp"

namespace layerloop::thermal {

/// A line across or along a track, sampled at steps of one cell; the first step stands on the centre of a cell, so
/// that lines along x and y meet cell centres only.
struct SampleLine {
  /// \param direction  level and of unit length
  SampleLine(HeatCells const& cells, Vec3 const& through, Vec3 const& direction);

  /// Column of cells with its share.
  struct Corner {
    std::int32_t i, j;
    double share;
  };
  /// Of bilinear interpolation; none outside the grid. \param aside  steps to the left of the line
  std::vector<Corner> corners(std::int64_t step, std::int64_t aside = 0) const;

  std::int64_t first, last;  ///< steps inside the grid; at most one period of a periodic grid

 private:
  HeatCells const& cells_;
  double x_, y_, dx_, dy_;  ///< in cells, from the centre of cell (0, 0)
};

/// Width, depth and area of what was hotter than the isotherm in the plane through a point of a track, normal to it.
///
/// Temperatures are interpolated between columns of cells (not at all for tracks along x or y). Only metal counts, and
/// of it the largest patch that is connected in the plane. Edges: linear interpolation between the samples on both
/// sides of the isotherm; half a cell beyond the sample where there is no metal next to it. Depth is counted from the
/// mean top of the solid under the patch, i.e. the surface that the powder was spread on.
/// \param temperature  peak temperature [K], shape grid.size()
/// \param content      what filled the cells before the exposure
/// \param along        direction of the track: level, of unit length
/// Returns nothing when no metal was that hot. Track, place and boiling depth are left to the caller.
std::optional<TrackSection> measure_section(HeatCells const& cells, std::span<float const> temperature,
                                            CellContent const& content, Vec3 const& at, Vec3 const& along,
                                            double isotherm);

/// Length of the stretch around the hottest entry of a profile along the track that is above the isotherm [m], ends
/// interpolated.
double measure_length(std::span<float const> profile, double cell, double isotherm);

/// Sizes of one track's pool, and how much its sections (width, depth) and instants (length) scatter.
struct TrackPool {
  PoolSize mean, variance;
};

/// \param sections  of one track; \param lengths at several instants near mid-track
TrackPool summarise(std::span<TrackSection const> sections, std::span<double const> lengths);

}  // namespace layerloop::thermal
