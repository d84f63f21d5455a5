#include "coupling/cost.hpp"

#include <algorithm>
#include <cmath>

#include "core/grain_size.hpp"
#include "coupling/melt_plate.hpp"
#include "coupling/scan_path.hpp"
#include "dem/machine_rig.hpp"

namespace layerloop::coupling {
namespace {

constexpr double memory_per_grain = 1000;  // with its neighbours and springs, about [bytes]
constexpr double memory_per_cell = 150;    // of the heat grid, about [bytes]

// What one thread of a processor of about 3 GHz does in a second, with everything that comes with it.
constexpr double grain_steps_per_second = 1.5e7, rays_per_second = 1e6, cell_steps_per_second = 1.5e8;
constexpr double time_for_files = 0.2;  // and the page of a case [s]

bool spreads(Case const& checked) {
  return checked.has_machine() && checked.process != Process::calibrating &&
         !(checked.process == Process::exposing && checked.melt.bed != MeltedBed::spread) &&
         !(checked.process == Process::absorbing && checked.absorb.bed != AbsorbingBed::spread);
}

/// \param there  layers that are spread already
void add_spreading(Case const& checked, std::int64_t there, Cost& cost) {
  double const sweep = dem::blade_stroke(checked.machine) / checked.machine.recoating_speed;
  std::int64_t const steps = std::llround(sweep / dem::motion_of(checked).time_step), dose = dose_count(checked);
  cost.particles = checked.powder.particles + (checked.run.layers - 1) * dose;
  cost.time_steps = (checked.run.layers - there) * steps;
  for (std::int64_t layer = there; layer < checked.run.layers; ++layer)
    cost.grain_steps += static_cast<double>(checked.powder.particles + layer * dose) * 1.5 * static_cast<double>(steps);
}

/// Piles and plates move until they rest: the longest time that they may take is not reached as a rule.
void add_calibration(Case const& checked, Cost& cost) {
  CalibrateSettings const& c = checked.calibrate;
  std::int64_t const points = c.search ? 1 + c.grid * c.grid + c.refinements : 1;
  cost.particles = points * checked.run.replicates * (c.pile_particles + c.plate_particles);
  cost.time_steps =
      std::llround((c.settling_time + (c.tilt_to - c.tilt_from) / c.tilt_rate) / 2 / dem::motion_of(checked).time_step);
  cost.grain_steps = static_cast<double>(cost.particles) * static_cast<double>(cost.time_steps);
}

/// Rays of a scanned layer, or of a bed under light until its standard error is reached; the power of one ray that
/// is absorbed or not has a standard deviation of at most a half.
std::int64_t rays_of(Case const& checked) {
  if (checked.laser.absorptivity) return 0;
  if (checked.process == Process::absorbing) {
    double const wanted = 0.25 / std::pow(checked.absorb.target_standard_error, 2);
    return std::min<std::int64_t>(checked.absorb.max_rays, std::llround(wanted));
  }
  double length = 0;
  for (Track const& track : scan_path(checked, 1)) length += (track.end - track.begin).norm();
  return checked.run.layers * checked.optics.rays * std::llround(length / checked.optics.position_spacing);
}

double scan_time(Case const& checked) {
  double time = 0;
  for (Track const& track : scan_path(checked, 1)) time += (track.end - track.begin).norm() / checked.scan.scan_speed;
  return time;
}

/// Largest explicit step in three dimensions, h^2 / 6 a, with the fastest diffusivity of the metal's tables.
double heat_step(Case const& checked) {
  Material const& metal = checked.material;
  double const conductivity = std::ranges::max(metal.conductivity.value),
               capacity = metal.density * std::ranges::min(metal.specific_heat.value);
  return std::pow(checked.heat.cell_size, 2) * capacity / (6 * conductivity);
}

void add_heat(Case const& placed, Cost& cost) {
  double volume = 0;
  if (placed.process == Process::exposing && placed.heat.size.size() == 3) {
    volume = placed.heat.size[0] * placed.heat.size[1] * placed.heat.size[2];
  } else {
    auto const [from, to] = heated_range(placed, 1);
    volume = std::min(to - from, placed.machine.deposition_length) * placed.machine.width *
             (placed.heat.substrate_depth + static_cast<double>(placed.run.layers) * placed.machine.layer_thickness);
  }
  cost.cells = std::llround(volume / std::pow(placed.heat.cell_size, 3));
  cost.heat_steps = placed.run.layers * std::llround(scan_time(placed) / heat_step(placed));
}

}  // namespace

std::int64_t dose_count(Case const& checked) {
  MachineSettings const& machine = checked.machine;
  if (machine.dosing == Dosing::feed) return 0;
  double const layer_volume = machine.layer_thickness * machine.deposition_length * machine.width;
  return std::llround(machine.dose_factor * 0.6 * layer_volume / mean_grain_volume(fed_powder(checked)));
}

Cost estimate_cost(Case const& checked, bool bed_is_there) {
  Cost cost;
  if (checked.process == Process::calibrating) add_calibration(checked, cost);
  std::int64_t const there = !bed_is_there ? 0 : checked.process == Process::melting ? 1 : checked.run.layers;
  if (spreads(checked) && there < checked.run.layers) add_spreading(checked, there, cost);
  bool const melts = checked.has_laser() && checked.process != Process::absorbing;
  if (melts || checked.process == Process::absorbing) cost.rays = rays_of(checked);
  if (melts) {
    bool const plate = checked.process == Process::exposing && !checked.has_machine();
    add_heat(plate ? with_plate(checked, estimate_pool(checked)) : checked, cost);
  }
  auto const many = [](std::int64_t n) { return static_cast<double>(n); };
  cost.memory = memory_per_grain * many(cost.particles) + memory_per_cell * many(cost.cells);
  cost.wall_time = time_for_files + cost.grain_steps / grain_steps_per_second + many(cost.rays) / rays_per_second +
                   many(cost.cells) * many(cost.heat_steps) / cell_steps_per_second;
  return cost;
}

}  // namespace layerloop::coupling
