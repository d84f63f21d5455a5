#pragma once
#include <cstdint>
#include <vector>

#include "core/voxel_grid.hpp"

namespace layerloop {

/// Size of a melt pool [m], measured on the isotherm that the case names (default: liquidus).
struct PoolSize {
  double width = 0;   ///< largest width across the track at mid-track
  double depth = 0;   ///< below the surface that the powder was spread on, at mid-track
  double length = 0;  ///< largest extent along the track of what is above the isotherm at one instant
};

/// What the heat solver remembers of every cell. Shapes: grid.size(), x fastest.
struct MeltRecord {
  VoxelGrid grid;
  std::vector<float> peak_temperature;     ///< [K]
  std::vector<char> melted;                ///< 1: was above the liquidus at some time
  std::vector<float> time_above_liquidus;  ///< [s]
  std::vector<PoolSize> track_pools;       ///< one a track, in scan order
  PoolSize pool;                           ///< mean over the tracks that melted something
  PoolSize pool_u_num;  ///< discretisation: half a cell in each direction, combined with the scatter between sections
};

}  // namespace layerloop
