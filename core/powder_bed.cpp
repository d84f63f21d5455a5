#include "core/powder_bed.hpp"

#include <algorithm>
#include <cassert>
#include <numbers>

#include "core/compensated_sum.hpp"

namespace layerloop {

double PowderBed::volume(std::size_t i) const {
  return 4.0 / 3.0 * std::numbers::pi * radius[i] * radius[i] * radius[i];
}

void PowderBed::add(std::int64_t new_id, Vec3 const& centre, double grain_radius, std::int32_t grain_material) {
  assert(id.empty() || new_id > id.back());
  id.push_back(new_id);
  x.push_back(centre.x());
  y.push_back(centre.y());
  z.push_back(centre.z());
  radius.push_back(grain_radius);
  for (auto* rate : {&vx, &vy, &vz, &wx, &wy, &wz}) rate->push_back(0.0);
  material.push_back(grain_material);
}

void PowderBed::retain(std::vector<char> const& keep) {
  assert(keep.size() == size());
  std::vector<std::int64_t> const old_id = id;
  auto const stays = [&](std::int64_t key) {
    auto const at = std::lower_bound(old_id.begin(), old_id.end(), key) - old_id.begin();
    return keep[static_cast<std::size_t>(at)] != 0;
  };
  std::erase_if(contacts, [&](ContactSpring const& c) { return !stays(c.key_a) || (c.key_b >= 0 && !stays(c.key_b)); });
  auto const compact = [&](auto& values) {
    std::size_t to = 0;
    for (std::size_t from = 0; from < keep.size(); ++from) {
      if (keep[from]) values[to++] = values[from];
    }
    values.resize(to);
  };
  compact(id);
  for (auto* values : {&x, &y, &z, &radius, &vx, &vy, &vz, &wx, &wy, &wz}) compact(*values);
  compact(material);
}

double total_volume(PowderBed const& bed) {
  CompensatedSum sum;
  for (std::size_t i = 0; i < bed.size(); ++i) sum.add(bed.volume(i));
  return sum.value();
}

}  // namespace layerloop
