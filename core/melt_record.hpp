#pragma once
#include <cstdint>
#include <vector>

#include "core/vec3.hpp"
#include "core/voxel_grid.hpp"

namespace layerloop {

/// Size of a melt pool [m], measured on the isotherm that the case names (default: liquidus).
struct PoolSize {
  double width = 0;   ///< largest width across the track at mid-track
  double depth = 0;   ///< below the surface that the powder was spread on, at mid-track
  double length = 0;  ///< largest extent along the track of what is above the isotherm at one instant
};

/// A cut across a track: what was hotter than the isotherm in the plane normal to it. SI.
struct TrackSection {
  std::int32_t track = 0;  ///< 0-based, in scan order
  double along = 0;        ///< from the beginning of the track
  double x = 0, y = 0;
  double width = 0;
  double depth = 0;           ///< below the surface that the powder was spread on
  double depth_from_top = 0;  ///< below the mean top of powder and metal before the exposure
  double area = 0;            ///< of molten metal
  double area_below = 0;      ///< of that, below the surface that the powder was spread on
  double boiling_depth = 0;   ///< as `depth`, of what was at the boiling point
};

/// Temperature over time of one point of the surface.
struct ProbeHistory {
  double x = 0, y = 0;
  std::vector<double> time;         ///< [s]
  std::vector<double> temperature;  ///< [K]
};

/// What the heat solver remembers of every cell. Shapes: grid.size(), x fastest.
struct MeltRecord {
  VoxelGrid grid;
  std::vector<float> peak_temperature;     ///< [K]
  std::vector<char> melted;                ///< 1: was above the liquidus at some time
  std::vector<float> time_above_liquidus;  ///< [s]
  std::vector<TrackSection> sections;      ///< in scan order; none where a track melted nothing
  std::vector<PoolSize> track_pools;       ///< one a track, in scan order
  PoolSize pool;                           ///< mean over the tracks that melted something
  PoolSize pool_u_num;  ///< discretisation: half a cell in each direction, combined with the scatter between sections
  ProbeHistory probe;   ///< the surface in the middle of the middle track
};

}  // namespace layerloop
