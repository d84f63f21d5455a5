#include "core/grain_size.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

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

PowderSettings fed_powder(Case const& checked) {
  PowderSettings powder = checked.powder;
  double const strength = checked.effect_strength("fines");
  if (strength == 0) return powder;
  auto const& fines = checked.effects.at("fines").parameters;
  double const share = strength * fines.at("mass_fraction"), diameter = fines.at("diameter");
  double const by_volume = share / (1 - share);  // over the rest of the powder; all sizes hold the same materials
  double const grain = std::numbers::pi / 6 * std::pow(diameter, 3);
  powder.diameters.push_back(diameter);
  powder.fractions.push_back(powder.basis == SizeBasis::volume ? by_volume
                                                               : by_volume * mean_grain_volume(checked.powder) / grain);
  double const sum = std::accumulate(powder.fractions.begin(), powder.fractions.end(), 0.0);
  for (double& fraction : powder.fractions) fraction /= sum;
  return powder;
}

double largest_diameter(PowderSettings const& powder) {
  return powder.diameters.empty() ? 0.0 : std::ranges::max(powder.diameters);
}

}  // namespace layerloop
