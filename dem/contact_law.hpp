#pragma once
#include <cmath>

#include "core/case.hpp"

namespace layerloop::dem {

/// Hertz-Mindlin contact with history, restitution-exact damping, SJKR2 cohesion and CDT rolling friction, as
/// prefactors.
///
/// With the overlap d, the reduced radius R and mass m, and root = sqrt(R d):
///   normal      4/3 E root d - g_n v_n - k A,        1/E = sum (1 - nu^2)/E_i      (k: cohesion energy density, A:
///   contact area) tangential  -(8 G root s + g_t v_t), cut at the Coulomb bound;  1/G = sum 2 (2 - nu)(1 + nu)/E_i
///   damping     g_n = -2 sqrt(5/6) b sqrt(2 E root m), g_t with 8 G in place of 2 E;  b = ln e / sqrt(ln^2 e + pi^2)
///   rolling     torque mu_r R (4/3 E root d) against the relative rotation, without its torsional part
/// The normal force is not cut at zero before separation: then the restitution is e exactly at any speed (Antypov &
/// Elliott, EPL 94 (2011) 50004). A sliding contact rescales its spring to the bound and drops tangential damping.
/// Forms as in LIGGGHTS
/// (`hertz tangential history rolling_friction cdt cohesion sjkr2`); cdt is model A of Ai et al., Powder Technol. 206
/// (2011) 269. Velocities come half a step late (leapfrog): under a force K + g v that acts as if the mass were m - g
/// dt/2 and damps too much by the share g dt/(4 m). Normal damping is reduced by it, so that the restitution is of
/// second order in the step. Walls are of the grains' material: both bodies deform, R is the radius and m the mass of
/// the grain.
struct ContactLaw {
  double normal_stiffness = 0;      ///< 4/3 E [Pa]
  double tangential_stiffness = 0;  ///< 8 G [Pa]
  double normal_damping = 0;        ///< g_n / sqrt(m root) [sqrt(Pa)]
  double tangential_damping = 0;    ///< g_t / sqrt(m root) [sqrt(Pa)]
  double sliding_friction = 0;
  double rolling_friction = 0;
  double cohesion = 0;             ///< attraction / (R d) [Pa]
  double cohesion_in_coulomb = 0;  ///< the same where the Coulomb bound takes the total normal force, else 0
};

/// Two grains: A = 2 pi d (2 R), thesis eq. 6.
ContactLaw grain_law(ContactSettings const& contact);
/// Grain and wall: wall friction; A = 2 pi R d (liggghts) or 4 pi R d (eq6).
ContactLaw wall_law(ContactSettings const& contact);

/// Time of a Rayleigh wave over a grain: pi R sqrt(rho/G) / (0.1631 nu + 0.8766) [s], thesis eq. 12.
double rayleigh_time(double radius, double density, ContactSettings const& contact);
/// Duration of an undamped Hertz impact of two equal grains at a relative speed: 2.868 (m^2 / (R E^2 v))^(1/5) [s].
double hertz_contact_time(double radius, double density, double speed, ContactSettings const& contact);
/// Pull-off force of SJKR2 over weight, for two equal grains: (16 pi^3/3) k^3 R^2 / E^2 / (m g).
double bond_number(double radius, double density, ContactSettings const& contact);

/// Geometry and motion of one touching pair. The normal points from the second body to the first.
struct ContactState {
  double overlap, radius, mass;  ///< d, R, m
  double nx, ny, nz;
  double vx, vy, vz;  ///< velocity of the first centre relative to the second [m/s]
  double sx, sy, sz;  ///< surface rotation: arm_1 w_1 + arm_2 w_2 [m/s], arm = radius - d/2
  double wx, wy, wz;  ///< spin of the first relative to the second [rad/s]
  double spring_x, spring_y, spring_z;
};

/// What a contact does to the first body; the second gets -force, and the torque with its own arm and +rolling.
struct ContactAction {
  double fx, fy, fz;  ///< force on the first body [N]
  double qx, qy, qz;  ///< normal x tangential force; torque is -arm q on either body [N]
  double rx, ry, rz;  ///< rolling torque, taken from the first body [N m]
  double spring_x, spring_y, spring_z;
};

/// Straight-line code without branches, so that a loop over contacts becomes vector instructions.
[[gnu::always_inline]] inline ContactAction act(ContactLaw const& law, ContactState const& c, double dt) {
  double const root = std::sqrt(c.radius * c.overlap);
  double const viscous = std::sqrt(c.mass * root);
  double const elastic = law.normal_stiffness * root * c.overlap;
  double const adhesive = c.radius * c.overlap;

  double const vn = c.vx * c.nx + c.vy * c.ny + c.vz * c.nz;
  double const viscosity_n = law.normal_damping * viscous;
  double const repulsive = elastic - viscosity_n * vn * c.mass / (c.mass + 0.25 * dt * viscosity_n);
  double const normal = repulsive - law.cohesion * adhesive;

  double const tx = c.vx - vn * c.nx - (c.sy * c.nz - c.sz * c.ny);
  double const ty = c.vy - vn * c.ny - (c.sz * c.nx - c.sx * c.nz);
  double const tz = c.vz - vn * c.nz - (c.sx * c.ny - c.sy * c.nx);
  double ux = c.spring_x + tx * dt, uy = c.spring_y + ty * dt, uz = c.spring_z + tz * dt;
  double const un = ux * c.nx + uy * c.ny + uz * c.nz;
  ux -= un * c.nx;
  uy -= un * c.ny;
  uz -= un * c.nz;

  double const stiffness = law.tangential_stiffness * root;
  double const bound = law.sliding_friction * std::abs(repulsive - law.cohesion_in_coulomb * adhesive);
  double const stretched = stiffness * std::sqrt(ux * ux + uy * uy + uz * uz);
  bool const slides = stretched > bound;
  double const kept = slides ? bound / stretched : 1.0;
  double const viscosity = slides ? 0.0 : law.tangential_damping * viscous;
  ux *= kept;
  uy *= kept;
  uz *= kept;
  double const gx = -(stiffness * ux + viscosity * tx);
  double const gy = -(stiffness * uy + viscosity * ty);
  double const gz = -(stiffness * uz + viscosity * tz);

  double const spin = std::sqrt(c.wx * c.wx + c.wy * c.wy + c.wz * c.wz);
  double const rolling = law.rolling_friction * c.radius * elastic / (spin > 0.0 ? spin : 1.0);
  double const wn = c.wx * c.nx + c.wy * c.ny + c.wz * c.nz;
  return {normal * c.nx + gx,
          normal * c.ny + gy,
          normal * c.nz + gz,
          c.ny * gz - c.nz * gy,
          c.nz * gx - c.nx * gz,
          c.nx * gy - c.ny * gx,
          rolling * (c.wx - wn * c.nx),
          rolling * (c.wy - wn * c.ny),
          rolling * (c.wz - wn * c.nz),
          ux,
          uy,
          uz};
}

}  // namespace layerloop::dem
