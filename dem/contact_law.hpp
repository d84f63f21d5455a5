#pragma once
#include <cmath>

#include "core/case.hpp"
#include "dem/vector_math.hpp"

namespace layerloop::dem {

/// Liquid between two bodies: F = force R / (1 + 1.05 S + 2.5 S^2), S = steepness gap / R, up to a gap of rupture R
/// (Willett et al., Langmuir 16 (2000) 9396, eq. for small volumes, with 2 R for the radius of equal spheres).
template <class Number>
struct BasicLiquidBridge {
  Number force{};  ///< [N/m]
  Number steepness{};
  Number rupture{};
};
using LiquidBridge = BasicLiquidBridge<double>;

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
template <class Number>
struct BasicContactLaw {
  Number normal_stiffness{};      ///< 4/3 E [Pa]
  Number tangential_stiffness{};  ///< 8 G [Pa]
  Number normal_damping{};        ///< g_n / sqrt(m a) [sqrt(Pa)]
  Number tangential_damping{};    ///< g_t / sqrt(m a) [sqrt(Pa)]
  Number sliding_friction{};
  Number rolling_friction{};
  Number cohesion{};                   ///< sjkr, sjkr2: attraction / (R d) [Pa]
  Number pull_off{};                   ///< dmt: attraction / R, 2 pi W [N/m]
  Number adhesion{};                   ///< jkr: c = sqrt(2 pi W / E) in d = a^2/R - c sqrt(a) [sqrt(m)]
  BasicLiquidBridge<Number> bridge{};  ///< forms on touch, and holds until it ruptures
  Number charge{};                     ///< attraction / (r_1 r_2 / distance)^2; between like grains negative [N/m^2]
  Number adhesion_in_coulomb{};        ///< 1 where the Coulomb bound takes the total normal force, else 0
  Number least_normal = Number{} - 1e300;  ///< normal force before attraction is at least this: 0 when clamped [N]
  Number keeps_spring{};                   ///< 1 where a sliding contact keeps its spring, 0 where it rescales it
};
using ContactLaw = BasicContactLaw<double>;

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

inline constexpr double standard_gravity = 9.81;  ///< [m/s^2]

/// That of the materials in these settings.
Body body_of(ContactSettings const& contact);

/// Two grains of unlike bodies. The first has a finite Young's modulus; which is first does not matter to more than the
/// last bit.
ContactLaw grain_law(ContactSettings const& contact, Body const& first, Body const& second);
/// Grain and wall; the wall may be rigid.
ContactLaw wall_law(ContactSettings const& contact, Body const& grain, Body const& wall);

/// Two grains. sjkr2: A = 2 pi d (2 R), thesis eq. 6; sjkr: half of it.
ContactLaw grain_law(ContactSettings const& contact);
/// Grain and wall of the same body: wall friction; A = 2 pi R d (liggghts) or 4 pi R d (eq6).
ContactLaw wall_law(ContactSettings const& contact);

/// Duration of an undamped Hertz impact of two equal grains at a relative speed: 2.868 (m^2 / (R E^2 v))^(1/5) [s].
double hertz_contact_time(double radius, double density, double speed, ContactSettings const& contact);
/// Pull-off force over weight, for two equal grains. sjkr, sjkr2: (16 pi^3/3) k^3 R^2 / E^2 (sjkr: 1/8 of it);
/// dmt: 2 pi W R; jkr: 3/2 pi W R.
double bond_number(double radius, double density, ContactSettings const& contact);
/// Largest gap at which something still acts [m]: jkr tears at 3/4 (pi^2 W^2 R / E^2)^(1/3), a bridge ruptures, charge
/// is cut off at a radius.
double reach_gap(ContactLaw const& law, double reduced_radius);

/// Geometry and motion of one pair, or of eight. The normal points from the second body to the first.
template <class Number>
struct BasicContactState {
  Number overlap, radius, inverse_mass;  ///< d (negative: apart), R, 1/m
  Number nx, ny, nz;
  Number vx, vy, vz;  ///< velocity of the first centre relative to the second [m/s]
  Number sx, sy, sz;  ///< surface rotation: arm_1 w_1 + arm_2 w_2 [m/s], arm = radius - d/2
  Number wx, wy, wz;  ///< spin of the first relative to the second [rad/s]
  Number spring_x, spring_y, spring_z;
  Number turn_x, turn_y, turn_z;  ///< epsd2: rolling angle that is stored [rad]
  Number closeness;               ///< (r_1 r_2 / distance)^2, for charge [m^2]
  decltype(Number{} > Number{}) was_touching;
};
using ContactState = BasicContactState<double>;

/// What a contact does to the first body; the second gets -force, and the torque with its own arm and +rolling.
template <class Number>
struct BasicContactAction {
  Number fx, fy, fz;  ///< force on the first body [N]
  Number qx, qy, qz;  ///< normal x tangential force; torque is -arm q on either body [N]
  Number rx, ry, rz;  ///< rolling torque, taken from the first body [N m]
  Number spring_x, spring_y, spring_z;
  Number turn_x, turn_y, turn_z;
  decltype(Number{} > Number{}) touches;
};
using ContactAction = BasicContactAction<double>;

/// Contact radius and forces along the normal, before damping.
template <class Number>
struct NormalForce {
  Number contact_radius, elastic, attraction;
  Number viscous{};                       ///< sqrt(m a)
  decltype(Number{} > Number{}) touches;  ///< or is held by a bridge
};

template <class Number>
[[gnu::always_inline]] inline NormalForce<Number> hertz(BasicContactLaw<Number> const& law,
                                                        BasicContactState<Number> const& c) {
  Number const none{}, overlap = c.overlap > 0.0 ? c.overlap : none, area = c.radius * overlap, a = root(area);
  auto const touches = c.overlap > 0.0;
  Number const pull_off = law.pull_off * c.radius;
  return {a, law.normal_stiffness * a * overlap, law.cohesion * area + (c.overlap > 0.0 ? pull_off : none), none,
          touches};
}

/// As hertz(), with what acts before and after touch.
template <class Number>
[[gnu::always_inline]] inline NormalForce<Number> beyond_touch(BasicContactLaw<Number> const& law,
                                                               BasicContactState<Number> const& c) {
  NormalForce<Number> force = hertz(law, c);
  Number const none{}, gap = c.overlap < 0.0 ? -c.overlap : none;
  auto const bridged = c.overlap > 0.0 || (c.was_touching && gap < law.bridge.rupture * c.radius);
  Number const s = law.bridge.steepness * gap / c.radius;
  Number const pull = law.bridge.force * c.radius / (1.0 + 1.05 * s + 2.5 * s * s), image = law.charge * c.closeness;
  force.attraction += (bridged ? pull : none) + (gap < c.radius ? image : none);
  force.touches = bridged;
  return force;
}

/// Newton's iteration for b = sqrt(a) in b^4/R - c b = d, from above, where it converges monotonically to the stable
/// branch; a contact forms at d = 0 and tears where that branch ends.
template <class Number>
[[gnu::always_inline]] inline NormalForce<Number> jkr(BasicContactLaw<Number> const& law,
                                                      BasicContactState<Number> const& c) {
  Number const none{}, cR = law.adhesion * c.radius, overlap = c.overlap > 0.0 ? c.overlap : none;
  Number y = root(root(cR)) + cR + 1e-9;  // above the cube root of cR, which is less than 1
  for (int i = 0; i < 12; ++i) y -= (y * y * y - cR) / (3.0 * y * y);
  Number const tear = 0.75 * 0.6299605249474366 * law.adhesion * y;  // 4^(-1/3) y: where the branch ends
  auto const touches = c.overlap > 0.0 || (c.was_touching && c.overlap > -tear);
  Number const reached = touches ? c.overlap : none;
  Number b = root(root(c.radius * overlap)) + y;
  for (int i = 0; i < 10; ++i) {
    Number const cube = b * b * b;
    b -= (cube * b - cR * b - c.radius * reached) / (4.0 * cube - cR);
  }
  Number const square = b * b, a = touches ? square : none, E = 0.75 * law.normal_stiffness, a3 = a * a * a;
  // sqrt(8 pi W E) a^(3/2) with W = E c^2 / (2 pi)
  return {a, law.normal_stiffness * a3 / c.radius, 2.0 * E * law.adhesion * root(a3), none, touches};
}

/// First half of a contact: what follows from positions. Needs of the state what stands above the velocities, and
/// closeness and was_touching.
template <Reach reach, class Number>
[[gnu::always_inline]] inline NormalForce<Number> normal_force(BasicContactLaw<Number> const& law,
                                                               BasicContactState<Number> const& c) {
  NormalForce<Number> force;
  if constexpr (reach == Reach::touch) force = hertz(law, c);
  if constexpr (reach == Reach::tear_off) force = jkr(law, c);
  if constexpr (reach == Reach::beyond) force = beyond_touch(law, c);
  force.viscous = root(force.contact_radius * inverse(c.inverse_mass));
  return force;
}

/// Second half: what follows from motion. Straight-line code without branches, for one contact or for eight at once.
template <RollingModel rolling_model, class Number>
[[gnu::always_inline]] inline BasicContactAction<Number> act(BasicContactLaw<Number> const& law,
                                                             NormalForce<Number> const& along,
                                                             BasicContactState<Number> const& c, double dt) {
  Number const none{}, one = filled<Number>(1.0), a = along.contact_radius, viscous = along.viscous;

  Number const vn = c.vx * c.nx + c.vy * c.ny + c.vz * c.nz;
  Number const viscosity_n = law.normal_damping * viscous;
  Number const damped = along.elastic - viscosity_n * vn * inverse(1.0 + 0.25 * dt * viscosity_n * c.inverse_mass);
  Number const repulsive = damped > law.least_normal ? damped : law.least_normal;
  Number const normal = repulsive - along.attraction;

  Number const tx = c.vx - vn * c.nx - (c.sy * c.nz - c.sz * c.ny);
  Number const ty = c.vy - vn * c.ny - (c.sz * c.nx - c.sx * c.nz);
  Number const tz = c.vz - vn * c.nz - (c.sx * c.ny - c.sy * c.nx);
  Number ux = c.spring_x + tx * dt, uy = c.spring_y + ty * dt, uz = c.spring_z + tz * dt;
  Number const un = ux * c.nx + uy * c.ny + uz * c.nz;
  ux -= un * c.nx;
  uy -= un * c.ny;
  uz -= un * c.nz;

  Number const stiffness = law.tangential_stiffness * a;
  Number const bound = law.sliding_friction * magnitude(repulsive - law.adhesion_in_coulomb * along.attraction);
  Number const stretched = stiffness * stiffness * (ux * ux + uy * uy + uz * uz);  // squared
  auto const slides = stretched > bound * bound;
  Number const shortened = bound * inverse_root(stretched + 1e-280), dashpot = law.tangential_damping * viscous;
  Number const carried = slides ? shortened : one, viscosity = slides ? none : dashpot;
  Number const pull = stiffness * carried;
  Number const gx = -(pull * ux + viscosity * tx);
  Number const gy = -(pull * uy + viscosity * ty);
  Number const gz = -(pull * uz + viscosity * tz);
  Number const left = law.keeps_spring > 0.0 ? one : carried, kept = a > 0.0 ? left : none;

  BasicContactAction<Number> action;
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

  Number const most = law.rolling_friction * c.radius * along.elastic;
  Number const wn = c.wx * c.nx + c.wy * c.ny + c.wz * c.nz;
  Number const ox = c.wx - wn * c.nx, oy = c.wy - wn * c.ny, oz = c.wz - wn * c.nz;
  if constexpr (rolling_model == RollingModel::cdt) {
    Number const rolling = most * inverse_root(c.wx * c.wx + c.wy * c.wy + c.wz * c.wz + 1e-280);
    action.rx = rolling * ox;
    action.ry = rolling * oy;
    action.rz = rolling * oz;
    action.turn_x = action.turn_y = action.turn_z = none;
  } else {
    Number const px = c.turn_x + ox * dt, py = c.turn_y + oy * dt, pz = c.turn_z + oz * dt;
    Number const along_n = px * c.nx + py * c.ny + pz * c.nz;
    Number const qx = px - along_n * c.nx, qy = py - along_n * c.ny, qz = pz - along_n * c.nz;
    Number const spring = stiffness * c.radius * c.radius, torque = spring * root(qx * qx + qy * qy + qz * qz);
    Number const cut = most * inverse(torque + 1e-280), share = torque > most ? cut : one,
                 stays = a > 0.0 ? share : none;
    action.turn_x = stays * qx;
    action.turn_y = stays * qy;
    action.turn_z = stays * qz;
    action.rx = spring * share * qx;
    action.ry = spring * share * qy;
    action.rz = spring * share * qz;
  }
  return action;
}

/// Both halves.
template <Reach reach, RollingModel rolling_model, class Number>
[[gnu::always_inline]] inline BasicContactAction<Number> act(BasicContactLaw<Number> const& law,
                                                             BasicContactState<Number> const& c, double dt) {
  return act<rolling_model>(law, normal_force<reach>(law, c), c, dt);
}

}  // namespace layerloop::dem
