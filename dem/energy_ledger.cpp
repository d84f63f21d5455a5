#include "dem/energy_ledger.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace layerloop::dem {
namespace {

Vec3 velocity(GrainState const& g) { return {g.vx, g.vy, g.vz}; }
Vec3 spin(GrainState const& g) { return {g.wx, g.wy, g.wz}; }

ContactState state_of(GrainState const& a, GrainState const& b, NearPairs const& near, std::size_t n,
                      Period const& period) {
  Vec3 const apart(wrapped(a.x - b.x, period.x), wrapped(a.y - b.y, period.y), a.z - b.z);
  double const distance = apart.norm(), overlap = a.radius + b.radius - distance, felt = std::max(overlap, 0.0);
  double const arm_a = a.radius - 0.5 * felt, arm_b = b.radius - 0.5 * felt;
  ContactState state{};
  state.overlap = overlap;
  state.radius = a.radius * b.radius / (a.radius + b.radius);
  state.inverse_mass = a.inverse_mass + b.inverse_mass;
  state.nx = apart.x() / distance, state.ny = apart.y() / distance, state.nz = apart.z() / distance;
  state.vx = a.vx - b.vx, state.vy = a.vy - b.vy, state.vz = a.vz - b.vz;
  state.sx = arm_a * a.wx + arm_b * b.wx, state.sy = arm_a * a.wy + arm_b * b.wy;
  state.sz = arm_a * a.wz + arm_b * b.wz;
  state.wx = a.wx - b.wx, state.wy = a.wy - b.wy, state.wz = a.wz - b.wz;
  state.spring_x = near.spring_x[n], state.spring_y = near.spring_y[n], state.spring_z = near.spring_z[n];
  if (!near.turn_x.empty()) state.turn_x = near.turn_x[n], state.turn_y = near.turn_y[n], state.turn_z = near.turn_z[n];
  return state;
}

ContactAction action_of(ContactLaw const& law, ContactState const& state, RollingModel rolling, double dt) {
  return rolling == RollingModel::cdt ? act<Reach::touch, RollingModel::cdt>(law, state, dt)
                                      : act<Reach::touch, RollingModel::epsd2>(law, state, dt);
}

}  // namespace

double EnergyLedger::relative_error() const { return work_done > 0 ? std::abs(residual) / work_done : 0.0; }

EnergyLedger& EnergyLedger::operator+=(EnergyLedger const& later) {
  for (auto const member :
       {&EnergyLedger::kinetic, &EnergyLedger::potential, &EnergyLedger::elastic, &EnergyLedger::dissipated_normal,
        &EnergyLedger::dissipated_tangential, &EnergyLedger::dissipated_rolling, &EnergyLedger::dissipated_gas,
        &EnergyLedger::dissipated_sleep, &EnergyLedger::wall_work, &EnergyLedger::carried_out, &EnergyLedger::residual,
        &EnergyLedger::work_done})
    this->*member += later.*member;
  return *this;
}

HeldEnergy& HeldEnergy::operator+=(HeldEnergy const& more) {
  kinetic += more.kinetic;
  potential += more.potential;
  normal += more.normal;
  tangential += more.tangential;
  rolling += more.rolling;
  return *this;
}

HeldEnergy& HeldEnergy::operator-=(HeldEnergy const& less) {
  kinetic -= less.kinetic;
  potential -= less.potential;
  normal -= less.normal;
  tangential -= less.tangential;
  rolling -= less.rolling;
  return *this;
}

BookedWork& BookedWork::operator+=(BookedWork const& more) {
  damping += more.damping;
  tangential += more.tangential;
  rolling += more.rolling;
  gas += more.gas;
  walls += more.walls;
  return *this;
}

std::int64_t EnergyUnit::whole(double energy) const { return std::llrint(energy * per_unit); }

SpringEnergy spring_energy(ContactLaw const& law, double overlap, double reduced_radius, Vec3 const& spring,
                           Vec3 const& turn) {
  double const d = std::max(overlap, 0.0), R = reduced_radius, a = std::sqrt(R * d);
  double const stiffness = law.tangential_stiffness * a;
  double const attraction = law.cohesion * R * d + (d > 0 ? law.pull_off * R : 0.0);
  double const bound =
      law.sliding_friction * std::abs(law.normal_stiffness * a * d - law.adhesion_in_coulomb * attraction);
  double const pull = std::min(stiffness * spring.norm(), bound);
  return {0.4 * law.normal_stiffness * a * d * d - 0.5 * law.cohesion * R * d * d - law.pull_off * R * d,
          d > 0 ? 0.5 * pull * pull / stiffness : 0.0, 0.5 * stiffness * R * R * turn.squaredNorm()};
}

ContactLaw const& law_of(LawTable const& laws, Grains const& g, std::size_t first, std::size_t second) {
  if (laws.materials == 1) return laws.laws.front();
  return laws.laws[static_cast<std::size_t>(g.material[first] * laws.materials + g.material[second])];
}

