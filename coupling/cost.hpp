#pragma once
#include <cstdint>

#include "core/case.hpp"

namespace layerloop::coupling {

/// What a case will have to compute, counted from the case alone.
struct Cost {
  std::int64_t particles = 0;   ///< fed over the whole run
  std::int64_t time_steps = 0;  ///< of DEM: sweeps only, settling adds roughly half as many
  double grain_steps = 0;       ///< with settling
  std::int64_t rays = 0;
  std::int64_t cells = 0;       ///< of the heat grid, at the last layer
  std::int64_t heat_steps = 0;  ///< explicit, over all layers
  double memory = 0;            ///< [bytes] that particles, grid and traces take, about
  double wall_time = 0;         ///< on one thread, within a factor of three or so [s]
};

/// Of the process of the case. If `bed_is_there`, its bed need not be spread again; of a layer loop the first layer.
Cost estimate_cost(Case const& checked, bool bed_is_there = false);

/// Grains fed before layer 2, 3, ...: dose_factor nominal layers packed to 60 %, in grains of the mean volume.
std::int64_t dose_count(Case const& checked);

}  // namespace layerloop::coupling
