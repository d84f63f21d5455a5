#include "core/case.hpp"

#include <cmath>
#include <numbers>

#include "core/units.hpp"

namespace layerloop {

double HeatSettings::isotherm(Material const& metal) const {
  if (pool_isotherm == "liquidus") return metal.liquidus;
  if (pool_isotherm == "solidus") return metal.solidus;
  return parse_quantity(pool_isotherm, Dimension::temperature);
}

double LaserSettings::widening() const {
  double const ratio = rayleigh_length ? focus_offset / *rayleigh_length : 0.0;
  return std::sqrt(1 + ratio * ratio);
}

double LaserSettings::spot_radius() const {
  // A Gaussian's D4sigma width is its 1/e2 diameter; at half of the maximum, exp(-2 r^2 / w^2) = 1/2. All three are the
  // diameter of a top hat's edge.
  bool const gaussian_level = profile == SpotProfile::gaussian && spot_definition == SpotDefinition::fwhm;
  double const diameter = gaussian_level ? spot_diameter * std::sqrt(2 / std::numbers::ln2) : spot_diameter;
  return 0.5 * diameter * widening();
}

double LaserSettings::ring_half_width() const {
  double const width =
      spot_definition == SpotDefinition::fwhm ? ring_width * std::sqrt(2 / std::numbers::ln2) : ring_width;
  return 0.5 * width * widening();
}

}  // namespace layerloop
