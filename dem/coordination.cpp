#include "dem/coordination.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace layerloop::dem {

std::vector<std::int32_t> touching_grains(PowderBed const& bed, double period) {
  std::vector<std::int32_t> contacts(bed.size(), 0);
  if (bed.size() == 0) return contacts;
  std::vector<std::size_t> by_x(bed.size());
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::ranges::sort(by_x, {}, [&](std::size_t i) { return bed.x[i]; });
  double const largest = *std::ranges::max_element(bed.radius);
  for (std::size_t a = 0; a < by_x.size(); ++a) {
    std::size_t const i = by_x[a];
    for (std::size_t b = a + 1; b < by_x.size() && bed.x[by_x[b]] - bed.x[i] <= bed.radius[i] + largest; ++b) {
      std::size_t const j = by_x[b];
      double const reach = bed.radius[i] + bed.radius[j], dx = bed.x[j] - bed.x[i], dz = bed.z[j] - bed.z[i];
      double const dy = std::remainder(bed.y[j] - bed.y[i], period);
      if (dx * dx + dy * dy + dz * dz > reach * reach) continue;
      ++contacts[i];
      ++contacts[j];
    }
  }
  return contacts;
}

}  // namespace layerloop::dem
