#include "dem/reservoir.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/layer_metrics.hpp"

namespace layerloop::dem {
namespace {
constexpr double wanted_pixel = 5e-6;  // [m]

double mean_surface(PowderBed const& bed, MachineSettings const& machine) {
  double const margin = std::min(100e-6, 0.25 * machine.accumulation_length);
  AreaMap map{margin, 0, 0, 0, 0, {}};
  map.ny = std::max(1, static_cast<std::int32_t>(std::lround(machine.width / wanted_pixel)));
  map.spacing = machine.width / map.ny;
  map.nx = std::max(1, static_cast<std::int32_t>((machine.accumulation_length - 2 * margin) / map.spacing));
  map.values.assign(static_cast<std::size_t>(map.nx) * static_cast<std::size_t>(map.ny), -machine.accumulation_depth);
  map = height_map(bed, map);
  double sum = 0;
  for (double const z : map.values) sum += z;
  return sum / static_cast<double>(map.values.size());
}
}  // namespace

Reservoir measure_reservoir(PowderBed const& bed, MachineSettings const& machine) {
  Reservoir reservoir;
  double diameters = 0, grains = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (bed.x[i] < 0 || bed.x[i] >= machine.accumulation_length) continue;
    reservoir.volume += bed.volume(i);
    auto const material = static_cast<std::size_t>(bed.material[i]);
    if (reservoir.volume_of_material.size() <= material) reservoir.volume_of_material.resize(material + 1);
    reservoir.volume_of_material[material] += bed.volume(i);
    diameters += 2 * bed.radius[i];
    grains += 1;
  }
  reservoir.surface = mean_surface(bed, machine);
  reservoir.height = reservoir.surface + machine.accumulation_depth;
  reservoir.density = reservoir.volume / (machine.accumulation_length * machine.width * reservoir.height);
  reservoir.mean_diameter = grains > 0 ? diameters / grains : std::numeric_limits<double>::quiet_NaN();
  return reservoir;
}

}  // namespace layerloop::dem
