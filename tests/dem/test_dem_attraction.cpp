// Attraction and damping forms against closed forms: pull-off, tear-off, bridges, charge, clamped restitution, gas.
#include <gtest/gtest.h>

#include <cmath>

#include "support.hpp"

namespace layerloop::dem {
namespace {
using namespace test;
using std::numbers::pi;

constexpr double R = 6.25e-6;  // reduced radius [m]

/// A pair at rest relative to one another.
ContactState still(double overlap, bool was_touching = true) {
  ContactState state{};
  state.overlap = overlap;
  state.radius = R;
  state.inverse_mass = 1e11;
  state.nx = 1;
  state.was_touching = was_touching;
  return state;
}

ContactSettings with(Cohesion cohesion) {
  ContactSettings contact = plain_contact();
  contact.cohesion = cohesion;
  contact.surface_energy = 0.1e-3;
  contact.cohesion_energy_density = 9e4;
  return contact;
}

template <Reach reach>
double force(ContactLaw const& law, double overlap, bool was_touching = true) {
  return act<reach, RollingModel::cdt>(law, still(overlap, was_touching), 1e-9).fx;
}

TEST(Jkr, PullsOffAtThreeHalvesPiWRAndTearsAtFiveNinthsOfIt) {
  ContactSettings const contact = with(Cohesion::jkr);
  ContactLaw const law = grain_law(contact);
  double const W = 2 * contact.surface_energy, E = reduced_modulus(contact), pull_off = 1.5 * pi * W * R;
  double const tear = 0.75 * std::cbrt(pi * pi * W * W * R / (E * E));
  EXPECT_NEAR(reach_gap(law, R), tear, 1e-6 * tear);
  double least = 0;
  for (int k = 0; k <= 4000; ++k)
    least = std::min(least, force<Reach::tear_off>(law, tear * (1 - 2e-3 * k / 4 - 1e-9) * -1));
  EXPECT_NEAR(least, -pull_off, 1e-4 * pull_off);
  EXPECT_NEAR(force<Reach::tear_off>(law, -tear * (1 - 1e-7)), -5.0 / 9 * pull_off, 0.005 * pull_off);
  EXPECT_EQ(force<Reach::tear_off>(law, -tear * (1 + 1e-6)), 0);
  EXPECT_EQ(force<Reach::tear_off>(law, -0.5 * tear, false), 0) << "a contact forms on touch only";
}

TEST(Jkr, ForceFollowsFromTheContactRadius) {
  ContactSettings const contact = with(Cohesion::jkr);
  ContactLaw const law = grain_law(contact);
  double const W = 2 * contact.surface_energy, E = reduced_modulus(contact);
  double const a_rest = std::cbrt(9 * pi * W * R * R / (2 * E));  // without load
  for (double const a : {0.7 * a_rest, a_rest, 1.5 * a_rest, 3 * a_rest}) {
    double const overlap = a * a / R - std::sqrt(2 * pi * W * a / E);
    double const expected = 4 * E * a * a * a / (3 * R) - std::sqrt(8 * pi * W * E) * std::pow(a, 1.5);
    EXPECT_NEAR(force<Reach::tear_off>(law, overlap), expected, 1e-9 * 1.5 * pi * W * R) << a / a_rest;
  }
}

TEST(Jkr, WithoutSurfaceEnergyIsHertz) {
  ContactSettings contact = with(Cohesion::jkr);
  contact.surface_energy = 0;
  double const hertz = force<Reach::touch>(grain_law(plain_contact()), 1e-8);
  EXPECT_NEAR(force<Reach::tear_off>(grain_law(contact), 1e-8), hertz, 1e-9 * hertz);
}

TEST(Dmt, PullsWithTwoPiWRWhileTouching) {
  ContactSettings const contact = with(Cohesion::dmt);
  double const W = 2 * contact.surface_energy;
  double const hertz = force<Reach::touch>(grain_law(plain_contact()), 1e-8);
  EXPECT_NEAR(hertz - force<Reach::touch>(grain_law(contact), 1e-8), 2 * pi * W * R, 1e-9 * hertz);
  EXPECT_EQ(force<Reach::touch>(grain_law(contact), -1e-12), 0);
}

TEST(Sjkr, HasHalfTheAreaOfSjkr2) {
  double const hertz = force<Reach::touch>(grain_law(plain_contact()), 1e-8);
  double const whole = hertz - force<Reach::touch>(grain_law(with(Cohesion::sjkr2)), 1e-8);
  EXPECT_NEAR(whole, 9e4 * 4 * pi * R * 1e-8, 1e-12 * hertz);
  EXPECT_NEAR(hertz - force<Reach::touch>(grain_law(with(Cohesion::sjkr)), 1e-8), 0.5 * whole, 1e-12 * hertz);
}

TEST(LiquidBridge, FormsOnTouchAndRupturesWhereItsVolumeSays) {
  ContactSettings contact = plain_contact();
  contact.liquid_volume = 1e-3;
  contact.contact_angle = 0.5;
  contact.surface_tension = 0.072;
  ContactLaw const law = grain_law(contact);
  double const at_touch = 4 * pi * R * 0.072 * std::cos(0.5), rupture = (1 + 0.25) * 0.1 * 2 * R;
  EXPECT_NEAR(-force<Reach::beyond>(law, 0), at_touch, 1e-12 * at_touch);
  EXPECT_NEAR(reach_gap(law, R), rupture, 1e-12 * rupture);
  double const s = 0.5 * rupture / (2 * R) * std::sqrt(1 / 1e-3);  // gap over 2 R, times sqrt(r^3 / V)
  EXPECT_NEAR(-force<Reach::beyond>(law, -0.5 * rupture), at_touch / (1 + 1.05 * s + 2.5 * s * s), 1e-9 * at_touch);
  EXPECT_EQ(force<Reach::beyond>(law, -1.001 * rupture), 0);
  EXPECT_EQ(force<Reach::beyond>(law, -0.5 * rupture, false), 0) << "no bridge before the first touch";
}

TEST(Charge, RepelsAsCoulombAndIsHeldByItsImage) {
  ContactSettings contact = plain_contact();
  contact.charge_density = 1e-6;
  constexpr double r = 12.5e-6, vacuum = 8.8541878128e-12;
  double const q = 1e-6 * 4 * pi * r * r, gap = 2e-6;
  ContactState pair = still(-gap), at_wall = still(-gap);
  pair.closeness = std::pow(r * r / (2 * r + gap), 2);
  double const repulsion = act<Reach::beyond, RollingModel::cdt>(grain_law(contact), pair, 1e-9).fx;
  EXPECT_NEAR(repulsion, q * q / (4 * pi * vacuum * std::pow(2 * r + gap, 2)), 1e-9 * repulsion);
  at_wall.radius = r;
  at_wall.closeness = std::pow(r * r / (r + gap), 2);
  double const image = -act<Reach::beyond, RollingModel::cdt>(wall_law(contact), at_wall, 1e-9).fx;
  EXPECT_NEAR(image, q * q / (16 * pi * vacuum * std::pow(r + gap, 2)), 1e-9 * image);
}

TEST(Beyond, IsBitForBitTheCommonLawWithoutBridgeAndCharge) {
  ContactLaw const law = grain_law(with(Cohesion::sjkr2));
  for (double const overlap : {-1e-7, 1e-9, 3e-8})
    EXPECT_EQ(force<Reach::beyond>(law, overlap), force<Reach::touch>(law, overlap));
}

/// Speed after over before of two equal grains, with the normal force cut at zero.
double clamped_ratio(double restitution) {
  ContactSettings contact = plain_contact();
  contact.restitution = restitution;
  contact.restitution_form = RestitutionForm::clamped;
  contact.time_step_fraction = 0.005;
  Simulation simulation(motion(contact, 12.5e-6), empty_space(), alone());
  PowderBed bed;
  bed.add(1, {-12.51e-6, 50e-6, 0}, 12.5e-6, 0);
  bed.add(2, {12.51e-6, 50e-6, 0}, 12.5e-6, 0);
  bed.vx = {0.05, -0.05};
  simulation.scatter(bed);
  simulation.advance(static_cast<std::int64_t>(1.5e-5 / simulation.time_step()));
  bed = simulation.gather();
  return (bed.vx[1] - bed.vx[0]) / 0.1;
}

TEST(Clamped, RestitutionIsLargerAsTheDampingCannotPull) {
  // from the equation of motion, solved with a fourth-order Runge-Kutta method
  double const expected[][2] = {{.2, .325}, {.4, .472}, {.5, .550}, {.6, .632}, {.7, .718}, {.8, .808}, {.9, .902}};
  for (auto const [e, realised] : expected) EXPECT_NEAR(clamped_ratio(e), realised, 0.005 * realised) << e;
}

TEST(Epsd2, IsASpringCutAtTheTorqueOfCdt) {
  ContactSettings contact = plain_contact();
  contact.rolling_friction = 0.15;
  ContactLaw const law = grain_law(contact);
  double const overlap = 1e-8, a = std::sqrt(R * overlap), G = contact.youngs_modulus / (4 * (2 - 0.3) * 1.3);
  double const stiffness = 8 * G * a * R * R, most = 0.15 * R * force<Reach::touch>(law, overlap);
  ContactState state = still(overlap);
  double const angle = 0.5 * most / stiffness, dt = 1e-9;
  state.wy = angle / dt;
  ContactAction const half = act<Reach::touch, RollingModel::epsd2>(law, state, dt);
  EXPECT_NEAR(half.ry, 0.5 * most, 1e-9 * most);
  EXPECT_NEAR(half.turn_y, angle, 1e-9 * angle);
  state.turn_y = 5 * angle;
  EXPECT_NEAR((act<Reach::touch, RollingModel::epsd2>(law, state, dt).ry), most, 1e-9 * most);
  state.wx = 1;  // turning about the normal is not rolling
  EXPECT_EQ((act<Reach::touch, RollingModel::epsd2>(law, state, dt).rx), 0);
}

TEST(SlidingSpring, IsKeptOrRescaled) {
  ContactSettings contact = plain_contact();
  ContactState state = still(1e-8);
  state.spring_y = 1e-6;
  ContactAction const rescaled = act<Reach::touch, RollingModel::cdt>(grain_law(contact), state, 1e-9);
  contact.sliding_spring = SlidingSpring::kept;
  ContactAction const kept = act<Reach::touch, RollingModel::cdt>(grain_law(contact), state, 1e-9);
  EXPECT_EQ(kept.fy, rescaled.fy);
  EXPECT_NEAR(-kept.fy, 0.7 * kept.fx, 1e-9 * kept.fx);
  EXPECT_EQ(kept.spring_y, 1e-6);
  double const stiffness = grain_law(contact).tangential_stiffness * std::sqrt(R * 1e-8);
  EXPECT_NEAR(rescaled.spring_y, 0.7 * kept.fx / stiffness, 1e-9 * 1e-6);
}

TEST(GasDrag, GrainFallsAtStokesSpeed) {
  ContactSettings contact = plain_contact();
  contact.gas_viscosity = 2.2e-5;
  constexpr double r = 2.5e-6;
  Motion const fall = motion(contact, r);
  Rig rig = empty_space();
  rig.gravity = {0, 0, -9.81};
  Simulation simulation(fall, rig, alone());
  PowderBed bed;
  bed.add(1, {0, 50e-6, 0}, r, 0);
  bed.add(2, {100e-6, 50e-6, 0}, r, 0);
  simulation.scatter(bed);
  double const relaxation = 2 * density * r * r / (9 * 2.2e-5), terminal = relaxation * 9.81;
  simulation.advance(std::llround(relaxation / fall.time_step));
  EXPECT_NEAR(-simulation.gather().vz[0], terminal * (1 - std::exp(-1.0)), 1e-3 * terminal);
  simulation.advance(std::llround(9 * relaxation / fall.time_step));
  EXPECT_NEAR(-simulation.gather().vz[0], terminal, 1e-3 * terminal);
}

}  // namespace
}  // namespace layerloop::dem
