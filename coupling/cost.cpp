#include "coupling/cost.hpp"

#include <algorithm>
#include <cmath>

#include "core/grain_size.hpp"
#include "coupling/scan_path.hpp"
#include "dem/machine_rig.hpp"

namespace layerloop::coupling {
namespace {
constexpr double memory_per_grain = 1000;  // with its neighbours and springs, about [bytes]
constexpr double memory_per_cell = 150;    // of the heat grid, about [bytes]
}  // namespace

std::int64_t dose_count(Case const& checked) {
  MachineSettings const& machine = checked.machine;
  if (machine.dosing == Dosing::feed) return 0;
  double const layer_volume = machine.layer_thickness * machine.deposition_length * machine.width;
  return std::llround(machine.dose_factor * 0.6 * layer_volume / mean_grain_volume(fed_powder(checked)));
}

Cost estimate_cost(Case const& checked) {
  MachineSettings const& machine = checked.machine;
  Cost cost;
  cost.particles = checked.powder.particles + (checked.run.layers - 1) * dose_count(checked);
  double const sweep = dem::blade_stroke(machine) / machine.recoating_speed;
  cost.time_steps = checked.run.layers * std::llround(sweep / dem::motion_of(checked).time_step);
  cost.memory = memory_per_grain * static_cast<double>(cost.particles);
  if (!checked.has_laser()) return cost;

  for (Track const& track : scan_path(checked, 1))
    cost.rays += checked.run.layers * checked.optics.rays *
                 std::llround((track.end - track.begin).norm() / checked.optics.position_spacing);
  auto const [from, to] = heated_range(checked, 1);
  double const length = std::min(to - from, machine.deposition_length);
  double const height =
      checked.heat.substrate_depth + static_cast<double>(checked.run.layers) * machine.layer_thickness;
  cost.cells = std::llround(length * machine.width * height / std::pow(checked.heat.cell_size, 3));
  cost.memory += memory_per_cell * static_cast<double>(cost.cells);
  return cost;
}

}  // namespace layerloop::coupling
