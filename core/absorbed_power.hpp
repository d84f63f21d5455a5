#pragma once
#include <cstdint>
#include <vector>

#include "core/voxel_grid.hpp"

namespace layerloop {

/// Where the power of one beam position went [W]. Raw figures: incident = absorbed + escaped + attenuated +
/// residual to 1e-12.
struct AbsorbedPower {
  std::vector<std::int64_t> cell;  ///< cells of the heat grid that absorb, ascending
  std::vector<double> watts;       ///< [W] in each of them
  double outside_grid = 0;         ///< absorbed, but beyond the heat grid [W]; part of `absorbed`

  double incident = 0;
  double absorbed = 0;
  double escaped = 0;     ///< left the scene upwards, sideways (open sides) or through the straight-through bottom
  double attenuated = 0;  ///< lost above the bed, in the plume
  double residual = 0;    ///< still on rays that were cut off: booked, never dropped

  double absorptivity = 0;    ///< absorbed / incident
  double standard_error = 0;  ///< of the absorptivity, from independent replicates
  std::int64_t rays = 0;
  double mean_bounces = 0;  ///< surface hits per ray
};

/// Adds `other` with a weight (share of the time spent at its beam position) into `sum`. \pre same grid
void accumulate(AbsorbedPower& sum, AbsorbedPower const& other, double weight);

/// |incident - absorbed - escaped - attenuated - residual| / incident.
double ray_energy_error(AbsorbedPower const& power);

}  // namespace layerloop