void EnergyBooks::book_half(KeptForces const& k, Grains const& grains, MovingWalls const& walls, double dt) {
  GrainState const& a = grains[static_cast<std::size_t>(k.first)];
  Vec3 v = velocity(a), s = k.arm_first * spin(a), w = spin(a);
  double const half = 0.5 * dt;
  if (k.wall < 0) {
    GrainState const& b = grains[static_cast<std::size_t>(k.second)];
    v -= velocity(b);
    s += k.arm_second * spin(b);
    w -= spin(b);
  } else {
    Vec3 const surface = k.surface + walls.last_step(static_cast<std::size_t>(k.wall)) / dt;
    v -= surface;
    w.y() -= k.spin;
    booked_.walls += unit_.whole(half * (k.force.dot(surface) - k.rolling.y() * k.spin));
  }
  booked_.damping += unit_.whole(half * k.damping.dot(v));
  booked_.tangential += unit_.whole(half * (k.tangential.dot(v) - k.turning.dot(s)));
  booked_.rolling -= unit_.whole(half * k.rolling.dot(w));
}

void EnergyBooks::end_chunk(std::size_t chunk, Grains const& grains, MovingWalls const& walls, double dt) {
  for (KeptForces const& kept : kept_[chunk]) book_half(kept, grains, walls, dt);
  kept_[chunk].clear();
}

void EnergyBooks::finish(Grains const& grains, MovingWalls const& walls, double dt) {
  for (std::size_t chunk = 0; chunk < kept_.size(); ++chunk) end_chunk(chunk, grains, walls, dt);
}

BookedWork EnergyBooks::take() { return std::exchange(booked_, {}); }

namespace {
/// Parts of what a contact does.
struct Parts {
  Vec3 force, damping, tangential, turning, rolling;
};

Parts parts_of(ContactLaw const& law, ContactState const& state, RollingModel rolling, double dt) {
  ContactAction const action = action_of(law, state, rolling, dt);
  NormalForce<double> const along = hertz(law, state);
  Vec3 const force(action.fx, action.fy, action.fz), normal(state.nx, state.ny, state.nz);
  double const pressed = force.dot(normal);
  return {force,
          (pressed - (along.elastic - along.attraction)) * normal,
          force - pressed * normal,
          {action.qx, action.qy, action.qz},
          {action.rx, action.ry, action.rz}};
}
}  // namespace

void EnergyBooks::book_pairs(NearPairs const& near, std::size_t chunk, Grains const& grains, LawTable const& laws,
                             Period const& period, MovingWalls const& walls, double dt) {
  if (kept_.size() < near.chunks()) kept_.resize(near.chunks());
  end_chunk(chunk, grains, walls, dt);
  for (std::size_t n = near.chunk[chunk]; n < near.chunk[chunk + 1]; ++n) {
    auto const i = static_cast<std::size_t>(near.first[n]), j = static_cast<std::size_t>(near.second[n]);
    if (i >= grains.owned) continue;  // booked where its lower id is at home; or a pair that fills up a vector
    ContactState const state = state_of(grains[i], grains[j], near, n, period);
    if (state.overlap <= 0) continue;
    Parts const parts = parts_of(law_of(laws, grains, i, j), state, laws.form.rolling, dt);
    kept_[chunk].push_back({near.first[n], near.second[n], -1, parts.force, parts.damping, parts.tangential,
                            parts.turning, parts.rolling, grains[i].radius - 0.5 * state.overlap,
                            grains[j].radius - 0.5 * state.overlap, Vec3::Zero(), 0});
    book_half(kept_[chunk].back(), grains, walls, dt);
  }
}

void EnergyBooks::book_walls(std::size_t chunk, WallContacts const& contacts, WallBatch const& batch,
                             Grains const& grains, WallScene const& scene, ContactLaw const& law, double dt,
                             std::size_t from, std::size_t to) {
  std::size_t c = 0;
  for (std::size_t w = from; w < to; ++w) {
    std::int32_t const row = contacts.grain[w];
    if (is_asleep(grains.quiet[static_cast<std::size_t>(row)])) continue;
    for (std::int32_t k = 0; k < contacts.spring_count[w]; ++k, ++c) {
      ContactState const state = batch.state(c);
      if (state.overlap <= 0) continue;
      ContactLaw law_of_wall = law;
      law_of_wall.sliding_friction = batch.friction(c);
      Parts const parts = parts_of(law_of_wall, state, scene.form.rolling, dt);
      auto const wall = static_cast<std::size_t>(batch.wall(c));
      Vec3 const normal(state.nx, state.ny, state.nz);
      WallSurface const surface = surface_of(scene, wall, normal);
      WallPose const& pose = scene.moving.poses()[wall];
      kept_[chunk].push_back({row, -1, batch.wall(c), parts.force, parts.damping, parts.tangential, parts.turning,
                              parts.rolling, state.radius - 0.5 * state.overlap, 0,
                              Vec3(surface.vx - pose.vx, 0, surface.vz - pose.vz), surface.spin});
      book_half(kept_[chunk].back(), grains, scene.moving, dt);
    }
  }
}

void EnergyBooks::before_move(Grains const& grains, std::size_t from, std::size_t to) {
  velocity_before_.clear();
  for (std::size_t i = from; i < to; ++i) velocity_before_.push_back(velocity(grains[i]));
}

void EnergyBooks::after_move(Grains const& grains, std::size_t from, std::size_t to, double drag, double dt) {
  for (std::size_t i = from; i < to; ++i) {
    if (is_asleep(grains.quiet[i])) continue;
    Vec3 const after = velocity(grains[i]), mean = 0.5 * (velocity_before_[i - from] + after);
    booked_.gas -= unit_.whole(dt * drag * grains[i].radius * after.dot(mean));
  }
}

}  // namespace layerloop::dem
