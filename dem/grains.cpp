#include "dem/grains.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace layerloop::dem {
namespace {
std::pair<std::int64_t, std::int64_t> keys(ContactSpring const& spring) { return {spring.key_a, spring.key_b}; }
}  // namespace

void Grains::clear() {
  owned = 0;
  state.clear();
  id.clear();
  for (auto* values : {&material, &leaves, &quiet}) values->clear();
}

void Grains::push_back(GrainRecord const& r) {
  state.push_back(r.state);
  id.push_back(r.id);
  material.push_back(r.material);
  leaves.push_back(r.leaves);
  quiet.push_back(r.quiet);
}

void Grains::close() {
  state.push_back({1e30, 1e30, 1e30, 1, 0, 0, 0, 1, 0, 0, 0, 1e-6});
  material.push_back(0);
  quiet.push_back(0);
}

GrainRecord Grains::record(std::size_t i) const { return {state[i], id[i], material[i], leaves[i], quiet[i]}; }

GrainRecord record_of(PowderBed const& bed, std::size_t i, double density) {
  double const r = bed.radius[i], inverse_mass = 1 / (bed.volume(i) * density);
  double const inverse_inertia = inverse_mass / (0.4 * r * r);
  return {{bed.x[i], bed.y[i], bed.z[i], inverse_inertia, bed.vx[i], bed.vy[i], bed.vz[i], inverse_mass, bed.wx[i],
           bed.wy[i], bed.wz[i], r},
          bed.id[i],
          bed.material[i],
          0,
          0};
}

void sort_springs(std::vector<ContactSpring>& springs) {
  std::ranges::sort(springs, {}, keys);
  auto const doubles = std::ranges::unique(springs, {}, keys);
  springs.erase(doubles.begin(), doubles.end());
}

ContactSpring const* find_spring(std::vector<ContactSpring> const& sorted, std::int64_t key_a, std::int64_t key_b) {
  auto const at = std::ranges::lower_bound(sorted, std::pair{key_a, key_b}, {}, keys);
  return at != sorted.end() && keys(*at) == std::pair{key_a, key_b} ? &*at : nullptr;
}

}  // namespace layerloop::dem
