// The energy ledger of a simulation. Velocities lie half a step before positions; its books are balanced there, with
// the positions half a step back.
#include <cmath>

#include "core/error.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem {
namespace {

/// The grains half a step back, all awake, so that all their contacts are looked at.
Grains half_a_step_back(Grains grains, double dt) {
  for (GrainState& g : grains.state) {
    g.x -= 0.5 * dt * g.vx;
    g.y -= 0.5 * dt * g.vy;
    g.z -= 0.5 * dt * g.vz;
  }
  grains.quiet.assign(grains.quiet.size(), 0);
  return grains;
}

double overlap_of(Grains const& g, std::size_t i, std::size_t j, Period const& period) {
  double const dx = wrapped(g[i].x - g[j].x, period.x), dy = wrapped(g[i].y - g[j].y, period.y), dz = g[i].z - g[j].z;
  return g[i].radius + g[j].radius - std::sqrt(dx * dx + dy * dy + dz * dz);
}

double reduced_radius(Grains const& g, std::size_t i, std::size_t j) {
  return g[i].radius * g[j].radius / (g[i].radius + g[j].radius);
}

}  // namespace

HeldEnergy Simulation::held_by_grains(Grains const& grains) const {
  HeldEnergy held;
  for (std::size_t i = 0; i < grains.owned; ++i) {
    GrainState const& g = grains[i];
    double const v2 = g.vx * g.vx + g.vy * g.vy + g.vz * g.vz, w2 = g.wx * g.wx + g.wy * g.wy + g.wz * g.wz;
    held.kinetic += energy_unit_.whole(0.5 * (v2 / g.inverse_mass + w2 / g.inverse_inertia));
    held.potential -= energy_unit_.whole(rig_.gravity.dot(Vec3(g.x, g.y, g.z)) / g.inverse_mass);
  }
  return held;
}

HeldEnergy Simulation::held_by_pairs(Grains const& grains) const {
  HeldEnergy held;
  Vec3 const none = Vec3::Zero();
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    auto const i = static_cast<std::size_t>(neighbours_.first[k]), j = static_cast<std::size_t>(neighbours_.second[k]);
    if (i >= grains.owned) continue;  // counted where its lower id is at home
    double const overlap = overlap_of(grains, i, j, period_);
    ContactLaw const& law = law_of(laws_, grains, i, j);
    held.normal += energy_unit_.whole(spring_energy(law, overlap, reduced_radius(grains, i, j), none, none).normal);
  }
  std::vector<LocalSpring> springs;
  append_all_springs(springs);
  for (LocalSpring const& s : springs) {
    if (s.row_b < 0 || static_cast<std::size_t>(s.row_a) >= grains.owned) continue;
    auto const i = static_cast<std::size_t>(s.row_a), j = static_cast<std::size_t>(s.row_b);
    auto const &u = s.spring.spring, &turn = s.spring.turn;
    SpringEnergy const energy =
        spring_energy(law_of(laws_, grains, i, j), overlap_of(grains, i, j, period_), reduced_radius(grains, i, j),
                      {u[0], u[1], u[2]}, {turn[0], turn[1], turn[2]});
    held.tangential += energy_unit_.whole(energy.tangential);
    held.rolling += energy_unit_.whole(energy.rolling);
  }
  return held;
}

HeldEnergy Simulation::held_at_walls(Grains const& grains, MovingWalls const& walls) const {
  HeldEnergy held;
  WallContacts contacts = wall_contacts_;
  WallBatch batch;
  WallScene const scene_then{rig_.walls, walls, rig_.width, laws_.form, wall_reach_};
  list_wall_contacts(contacts, batch, grains, scene_then, wall_laws_, 0, contacts.grain.size());
  for (std::size_t c = 0; c < batch.size; ++c) {
    ContactLaw law = motion_.at_walls;
    law.sliding_friction = batch.friction(c);
    ContactState const s = batch.state(c);
    SpringEnergy const energy =
        spring_energy(law, s.overlap, s.radius, {s.spring_x, s.spring_y, s.spring_z}, {s.turn_x, s.turn_y, s.turn_z});
    held.normal += energy_unit_.whole(energy.normal);
    held.tangential += energy_unit_.whole(energy.tangential);
    held.rolling += energy_unit_.whole(energy.rolling);
  }
  return held;
}

HeldEnergy Simulation::held_energy() const {
  Grains const grains = half_a_step_back(grains_, motion_.time_step);
  HeldEnergy held = held_by_grains(grains);
  held += held_by_pairs(grains);
  held += held_at_walls(grains, moving_walls_.half_a_step_back());
  for (std::int64_t* part : {&held.kinetic, &held.potential, &held.normal, &held.tangential, &held.rolling})
    *part = communicator_.sum(*part);
  return held;
}

void Simulation::open_energy_ledger() {
  if (!motion_.keeps_energy_ledger) return;
  if (laws_.form.reach != Reach::touch)
    throw InputError(
        "no ledger of energy is kept with jkr, capillary bridges or charge (their contacts act apart, and their "
        "springs are not booked) set run.energy_ledger = false");
  energy_unit_ = EnergyUnit(unit_);
  booked_ = {};
  carried_out_ = {};
  lost_to_sleep_ = {};
  held_at_start_ = held_energy();
}

EnergyLedger Simulation::energy() const {
  BookedWork work = booked_;
  for (std::int64_t* part : {&work.damping, &work.tangential, &work.rolling, &work.gas, &work.walls})
    *part = communicator_.sum(*part);
  HeldEnergy const held = held_energy(), &start = held_at_start_;
  auto const joules = [&](std::int64_t units) { return static_cast<double>(units) * energy_unit_.unit; };
  // What springs give back is not dissipated; what leaves with grains or is stopped is booked there.
  auto const sprung = [&](std::int64_t HeldEnergy::*part) {
    return held.*part - start.*part + carried_out_.*part + lost_to_sleep_.*part;
  };
  std::int64_t const fall = -sprung(&HeldEnergy::potential);
  EnergyLedger ledger{
      .kinetic = joules(held.kinetic - start.kinetic),
      .potential = joules(held.potential - start.potential),
      .elastic = joules(held.normal - start.normal + held.tangential - start.tangential + held.rolling - start.rolling),
      .dissipated_normal = joules(-work.damping),
      .dissipated_tangential = joules(-work.tangential - sprung(&HeldEnergy::tangential)),
      .dissipated_rolling = joules(-work.rolling - sprung(&HeldEnergy::rolling)),
      .dissipated_gas = joules(-work.gas),
      .dissipated_sleep = joules(lost_to_sleep_.sum()),
      .wall_work = joules(work.walls),
      .carried_out = joules(carried_out_.sum())};
  ledger.residual =
      ledger.wall_work - ledger.kinetic - ledger.potential - ledger.elastic - ledger.dissipated() - ledger.carried_out;
  ledger.work_done = std::abs(ledger.wall_work) + std::abs(joules(fall)) + joules(start.kinetic);
  return ledger;
}

}  // namespace layerloop::dem
