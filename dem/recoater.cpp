#include "dem/recoater.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/compensated_sum.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "dem/dosing.hpp"
#include "dem/machine_rig.hpp"
#include "dem/simulation.hpp"
#include "dem/softening.hpp"

namespace layerloop::dem {
namespace {
constexpr double longest_settling = 1.5e-3;  // after the stroke [s]
constexpr double longest_flight = 15e-3;     // of a grain that the blade has thrown up by a millimetre [s]
constexpr double flying = 10e-3;             // [m/s]: grains that roll out are slower
constexpr std::int64_t steps_between_progress = 1000;
constexpr double frame_distance = 50e-6;  // of the stroke between two looks of a StrokeWatch [m]

/// Raised solid in the blade's way, in words; empty when there is none.
std::string raised_solid(MachineSettings const& machine, TriangleSurface const& substrate) {
  Vec3 highest(0, 0, machine.blade_clearance);
  std::int64_t count = 0;
  for (Vec3 const& v : substrate.vertices) {
    if (v.z() <= machine.blade_clearance) continue;
    ++count;
    if (v.z() > highest.z()) highest = v;
  }
  if (count == 0) return {};
  return fmt::format(
      "solid stands {:.2f} um above the blade's lower edge at x = {:.1f}, y = {:.1f} um ({} mesh points are above it)",
      (highest.z() - machine.blade_clearance) * 1e6, highest.x() * 1e6, highest.y() * 1e6, count);
}

void warn_once(std::string const& note) {
  static bool warned = false;
  if (!note.empty() && !std::exchange(warned, true)) fmt::print(stderr, "note: {}\n", note);
}

double median_radius(PowderBed const& bed) {
  std::vector<double> radius = bed.radius;
  auto const middle = radius.begin() + static_cast<std::ptrdiff_t>(radius.size() / 2);
  std::nth_element(radius.begin(), middle, radius.end());
  return *middle;
}

/// Grains of `before` that `after` does not hold.
void count_overflow(PowderBed const& before, PowderBed const& after, Motion const& motion, SpreadOutcome& outcome) {
  CompensatedSum volume, mass;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (std::ranges::binary_search(after.id, before.id[i])) continue;
    ++outcome.overflow_grains;
    volume.add(before.volume(i));
    mass.add(motion.density_of(before.material[i]) * before.volume(i));
  }
  outcome.overflow_volume = volume.value();
  outcome.overflow_mass = mass.value();
}

/// Takes out what lies beside the zones, and what is in the way of the returning blade.
void clear_platforms(PowderBed& bed, Case const& checked) {
  Walls recoater;
  add_parked_recoater(recoater, checked.machine);
  std::vector<char> keep(bed.size());
  for (std::size_t i = 0; i < bed.size(); ++i) {
    bool const in_the_way =
        nearest(recoater, 0, checked.machine.width, bed.position(i)).distance < 0.99 * bed.radius[i];
    keep[i] = bed.x[i] >= 0 && bed.x[i] <= checked.machine.deposition_end() && !in_the_way;
  }
  bed.retain(keep);
}

/// Advances until no grain has been in flight for longer than one is slow at the top of its flight, 2 v/g.
void let_land(Simulation& simulation) {
  constexpr std::int64_t steps_between_checks = 1000;
  double const end = simulation.time() + longest_flight;
  double last_seen = simulation.time();
  while (simulation.time() < end && simulation.time() - last_seen < 2 * flying / standard_gravity) {
    simulation.advance(steps_between_checks);
    if (simulation.count_faster_than(flying) > 0) last_seen = simulation.time();
  }
}

void note(SpreadOutcome& outcome, Simulation const& simulation) {
  outcome.steps += simulation.steps();
  outcome.nipped_grains += simulation.nipped();
  outcome.largest_overlap = std::max(outcome.largest_overlap, simulation.largest_overlap());
}

void note_forces(SpreadOutcome& outcome, Simulation const& stroke) {
  outcome.force_history = stroke.wall_forces();
  CompensatedSum impulse;
  double before = 0;
  for (ForceSample const& sample : outcome.force_history) {
    outcome.blade_force = std::max(outcome.blade_force, -sample.x);
    impulse.add(-sample.x * (sample.time - before));
    before = sample.time;
  }
  if (before > 0) outcome.mean_blade_force = impulse.value() / before;
}
}  // namespace

SpreadOutcome spread(PowderBed& bed, Case const& checked, TriangleSurface const& substrate,
                     Communicator const& communicator, bool show_progress, StrokeWatch const& watch) {
  MachineSettings const& machine = checked.machine;
  Motion const motion = motion_of(checked);
  SpreadOutcome outcome;
  outcome.blade_note = raised_solid(machine, substrate);
  outcome.stiffness_note = softening_note(checked);
  if (communicator.is_root()) warn_once(outcome.stiffness_note);
  if (!outcome.blade_note.empty() && machine.blade_collision == BladeCollision::stop) {
    throw PhysicsError(
        outcome.blade_note +
        " (a rigid blade would hit it) use a larger machine.layer_thickness or machine.blade_clearance, less laser "
        "power, or machine.blade_collision = \"report\" to go on");
  }
  PowderBed const before = bed;
  double const smallest = *std::ranges::min_element(bed.radius);
  outcome.time_step = motion.time_step;
  outcome.bond_number = bond_number(median_radius(bed), motion.density, motion.contact);
  outcome.steps_per_contact = shortest_contact_time(motion, smallest, machine.recoating_speed) / motion.time_step;

  Simulation stroke(motion, machine_rig(checked, substrate, bed, Tools::moving_recoater), communicator);
  stroke.scatter(bed);
  double const duration = blade_stroke(machine) / machine.recoating_speed;
  Progress progress("spread", duration, show_progress && communicator.is_root());
  auto const steps = static_cast<std::int64_t>(std::ceil(duration / motion.time_step));
  auto const steps_between_frames =
      static_cast<std::int64_t>(frame_distance / (machine.recoating_speed * motion.time_step)) + 1;
  while (stroke.steps() < steps) {
    std::int64_t const to_frame = steps_between_frames - stroke.steps() % steps_between_frames;
    stroke.advance(std::min({steps - stroke.steps(), steps_between_progress, to_frame}));
    progress.update(stroke.time());
    if (watch && stroke.steps() % steps_between_frames == 0)
      watch(stroke.gather(), machine.recoating_speed * stroke.time());
  }
  bed = stroke.gather();
  if (checked.run.energy_ledger) outcome.energy = stroke.energy();
  note(outcome, stroke);
  note_forces(outcome, stroke);

  clear_platforms(bed, checked);
  if (bed.size() == 0)
    throw PhysicsError("the blade swept every grain away (no layer is left) raise powder.particles or layer_thickness");
  Simulation rest(motion, machine_rig(checked, substrate, bed, Tools::none), communicator);
  rest.scatter(bed);
  settle(rest, longest_settling, "settle", show_progress && communicator.is_root());
  let_land(rest);
  bed = rest.gather();
  if (checked.run.energy_ledger) outcome.energy += rest.energy();
  clear_platforms(bed, checked);
  note(outcome, rest);
  count_overflow(before, bed, motion, outcome);
  return outcome;
}

}  // namespace layerloop::dem
