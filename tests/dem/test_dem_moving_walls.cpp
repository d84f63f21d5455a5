// Shapes and motion of tools: super-elliptic edges, tables, rollers, meshes that move, shaking, yielding, forces.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "pile.hpp"
#include "support.hpp"

namespace layerloop::dem {
namespace {
using namespace test;
constexpr double pi = std::numbers::pi, radius = 12.5e-6;

/// One grain after some time in a rig without gravity.
PowderBed flight(Rig const& rig, ContactSettings const& contact, Vec3 const& from, Vec3 const& velocity, double time,
                 std::vector<ForceSample>* forces = nullptr) {
  PowderBed bed;
  bed.add(0, from, radius, 0);
  set_velocity(bed, 0, velocity);
  Simulation simulation(motion(contact, radius), rig, alone());
  simulation.scatter(bed);
  simulation.advance(static_cast<std::int64_t>(time / simulation.time_step()));
  if (forces) *forces = simulation.wall_forces();
  return simulation.gather();
}

TEST(SuperEllipse, DistanceIsThatOfTheNearestOfManyPoints) {
  double const e = 50e-6;
  for (double const n : {2.5, 4.0, 10.0}) {
    RoundedBlock block{"blade", -1e-3, 0, 0, 1e-3, e};
    block.edge_exponent = n;
    for (Vec3 const& p :
         {Vec3(12e-6, 0, -7e-6), Vec3(-20e-6, 0, -12e-6), Vec3(3e-6, 0, 20e-6), Vec3(40e-6, 0, -60e-6)}) {
      double least = 1;
      Vec3 at = p;
      constexpr int points = 400000;
      for (int k = 0; k <= points; ++k) {
        double const t = 0.5 * pi * k / points;
        Vec3 const q(-e + e * std::pow(std::cos(t), 2 / n), 0, e - e * std::pow(std::sin(t), 2 / n));
        if ((p - q).norm() < least) least = (p - q).norm(), at = q;
      }
      WallPoint const near = nearest(block, p.x(), p.z());
      EXPECT_NEAR(near.distance, least, 1e-5 * e) << n;
      EXPECT_NEAR(near.nx * near.nx + near.nz * near.nz, 1, 1e-12);
      EXPECT_NEAR((p - at).normalized().dot(Vec3(near.nx, 0, near.nz)), 1, 1e-4);
    }
  }
}

TEST(SuperEllipse, OfExponentTwoIsACircle) {
  RoundedBlock round{"blade", -1e-3, 0, 0, 1e-3, 50e-6}, almost = round;
  almost.edge_exponent = 2 + 1e-12;
  for (double const x : {-30e-6, 5e-6, 30e-6}) {
    EXPECT_NEAR(nearest(almost, x, -20e-6).distance, nearest(round, x, -20e-6).distance, 1e-15);
    EXPECT_NEAR(nearest(almost, x, -20e-6).nx, nearest(round, x, -20e-6).nx, 1e-6);
  }
}

TEST(RoundTable, DistanceOverFaceRimAndSideAndAcrossThePeriod) {
  Walls walls;
  walls.tables = {{"table", 1e-3, 0.1e-3, 0, 0.3e-3, 20e-6, 0.1e-3}};
  double const width = 2e-3, s = std::sqrt(0.5);
  auto const at = [&](double out, double turn, double z) {
    return nearest(walls, 0, width, {1e-3 + out * std::cos(turn), 0.1e-3 + out * std::sin(turn), z});
  };
  EXPECT_NEAR(at(0, 0, 15e-6).distance, 15e-6, 1e-18);
  EXPECT_NEAR(at(0.1e-3, 1, 15e-6).nz, 1, 1e-12);
  for (double const turn : {0.3, 2.0, 4.0}) {
    WallPoint const side = at(0.35e-3, turn, -50e-6), rim = at(0.28e-3 + 30e-6, turn, 10e-6);
    EXPECT_NEAR(side.distance, 50e-6, 1e-17);
    EXPECT_NEAR(side.nx, std::cos(turn), 1e-12);
    EXPECT_NEAR(side.ny, std::sin(turn), 1e-12);
    EXPECT_NEAR(rim.distance, std::hypot(30e-6, 30e-6) - 20e-6, 1e-17);
    EXPECT_NEAR(rim.nz, s, 1e-12);
    EXPECT_NEAR(std::hypot(rim.nx, rim.ny), s, 1e-12);
  }
  EXPECT_NEAR(nearest(walls, 0, width, {1e-3, 0.1e-3 - 0.35e-3 + width, -50e-6}).distance, 50e-6, 1e-15);
}

/// A roller so large that its top is a plane that moves: both change the grain in the same way.
TEST(Roller, SurfaceCarriesLikeAPlaneThatMovesThere) {
  ContactSettings const contact = plain_contact();
  double const speed = 0.05, big = 0.05;
  Rig plane = empty_space(), roller = empty_space();
  plane.walls.blocks = {floor_block()};
  plane.walls.blocks[0].motion.velocity = speed;
  roller.walls.rollers = {{"roller", 0, -big, big, speed / big}};  // its top goes towards +x
  PowderBed const a = flight(plane, contact, {0, 0, 1.01 * radius}, {0.02, 0, -0.1}, 10e-6),
                  b = flight(roller, contact, {0, 0, 1.01 * radius}, {0.02, 0, -0.1}, 10e-6);
  EXPECT_TRUE(b.contacts.empty());
  EXPECT_GT(a.vx[0], 0.021);
  EXPECT_NEAR(b.vx[0], a.vx[0], 1e-5 * speed);
  EXPECT_NEAR(b.vz[0], a.vz[0], 1e-5 * speed);
  EXPECT_NEAR(b.wy[0] * radius, a.wy[0] * radius, 1e-5 * speed);
}

/// An impact on a heavy wall that goes at V: v' = -e v + (1 + e) V, along the normal.
TEST(Vibration, AnImpactTakesTheSpeedOfTheWall) {
  ContactSettings contact = plain_contact();
  contact.time_step_fraction = 0.02;
  Rig rig = empty_space();
  rig.walls.blocks = {floor_block()};
  double const frequency = 200, amplitude = 20e-6, fastest = 2 * pi * frequency * amplitude;
  rig.walls.blocks[0].motion.amplitude = amplitude;
  rig.walls.blocks[0].motion.frequency = frequency;
  PowderBed const after = flight(rig, contact, {0, 0, 1.001 * radius}, {0, 0, -0.1}, 20e-6);
  EXPECT_GT(fastest, 0.02);
  EXPECT_NEAR(after.vz[0], 0.7 * 0.1 + 1.7 * fastest, 2e-3 * after.vz[0]);
}

TEST(Vibration, NoAmplitudeIsNoMotion) {
  Walls walls;
  walls.blocks = {floor_block()};
  walls.blocks[0].motion.frequency = 200;
  EXPECT_FALSE(MovingWalls(walls, alone()).moves(0));
  EXPECT_FALSE(MovingWalls(walls, alone()).moves(1));  // the substrate
}

TEST(Suspension, AnswersAStepOfForceLikeADampedOscillator) {
  double const mass = 2e-8, stiffness = 40, ratio = 0.1, force = 3e-5;
  double const omega = std::sqrt(stiffness / mass), damped = omega * std::sqrt(1 - ratio * ratio);
  Walls walls;
  walls.blocks = {floor_block()};
  walls.blocks[0].motion.suspension = Suspension{mass, stiffness, 2 * ratio * std::sqrt(stiffness * mass)};
  MovingWalls moving(walls, alone());
  double const dt = 2 * pi / omega / 2000;
  WallForces part(2);
  double worst = 0, highest = 0;
  for (int step = 1; step <= 8000; ++step) {
    part[0][1] = std::llround(force / wall_force_unit);
    moving.advance(step * dt, dt, {&part});
    double const t = step * dt, decay = std::exp(-ratio * omega * t);
    double const z =
        force / stiffness * (1 - decay * (std::cos(damped * t) + ratio * omega / damped * std::sin(damped * t)));
    worst = std::max(worst, std::abs(moving.poses()[0].dz - z));
    highest = std::max(highest, moving.poses()[0].dz);
  }
  EXPECT_LT(worst, 3e-3 * force / stiffness);
  EXPECT_NEAR(highest / (force / stiffness) - 1, std::exp(-pi * ratio / std::sqrt(1 - ratio * ratio)), 2e-3);
}

TEST(Suspension, SinksUnderAGrainByItsWeightOverTheStiffness) {
  ContactSettings contact = plain_contact();
  contact.cohesion_energy_density = 0;
  double const mass = mass_of(radius), gravity = 500, stiffness = mass * gravity / 0.2e-6;
  Rig rig = empty_space();
  rig.gravity = {0, 0, -gravity};
  rig.walls.blocks = {floor_block()};
  rig.walls.blocks[0].motion.suspension = Suspension{mass, stiffness, 2 * std::sqrt(stiffness * mass)};
  std::vector<ForceSample> forces;
  PowderBed const at_rest = flight(rig, contact, {0, 0, radius}, {0, 0, 0}, 1e-3, &forces);
  double const hertz = std::pow(mass * gravity / (4.0 / 3.0 * reduced_modulus(contact) * std::sqrt(radius)), 2.0 / 3.0);
  EXPECT_NEAR(at_rest.z[0], radius - hertz - 0.2e-6, 1e-3 * 0.2e-6);
  EXPECT_NEAR(forces.back().z, -mass * gravity, 1e-6 * mass * gravity);
}

/// What the wall gives to a grain is what the history of its force holds.
TEST(WallForces, HoldTheMomentumThatTheGrainGained) {
  Rig rig = empty_space();
  rig.walls.blocks = {{"blade", -1e-3, 0, -1e-3, 1e-3, 10e-6, 0.08}};
  std::vector<ForceSample> forces;
  PowderBed const after = flight(rig, plain_contact(), {1.02 * radius, 0, 0}, {0, 0.01, 0.003}, 40e-6, &forces);
  double px = 0, pz = 0, before = 0;
  for (ForceSample const& f : forces) {
    EXPECT_EQ(f.wall, 0U);
    px += f.x * (f.time - before);
    pz += f.z * (f.time - before);
    before = f.time;
  }
  EXPECT_GT(after.vx[0], 0.1);
  EXPECT_NEAR(-px / mass_of(radius), after.vx[0], 1e-9);
  EXPECT_NEAR(-pz / mass_of(radius), after.vz[0] - 0.003, 1e-9);
}

TEST(MeshWall, PushesLikeTheBlockOfItsShape) {
  Rig block = empty_space(), mesh = empty_space();
  block.walls.blocks = {{"blade", -100e-6, 0, -100e-6, 100e-6, 1e-7, 0.05}};
  mesh.walls.meshes = {{"blade", box({-100e-6, -100e-6, -100e-6}, {0, 1.1e-3, 100e-6}), {.velocity = 0.05}}};
  auto const run = [&](Rig const& rig) {
    return flight(rig, plain_contact(), {1.2 * radius, 50e-6, 0}, {-0.01, 0.02, 0.01}, 300e-6);
  };
  PowderBed const a = run(block), b = run(mesh);
  EXPECT_GT(a.vx[0], 0.05);
  EXPECT_NEAR(b.x[0], a.x[0], 1e-15);
  EXPECT_NEAR(b.vx[0], a.vx[0], 1e-10);
  EXPECT_NEAR(b.vy[0], a.vy[0], 1e-10);
  EXPECT_NEAR(b.wz[0], a.wz[0], 1e-5);
}

TEST(WallFriction, OfOneWallReplacesThatOfAll) {
  Rig rough = empty_space(), slippery = empty_space();
  rough.walls.blocks = slippery.walls.blocks = {floor_block()};
  slippery.walls.blocks[0].friction = 0.0;
  Vec3 const velocity(0.05, 0, -0.1);
  EXPECT_LT(flight(rough, plain_contact(), {0, 0, 1.01 * radius}, velocity, 20e-6).vx[0], 0.049);
  EXPECT_EQ(flight(slippery, plain_contact(), {0, 0, 1.01 * radius}, velocity, 20e-6).vx[0], 0.05);
}

/// A wall that yields takes its force from all threads: the bits stay.
TEST(Suspension, SameBitsForAnyNumberOfThreads) {
  Pile pile(900);
  WallMotion& pusher = pile.rig.walls.blocks[1].motion;
  pusher.suspension = Suspension{1e-9, 5, 1e-5};
  pusher.amplitude = 1e-6;
  pusher.frequency = 2e3;
  omp_set_num_threads(1);
  PowderBed const one = pile.run(alone(), 600);
  omp_set_num_threads(2);
  PowderBed const two = pile.run(alone(), 600);
  EXPECT_EQ(differences(one, two), 0);
}

}  // namespace
}  // namespace layerloop::dem
