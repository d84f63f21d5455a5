#pragma once
#include <cmath>

#include "core/case.hpp"

namespace layerloop::dem {

/// Liquid between two bodies: F = force R / (1 + 1.05 S + 2.5 S^2), S = steepness gap / R, up to a gap of rupture R
/// (Willett et al., Langmuir 16 (2000) 9396, eq. for small volumes, with 2 R for the radius of equal spheres).
struct LiquidBridge {
  double force = 0;  ///< [N/m]
  double steepness = 0;
  double rupture = 0;
};

/// Hertz-Mindlin contact with history and restitution-exact damping, as prefactors, and what is added to it.
///
/// With the overlap d, the reduced radius R and mass m, and the contact radius a = sqrt(R d) (JKR: from d, below):
///   normal      4/3 E a d - g_n v_n - attraction,    1/E = sum (1 - nu^2)/E_i
///   tangential  -(8 G a s + g_t v_t), cut at the Coulomb bound;  1/G = sum 2 (2 - nu)(1 + nu)/E_i
///   damping     g_n = -2 sqrt(5/6) b sqrt(2 E a m), g_t with 8 G in place of 2 E;  b = ln e / sqrt(ln^2 e + pi^2)
///   rolling     cdt: torque mu_r R (4/3 E a d) against the relative rotation, without its torsional part;
///               epsd2: a spring of stiffness 8 G a R^2, cut at the same torque
/// `exact`: the normal force is not cut at zero before separation; then the restitution is e at any speed (Antypov &
/// Elliott, EPL 94 (2011) 50004). `clamped`: it is. A sliding contact drops tangential damping and rescales its spring
/// to the bound, or keeps it. Attraction: sjkr and sjkr2, energy density k times a contact area; dmt, 2 pi W R while
/// touching (Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) 314); jkr (Johnson, Kendall & Roberts,
/// Proc. R. Soc. A 324 (1971) 301), with W = 2 gamma. Forms of Hertz-Mindlin, sjkr, sjkr2, cdt and epsd2 as in
/// LIGGGHTS; cdt and epsd2: Ai et al., Powder Technol. 206 (2011) 269. Velocities come half a step late (leapfrog):
/// under a force K + g v that acts as if the mass were m - g dt/2 and damps too much by the share g dt/(4 m). Normal
/// damping is reduced by it, so that the restitution is of second order in the step.
struct ContactLaw {
  double normal_stiffness = 0;      ///< 4/3 E [Pa]
  double tangential_stiffness = 0;  ///< 8 G [Pa]
  double normal_damping = 0;        ///< g_n / sqrt(m a) [sqrt(Pa)]
  double tangential_damping = 0;    ///< g_t / sqrt(m a) [sqrt(Pa)]
  double sliding_friction = 0;
  double rolling_friction = 0;
  double cohesion = 0;             ///< sjkr, sjkr2: attraction / (R d) [Pa]
  double pull_off = 0;             ///< dmt: attraction / R, 2 pi W [N/m]
  double adhesion = 0;             ///< jkr: c = sqrt(2 pi W / E) in d = a^2/R - c sqrt(a) [sqrt(m)]
  LiquidBridge bridge = {};        ///< forms on touch, and holds until it ruptures
  double charge = 0;               ///< attraction / (r_1 r_2 / distance)^2; grains of like charge: negative [N/m^2]
  double adhesion_in_coulomb = 0;  ///< 1 where the Coulomb bound takes the total normal force, else 0
  double least_normal = -1e300;    ///< normal force before attraction is at least this: 0 when clamped [N]
  double keeps_spring = 0;         ///< 1 where a sliding contact keeps its spring, 0 where it rescales it
};

/// How far attraction reaches: to touch; to where a JKR contact tears; beyond touch (bridges, charge).
enum class Reach { touch, tear_off, beyond };

/// Which code a contact needs, beyond prefactors: chosen once, outside the loops.
struct LawForm {
  Reach reach = Reach::touch;
  RollingModel rolling = RollingModel::cdt;
  friend bool operator==(LawForm const&, LawForm const&) = default;
};
LawForm law_form(ContactSettings const& contact);

/// Elastic and surface properties of one of two bodies in contact.
struct Body {
  double youngs_modulus, poisson_ratio;
};

/// Two grains. sjkr2: A = 2 pi d (2 R), thesis eq. 6; sjkr: half of it.
ContactLaw grain_law(ContactSettings const& contact);
/// Grain and wall: wall friction; A = 2 pi R d (liggghts) or 4 pi R d (eq6).
ContactLaw wall_law(ContactSettings const& contact);

/// Duration of an undamped Hertz impact of two equal grains at a relative speed: 2.868 (m^2 / (R E^2 v))^(1/5) [s].
double hertz_contact_time(double radius, double density, double speed, ContactSettings const& contact);
/// Pull-off force over weight, for two equal grains. sjkr, sjkr2: (16 pi^3/3) k^3 R^2 / E^2 (sjkr: 1/8 of it);
/// dmt: 2 pi W R; jkr: 3/2 pi W R.
double bond_number(double radius, double density, ContactSettings const& contact);
/// Largest gap at which something still acts [m]: jkr tears at 3/4 (pi^2 W^2 R / E^2)^(1/3), a bridge ruptures, charge
/// is cut off at a radius.
double reach_gap(ContactLaw const& law, double reduced_radius);

/// Geometry and motion of one pair. The normal points from the second body to the first.
struct ContactState {
  double overlap, radius, inverse_mass;  ///< d (negative: apart), R, 1/m
  double nx, ny, nz;
  double vx, vy, vz;  ///< velocity of the first centre relative to the second [m/s]
  double sx, sy, sz;  ///< surface rotation: arm_1 w_1 + arm_2 w_2 [m/s], arm = radius - d/2
  double wx, wy, wz;  ///< spin of the first relative to the second [rad/s]
  double spring_x, spring_y, spring_z;
  double turn_x, turn_y, turn_z;  ///< epsd2: rolling angle that is stored [rad]
  double closeness;               ///< (r_1 r_2 / distance)^2, for charge [m^2]
  bool was_touching;
};

/// What a contact does to the first body; the second gets -force, and the torque with its own arm and +rolling.
struct ContactAction {
  double fx, fy, fz;  ///< force on the first body [N]
  double qx, qy, qz;  ///< normal x tangential force; torque is -arm q on either body [N]
  double rx, ry, rz;  ///< rolling torque, taken from the first body [N m]
  double spring_x, spring_y, spring_z;
  double turn_x, turn_y, turn_z;
  bool touches;
};

/// Contact radius and forces along the normal, before damping.
struct NormalForce {
  double contact_radius, elastic, attraction;
  bool touches;  ///< or is held by a bridge
};

[[gnu::always_inline]] inline NormalForce hertz(ContactLaw const& law, ContactState const& c) {
  double const overlap = c.overlap > 0.0 ? c.overlap : 0.0, area = c.radius * overlap;
  double const a = std::sqrt(area);
  bool const touches = c.overlap > 0.0;
  return {a, law.normal_stiffness * a * overlap, law.cohesion * area + (touches ? law.pull_off * c.radius : 0.0),
          touches};
}

/// As hertz(), with what acts before and after touch.
[[gnu::always_inline]] inline NormalForce beyond_touch(ContactLaw const& law, ContactState const& c) {
  NormalForce force = hertz(law, c);
  double const gap = c.overlap < 0.0 ? -c.overlap : 0.0;
  bool const bridged = force.touches || (c.was_touching && gap < law.bridge.rupture * c.radius);
  double const s = law.bridge.steepness * gap / c.radius;
  double const pull = law.bridge.force * c.radius / (1.0 + 1.05 * s + 2.5 * s * s);
  force.attraction += (bridged ? pull : 0.0) + (gap < c.radius ? law.charge * c.closeness : 0.0);
  force.touches = bridged;
  return force;
}

/// Newton's iteration for b = sqrt(a) in b^4/R - c b = d, from above, where it converges monotonically to the stable
/// branch; a contact forms at d = 0 and tears where that branch ends.
[[gnu::always_inline]] inline NormalForce jkr(ContactLaw const& law, ContactState const& c) {
  double const cR = law.adhesion * c.radius, overlap = c.overlap > 0.0 ? c.overlap : 0.0;
  double y = std::sqrt(std::sqrt(cR)) + cR + 1e-9;  // above the cube root of cR, which is less than 1
  for (int i = 0; i < 12; ++i) y -= (y * y * y - cR) / (3 * y * y);
  double const tear = 0.75 * 0.6299605249474366 * law.adhesion * y;  // 4^(-1/3) y: where the branch ends
  bool const touches = c.overlap > 0.0 || (c.was_touching && c.overlap > -tear);
  double const reached = touches ? c.overlap : 0.0;
  double b = std::sqrt(std::sqrt(c.radius * overlap)) + y;
  for (int i = 0; i < 10; ++i) {
    double const cube = b * b * b;
    b -= (cube * b - cR * b - c.radius * reached) / (4 * cube - cR);
  }
  double const a = touches ? b * b : 0.0, E = 0.75 * law.normal_stiffness;
  double const a3 = a * a * a;
  // sqrt(8 pi W E) a^(3/2) with W = E c^2 / (2 pi)
  return {a, law.normal_stiffness * a3 / c.radius, 2 * E * law.adhesion * std::sqrt(a3), touches};
}

/// Straight-line code without branches, so that a loop over contacts becomes vector instructions.
template <Reach reach, RollingModel rolling_model>
[[gnu::always_inline]] inline ContactAction act(ContactLaw const& law, ContactState const& c, double dt) {
  NormalForce const along =
      reach == Reach::touch ? hertz(law, c) : (reach == Reach::tear_off ? jkr(law, c) : beyond_touch(law, c));
  double const a = along.contact_radius, viscous = std::sqrt(a / c.inverse_mass);

  double const vn = c.vx * c.nx + c.vy * c.ny + c.vz * c.nz;
  double const viscosity_n = law.normal_damping * viscous;
  double const damped = along.elastic - viscosity_n * vn / (1.0 + 0.25 * dt * viscosity_n * c.inverse_mass);
  double const repulsive = damped > law.least_normal ? damped : law.least_normal;
  double const normal = repulsive - along.attraction;

  double const tx = c.vx - vn * c.nx - (c.sy * c.nz - c.sz * c.ny);
  double const ty = c.vy - vn * c.ny - (c.sz * c.nx - c.sx * c.nz);
  double const tz = c.vz - vn * c.nz - (c.sx * c.ny - c.sy * c.nx);
  double ux = c.spring_x + tx * dt, uy = c.spring_y + ty * dt, uz = c.spring_z + tz * dt;
  double const un = ux * c.nx + uy * c.ny + uz * c.nz;
  ux -= un * c.nx;
  uy -= un * c.ny;
  uz -= un * c.nz;

  double const stiffness = law.tangential_stiffness * a;
  double const bound = law.sliding_friction * std::abs(repulsive - law.adhesion_in_coulomb * along.attraction);
  double const stretched = stiffness * std::sqrt(ux * ux + uy * uy + uz * uz);
  bool const slides = stretched > bound;
  double const carried = slides ? bound / stretched : 1.0;
  double const viscosity = slides ? 0.0 : law.tangential_damping * viscous;
  double const pull = stiffness * carried;
  double const gx = -(pull * ux + viscosity * tx);
  double const gy = -(pull * uy + viscosity * ty);
  double const gz = -(pull * uz + viscosity * tz);
  double const kept = along.touches && a > 0.0 ? (law.keeps_spring > 0.0 ? 1.0 : carried) : 0.0;

  ContactAction action;
  action.fx = normal * c.nx + gx;
  action.fy = normal * c.ny + gy;
  action.fz = normal * c.nz + gz;
  action.qx = c.ny * gz - c.nz * gy;
  action.qy = c.nz * gx - c.nx * gz;
  action.qz = c.nx * gy - c.ny * gx;
  action.spring_x = kept * ux;
  action.spring_y = kept * uy;
  action.spring_z = kept * uz;
  action.touches = along.touches;

  double const most = law.rolling_friction * c.radius * along.elastic;
  double const wn = c.wx * c.nx + c.wy * c.ny + c.wz * c.nz;
  double const ox = c.wx - wn * c.nx, oy = c.wy - wn * c.ny, oz = c.wz - wn * c.nz;
  if constexpr (rolling_model == RollingModel::cdt) {
    double const spin = std::sqrt(c.wx * c.wx + c.wy * c.wy + c.wz * c.wz);
    double const rolling = most / (spin > 0.0 ? spin : 1.0);
    action.rx = rolling * ox;
    action.ry = rolling * oy;
    action.rz = rolling * oz;
    action.turn_x = action.turn_y = action.turn_z = 0.0;
  } else {
    double const px = c.turn_x + ox * dt, py = c.turn_y + oy * dt, pz = c.turn_z + oz * dt;
    double const along_n = px * c.nx + py * c.ny + pz * c.nz;
    double const qx = px - along_n * c.nx, qy = py - along_n * c.ny, qz = pz - along_n * c.nz;
    double const spring = stiffness * c.radius * c.radius, torque = spring * std::sqrt(qx * qx + qy * qy + qz * qz);
    double const share = torque > most ? most / torque : 1.0, left = along.touches && a > 0.0 ? share : 0.0;
    action.turn_x = left * qx;
    action.turn_y = left * qy;
    action.turn_z = left * qz;
    action.rx = spring * share * qx;
    action.ry = spring * share * qy;
    action.rz = spring * share * qz;
  }
  return action;
}

}  // namespace layerloop::dem
