#include "coupling/effects/spot_drift.hpp"

#include <algorithm>
#include <numbers>

#include "core/effect_catalogue.hpp"

namespace layerloop::coupling {

LaserSettings drifted_laser(Case const& checked, double beam_on_time) {
  LaserSettings laser = checked.laser;
  auto const parameter = [&](char const* name) { return effect_parameter(checked.effects, "spot_drift", name); };
  double const shift =
      checked.effect_strength("spot_drift") * std::min(parameter("rate") * beam_on_time, parameter("largest_shift"));
  if (shift == 0) return laser;
  if (!laser.rayleigh_length) {
    double const waist = laser.spot_radius();
    laser.rayleigh_length = std::numbers::pi * waist * waist / (parameter("beam_quality") * laser.wavelength);
  }
  laser.focus_offset += shift;
  return laser;
}

}  // namespace layerloop::coupling
