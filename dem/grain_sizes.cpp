#include "dem/grain_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace layerloop::dem {
namespace {
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double weight_of(double diameter, Weight weight) { return weight == Weight::number ? 1.0 : std::pow(diameter, 3); }
}  // namespace

double diameter_quantile(std::vector<double> radii, double share, Weight weight) {
  std::ranges::sort(radii);
  double total = 0, below = 0;
  for (double const r : radii) total += weight_of(r, weight);
  for (double const r : radii) {
    below += weight_of(r, weight);
    if (below >= share * total) return 2 * r;
  }
  return radii.empty() ? nothing : 2 * radii.back();
}

double mean_diameter(std::span<double const> radii, int p, int q) {
  double above = 0, below = 0;
  for (double const r : radii) {
    above += std::pow(2 * r, p);
    below += std::pow(2 * r, q);
  }
  return radii.empty() ? nothing : above / below;
}

double fed_diameter_quantile(PowderSettings const& powder, double share, Weight weight) {
  std::vector<std::size_t> order(powder.diameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return powder.diameters[k]; });
  auto const held = [&](std::size_t k) {
    double const d = powder.diameters[k];
    double const number =
        powder.basis == SizeBasis::number ? powder.fractions[k] : powder.fractions[k] / std::pow(d, 3);
    return number * weight_of(d, weight);
  };
  double total = 0, below = 0;
  for (std::size_t const k : order) total += held(k);
  for (std::size_t const k : order) {
    below += held(k);
    if (below >= share * total * (1 - 1e-12)) return powder.diameters[k];
  }
  return order.empty() ? nothing : powder.diameters[order.back()];
}

double lacey_index(std::span<std::size_t const> coarse, std::span<std::size_t const> all) {
  double grains = 0, coarse_grains = 0, slices = 0;
  for (std::size_t b = 0; b < all.size(); ++b) {
    grains += static_cast<double>(all[b]);
    coarse_grains += static_cast<double>(coarse[b]);
    slices += all[b] > 0 ? 1 : 0;
  }
  if (grains < 2) return nothing;
  double const p = coarse_grains / grains, apart = p * (1 - p), random = apart * (slices - 1) / (grains - 1);
  double variance = 0;
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (all[b] == 0) continue;
    double const n = static_cast<double>(all[b]), share = static_cast<double>(coarse[b]) / n;
    variance += n / grains * (share - p) * (share - p);
  }
  return apart - random > 0 ? (apart - variance) / (apart - random) : nothing;
}

}  // namespace layerloop::dem
