#pragma once
#include <numbers>

#include "core/case.hpp"
#include "core/rayleigh_time.hpp"
#include "core/triangle_surface.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem::test {

inline constexpr double density = 8190;

/// A run of one rank.
inline Communicator alone() { return Communicator(MPI_COMM_SELF); }

/// Thesis' contact values without cohesion and rolling friction.
inline ContactSettings plain_contact() {
  ContactSettings contact;
  contact.youngs_modulus = 0.2e9;
  contact.poisson_ratio = 0.3;
  contact.restitution = 0.7;
  contact.sliding_friction = contact.wall_friction = 0.7;
  contact.cohesion = Cohesion::none;
  contact.cohesion_energy_density = 9e4;
  contact.time_step_fraction = 0.149;
  return contact;
}

inline double reduced_modulus(ContactSettings const& c) {
  return c.youngs_modulus / (2 * (1 - c.poisson_ratio * c.poisson_ratio));
}

inline double mass_of(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density; }

inline Motion motion(ContactSettings const& contact, double smallest_radius) {
  return {grain_law(contact), wall_law(contact), contact, density,
          contact.time_step_fraction * rayleigh_time(smallest_radius, density, contact)};
}

/// No walls, no gravity.
inline Rig empty_space() {
  Rig rig;
  rig.width = 1e-3;
  rig.gravity = Vec3::Zero();
  return rig;
}

/// A plane at z = 0.
inline RoundedBlock floor_block() { return {"the floor", -0.1, 0.1, -0.1, 0, 0, 0}; }

inline void set_velocity(PowderBed& bed, std::size_t i, Vec3 const& v) {
  bed.vx[i] = v.x();
  bed.vy[i] = v.y();
  bed.vz[i] = v.z();
}

/// Closed box, normals outwards.
inline TriangleSurface box(Vec3 const& low, Vec3 const& high) {
  TriangleSurface s;
  for (int k = 0; k < 8; ++k)
    s.vertices.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z());
  s.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return s;
}

/// The thesis' powder on a machine short enough for a test.
inline Case small_case() {
  Case c;
  c.seed = 7;
  c.powder.diameters = {13e-6, 21e-6, 28e-6, 42e-6};
  c.powder.fractions = {0.2, 0.2, 0.5, 0.1};
  c.powder.particles = 200;
  c.contact = plain_contact();
  c.contact.cohesion = Cohesion::sjkr2;
  c.contact.rolling_friction = 0.15;
  c.machine.layer_thickness = 50e-6;
  c.machine.recoating_speed = 0.05;
  c.machine.accumulation_length = 150e-6;
  c.machine.accumulation_depth = 60e-6;
  c.machine.gap_length = 60e-6;
  c.machine.deposition_length = 200e-6;
  c.machine.width = 100e-6;
  c.machine.blade_width = 40e-6;
  c.machine.edge_radius = 5e-6;
  c.material.density = density;
  return c;
}

inline TriangleSurface plate_of(Case const& c) {
  MachineSettings const& m = c.machine;
  return box({m.deposition_begin(), -m.width, -m.layer_thickness - 100e-6},
             {m.deposition_end(), 2 * m.width, -m.layer_thickness});
}

}  // namespace layerloop::dem::test
