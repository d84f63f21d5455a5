#pragma once
#include <vector>

#include "core/absorbed_power.hpp"
#include "core/vec3.hpp"

namespace layerloop {

/// One straight pass of the beam at constant power and speed.
struct Track {
  Vec3 begin, end;    ///< beam centre on the plane z = 0 of the platforms [m]
  double begin_time;  ///< [s] from the start of the layer's exposure
  double end_time;    ///< [s]
  double power;       ///< incident [W]
};

/// The heat that a layer's exposure brings: between time[i] and time[i + 1] the cells of `power[i]` are heated.
/// A stretch with the beam off has no cells. Shapes: time has power.size() + 1 entries, ascending.
struct HeatSource {
  std::vector<double> time;          ///< [s]
  std::vector<AbsorbedPower> power;  ///< [W] per cell
  std::vector<Track> tracks;         ///< for the pool measures
  double beam_radius = 0;            ///< 1/e^2, on the bed [m]; only a keyhole asks for it
};

}  // namespace layerloop
