#include "core/grain_size.hpp"

#include <cmath>
#include <numbers>

namespace layerloop {

double mean_grain_volume(PowderSettings const& powder) {
  double volume = 0, count = 0;
  for (std::size_t c = 0; c < powder.diameters.size(); ++c) {
    double const grain = std::numbers::pi / 6 * std::pow(powder.diameters[c], 3);
    volume += powder.basis == SizeBasis::number ? powder.fractions[c] * grain : powder.fractions[c];
    count += powder.basis == SizeBasis::number ? powder.fractions[c] : powder.fractions[c] / grain;
  }
  return volume / count;
}

}  // namespace layerloop
