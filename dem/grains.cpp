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
  id.clear();
  material.clear();
  leaves.clear();
  for (auto* values : {&x, &y, &z, &vx, &vy, &vz, &wx, &wy, &wz, &radius, &mass}) values->clear();
}

void Grains::push_back(GrainRecord const& r, double density) {
  id.push_back(r.id);
  material.push_back(r.material);
  leaves.push_back(r.leaves);
  x.push_back(r.x);
  y.push_back(r.y);
  z.push_back(r.z);
  vx.push_back(r.vx);
  vy.push_back(r.vy);
  vz.push_back(r.vz);
  wx.push_back(r.wx);
  wy.push_back(r.wy);
  wz.push_back(r.wz);
  radius.push_back(r.radius);
  mass.push_back(4.0 / 3.0 * std::numbers::pi * r.radius * r.radius * r.radius * density);
}

GrainRecord Grains::record(std::size_t i) const {
  return {id[i], x[i], y[i], z[i], vx[i], vy[i], vz[i], wx[i], wy[i], wz[i], radius[i], material[i], leaves[i]};
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
