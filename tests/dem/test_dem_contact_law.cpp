// Single collisions against closed forms: Hertz, damped restitution, friction, rolling, cohesion, conservation.
#include <gtest/gtest.h>

#include <cmath>

#include "support.hpp"

namespace layerloop::dem {
namespace {
using namespace test;
using std::numbers::pi;

constexpr double radius = 12.5e-6;

/// Two equal grains about to meet head-on along x.
PowderBed head_on(double relative_speed) {
  PowderBed bed;
  bed.add(1, {-radius * 1.001, 50e-6, 0}, radius, 0);
  bed.add(2, {radius * 1.001, 50e-6, 0}, radius, 0);
  bed.vx = {relative_speed / 2, -relative_speed / 2};
  return bed;
}

double returned_speed_ratio(double restitution, double step, double speed) {
  ContactSettings contact = plain_contact();
  contact.restitution = restitution;
  contact.time_step_fraction = step;
  Simulation simulation(motion(contact, radius), empty_space(), alone());
  simulation.scatter(head_on(speed));
  double const duration = 0.003 * radius / speed + 3 * hertz_contact_time(radius, density, speed, contact);
  simulation.advance(static_cast<std::int64_t>(duration / simulation.time_step()));
  PowderBed const bed = simulation.gather();
  EXPECT_TRUE(bed.contacts.empty());
  return (bed.vx[1] - bed.vx[0]) / speed;
}

TEST(Restitution, IsReturnedAtAFineStep) {
  for (double e = 0.3; e < 0.95; e += 0.1) EXPECT_NEAR(returned_speed_ratio(e, 0.002, 0.05), e, 1e-4) << e;
}

TEST(Restitution, IsReturnedAtTheProductionStep) {
  for (double e = 0.3; e < 0.95; e += 0.1) EXPECT_NEAR(returned_speed_ratio(e, 0.149, 0.1), e, 0.02 * e) << e;
}

TEST(Restitution, DoesNotDependOnSpeed) {
  for (double speed : {0.01, 0.1, 0.5}) EXPECT_NEAR(returned_speed_ratio(0.7, 0.01, speed), 0.7, 1e-3) << speed;
}

struct Impact {
  double overlap, time;
};

/// Largest overlap [m] and time in contact [s] of an undamped impact, measured step by step.
Impact undamped(PowderBed const& bed, Rig const& rig, ContactSettings contact, bool at_wall) {
  contact.restitution = 1;
  contact.time_step_fraction = 0.005;
  Simulation simulation(motion(contact, radius), rig, alone());
  simulation.scatter(bed);
  std::int64_t touching = 0;
  for (int step = 0; step < 8000; ++step) {
    simulation.advance(1);
    bool const touches = at_wall ? !simulation.gather().contacts.empty() : simulation.touching_pairs() > 0;
    touching += touches;
    if (touching > 0 && !touches) break;
  }
  return {simulation.largest_overlap() * 2 * radius, static_cast<double>(touching) * simulation.time_step()};
}

TEST(Hertz, PairOverlapAndContactTime) {
  ContactSettings const contact = plain_contact();
  double const v = 0.1, E = reduced_modulus(contact), m = mass_of(radius) / 2;
  Impact const impact = undamped(head_on(v), empty_space(), contact, false);
  double const expected = std::pow(15 * m * v * v / (16 * E * std::sqrt(radius / 2)), 0.4);
  EXPECT_NEAR(impact.overlap, expected, 1e-3 * expected);
  EXPECT_NEAR(impact.time, 2.9432 * expected / v, 2e-3 * impact.time);
  EXPECT_NEAR(hertz_contact_time(radius, density, v, contact), 2.9432 * expected / v, 1e-3 * impact.time);
}

TEST(Hertz, SphereOnWall) {
  ContactSettings const contact = plain_contact();
  double const v = 0.1, E = reduced_modulus(contact), m = mass_of(radius);
  Rig rig = empty_space();
  rig.walls.blocks = {floor_block()};
  PowderBed bed;
  bed.add(0, {0, 50e-6, radius * 1.001}, radius, 0);
  bed.vz[0] = -v;
  Impact const impact = undamped(bed, rig, contact, true);
  double const expected = std::pow(15 * m * v * v / (16 * E * std::sqrt(radius)), 0.4);
  EXPECT_NEAR(impact.overlap, expected, 1e-3 * expected);
  EXPECT_NEAR(impact.time, 2.9432 * expected / v, 2e-3 * impact.time);
}

/// A grain at rest on a plane: overlap where the Hertz force carries its weight.
PowderBed on_floor(ContactSettings const& contact) {
  double const weight = mass_of(radius) * standard_gravity;
  double const overlap = std::pow(weight / (4.0 / 3.0 * reduced_modulus(contact) * std::sqrt(radius)), 2.0 / 3.0);
  PowderBed bed;
  bed.add(0, {0, 50e-6, radius - overlap}, radius, 0);
  return bed;
}

Rig floor_with_gravity() {
  Rig rig = empty_space();
  rig.walls.blocks = {floor_block()};
  rig.gravity = {0, 0, -standard_gravity};
  return rig;
}

TEST(Friction, SlidingSphereEndsRolling) {
  ContactSettings contact = plain_contact();
  contact.wall_friction = 0.3;
  double const v0 = 0.02, time = 2 * v0 / (7 * contact.wall_friction * standard_gravity);
  PowderBed bed = on_floor(contact);
  bed.vx[0] = v0;
  Simulation simulation(motion(contact, radius), floor_with_gravity(), alone());
  simulation.scatter(bed);
  auto const steps = static_cast<std::int64_t>(time / simulation.time_step());
  simulation.advance(steps * 97 / 100);  // still slips just before
  bed = simulation.gather();
  EXPECT_GT(bed.vx[0] - radius * bed.wy[0], 0.02 * v0);
  simulation.advance(steps * 8 / 100);  // rolls soon after
  bed = simulation.gather();
  EXPECT_NEAR(bed.vx[0], 5.0 / 7.0 * v0, 0.005 * v0);
  EXPECT_NEAR(radius * bed.wy[0], bed.vx[0], 0.005 * v0);
}

TEST(Friction, RollingDistanceOfCdt) {
  ContactSettings contact = plain_contact();
  contact.rolling_friction = 0.15;
  double const v = 0.021, distance = 7 * v * v / (10 * contact.rolling_friction * standard_gravity);
  PowderBed bed = on_floor(contact);
  bed.vx[0] = v;
  bed.wy[0] = v / radius;
  Simulation simulation(motion(contact, radius), floor_with_gravity(), alone());
  simulation.scatter(bed);
  simulation.advance(static_cast<std::int64_t>(1.2 * 2 * distance / v / simulation.time_step()));
  bed = simulation.gather();
  EXPECT_NEAR(bed.x[0], distance, 0.01 * distance);
  EXPECT_LT(std::abs(bed.vx[0]), 1e-3 * v);
}

TEST(Friction, GrossSlipImpact) {
  ContactSettings contact = plain_contact();
  contact.restitution = 0.98;
  contact.wall_friction = 0.092;
  contact.time_step_fraction = 0.01;
  for (double degrees : {50.0, 60.0, 75.0}) {
    double const angle = degrees * pi / 180, v = 0.2, vn = v * std::cos(angle), vt = v * std::sin(angle);
    Rig rig = empty_space();
    rig.walls.blocks = {floor_block()};
    PowderBed bed;
    bed.add(0, {0, 50e-6, 1.001 * radius}, radius, 0);
    set_velocity(bed, 0, {vt, 0, -vn});
    Simulation simulation(motion(contact, radius), rig, alone());
    simulation.scatter(bed);
    simulation.advance(static_cast<std::int64_t>(
        (0.004 * radius / vn + 3 * hertz_contact_time(radius, density, vn, contact)) / simulation.time_step()));
    bed = simulation.gather();
    ASSERT_TRUE(bed.contacts.empty());
    double const kept = 1 - contact.wall_friction * 1.98 / std::tan(angle);
    EXPECT_NEAR(bed.vx[0] / vt, kept, 0.005 * kept) << degrees;
    EXPECT_NEAR(bed.wy[0], 2.5 * contact.wall_friction * 1.98 * vn / radius, 0.005 * bed.wy[0]) << degrees;
  }
}

TEST(Conservation, LinearAndAngularMomentumOfAnObliquePair) {
  ContactSettings contact = plain_contact();
  contact.cohesion = Cohesion::sjkr2;
  contact.rolling_friction = 0.15;
  double const small = 6.5e-6, large = 21e-6;
  PowderBed bed;
  bed.add(3, {-large, 40e-6, 0}, large, 0);
  bed.add(9, {small * 1.05, 46e-6, 7e-6}, small, 0);
  set_velocity(bed, 0, {0.08, 0.01, 0.02});
  set_velocity(bed, 1, {-0.09, 0.03, -0.01});
  bed.wx = {300, -2000};
  bed.wy = {-800, 900};
  bed.wz = {500, 4000};
  auto const momentum = [](PowderBed const& b) {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
      double const m = mass_of(b.radius[i]);
      Vec3 const v(b.vx[i], b.vy[i], b.vz[i]), w(b.wx[i], b.wy[i], b.wz[i]);
      linear += m * v;
      angular += m * b.position(i).cross(v) + 0.4 * m * b.radius[i] * b.radius[i] * w;
    }
    return std::pair(linear, angular);
  };
  auto const [linear, angular] = momentum(bed);
  Simulation simulation(motion(contact, small), empty_space(), alone());
  simulation.scatter(bed);
  Vec3 const spin(bed.wx[0], bed.wy[0], bed.wz[0]);
  simulation.advance(800);
  ASSERT_GT(simulation.largest_overlap(), 1e-3);
  bed = simulation.gather();
  auto const [linear_after, angular_after] = momentum(bed);
  EXPECT_GT((Vec3(bed.wx[0], bed.wy[0], bed.wz[0]) - spin).norm(), 1.0);  // friction did act
  EXPECT_LT((linear_after - linear).norm(), 1e-12 * linear.norm());
  EXPECT_LT((angular_after - angular).norm(), 1e-12 * angular.norm());
}

double normal_force(ContactLaw const& law, double reduced_radius, double overlap) {
  ContactState state{};
  state.overlap = overlap;
  state.radius = reduced_radius;
  state.inverse_mass = 1e11;
  state.nx = 1;
  return act<Reach::touch, RollingModel::cdt>(law, state, 1e-8).fx;
}

TEST(Cohesion, PullOffForceOfSjkr2) {
  ContactSettings contact = plain_contact();
  contact.cohesion = Cohesion::sjkr2;
  double const k = contact.cohesion_energy_density, E = reduced_modulus(contact), R = radius / 2;
  double const expected = -16 * pi * pi * pi / 3 * k * k * k * R * R / (E * E);
  double least = 0;
  for (double overlap = 0; overlap < 5e-9; overlap += 1e-13)
    least = std::min(least, normal_force(grain_law(contact), R, overlap));
  EXPECT_NEAR(least, expected, 1e-5 * std::abs(expected));
  double const zero_load = 9 * pi * pi * k * k * R / (E * E);
  EXPECT_NEAR(normal_force(grain_law(contact), R, zero_load), 0, 1e-12 * std::abs(expected));
  EXPECT_NEAR(bond_number(radius, density, contact), -expected / (mass_of(radius) * standard_gravity), 1e-9);
}

TEST(Cohesion, WallConventionsDifferByTwo) {
  ContactSettings contact = plain_contact();
  double const overlap = 1e-9, bare = normal_force(wall_law(contact), radius, overlap);
  contact.cohesion = Cohesion::sjkr2;
  double const k = contact.cohesion_energy_density;
  EXPECT_NEAR(bare - normal_force(wall_law(contact), radius, overlap), 2 * pi * k * radius * overlap, 1e-18);
  contact.wall_cohesion_area = WallCohesionArea::eq6;
  EXPECT_NEAR(bare - normal_force(wall_law(contact), radius, overlap), 4 * pi * k * radius * overlap, 1e-18);
}

/// Does a grain hang on under a ceiling when it is pulled down with this share of the pull-off force?
bool hangs_on(double share) {
  ContactSettings contact = plain_contact();
  contact.cohesion = Cohesion::sjkr2;
  contact.wall_cohesion_area = WallCohesionArea::eq6;
  double const k = contact.cohesion_energy_density, E = reduced_modulus(contact);
  double const pull_off = 16 * pi * pi * pi / 3 * k * k * k * radius * radius / (E * E);
  double const edge = 4 * pi * pi * k * k * radius / (E * E);  // overlap of the largest attraction
  Rig rig = empty_space();
  rig.walls.blocks = {{"the ceiling", -1e-3, 1e-3, 0, 1e-3, 0, 0}};
  rig.gravity = {0, 0, -share * pull_off / mass_of(radius)};
  PowderBed bed;
  bed.add(0, {0, 50e-6, -radius + 1.5 * edge}, radius, 0);  // between there and no load: both fall back or come off
  Simulation simulation(motion(contact, radius), rig, alone());
  simulation.scatter(bed);
  simulation.advance(20000);
  return !simulation.gather().contacts.empty();
}

TEST(Cohesion, GrainComesOffTheCeilingAtThePullOffForce) {
  EXPECT_TRUE(hangs_on(0.9));
  EXPECT_FALSE(hangs_on(1.02));
}

TEST(Coulomb, BoundOnTotalForceLeavesCohesionOut) {
  ContactSettings contact = plain_contact();
  contact.cohesion = Cohesion::sjkr2;
  ContactState state{};
  state.overlap = 2e-9;
  state.radius = radius / 2;
  state.inverse_mass = 1e11;
  state.nx = 1;
  state.spring_y = 1e-6;  // far beyond the bound
  double const bare = normal_force(grain_law(plain_contact()), state.radius, state.overlap);
  double const total = normal_force(grain_law(contact), state.radius, state.overlap);
  EXPECT_NEAR((-act<Reach::touch, RollingModel::cdt>(grain_law(contact), state, 1e-8).fy), 0.7 * bare, 1e-9 * bare);
  contact.coulomb_on = CoulombOn::total;
  EXPECT_NEAR((-act<Reach::touch, RollingModel::cdt>(grain_law(contact), state, 1e-8).fy), 0.7 * std::abs(total),
              1e-9 * bare);
}

TEST(RayleighTime, OfTheThesis) {
  // notes on the thesis' eq. 12: R = 6.5 um, E = 0.2 GPa, nu = 0.3: 2.41e-7 s at 9187 kg/m^3, 2.28e-7 s at 8190 kg/m^3
  EXPECT_NEAR(rayleigh_time(6.5e-6, 9187, plain_contact()), 2.411e-7, 1e-10);
  EXPECT_NEAR(rayleigh_time(6.5e-6, 8190, plain_contact()), 2.276e-7, 1e-10);
}

}  // namespace
}  // namespace layerloop::dem
