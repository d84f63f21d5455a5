#include "core/case.hpp"

#include <cmath>
#include <numbers>

namespace layerloop {

double LaserSettings::spot_radius() const {
  // A Gaussian's D4sigma width is its 1/e2 diameter; at half of the maximum, exp(-2 r^2 / w^2) = 1/2.
  double const diameter =
      spot_definition == SpotDefinition::fwhm ? spot_diameter * std::sqrt(2 / std::numbers::ln2) : spot_diameter;
  return 0.5 * diameter;
}

}  // namespace layerloop
