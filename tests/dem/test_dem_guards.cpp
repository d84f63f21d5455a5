// What must stop a run stops it, soon, and says where and what to do.
#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"
#include "dem/dosing.hpp"
#include "dem/machine_rig.hpp"
#include "dem/recoater.hpp"
#include "support.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

std::string message_of(auto const& action) {
  try {
    action();
  } catch (PhysicsError const& error) {
    return error.what();
  }
  return {};
}

/// A feed that falls into the pit.
Simulation falling_feed(Case const& c) {
  PowderBed bed;
  add_cloud(bed, c, c.powder.particles, 0);
  Simulation simulation(motion_of(c), machine_rig(c, plate_of(c), bed, Tools::parked_and_gate), alone());
  simulation.scatter(bed);
  return simulation;
}

TEST(Guards, StepOfOneToFiveRayleighTimesIsCaughtWithinFiftySteps) {
  for (double fraction : {1.0, 1.1, 2.0, 5.0}) {
    Case c = small_case();
    c.contact.time_step_fraction = fraction;
    Simulation simulation = falling_feed(c);
    std::string const message = message_of([&] { simulation.advance(50); });
    EXPECT_NE(message.find("time_step_fraction"), std::string::npos) << fraction << message;
  }
}

TEST(Guards, ProductionStepRuns) {
  Simulation simulation = falling_feed(small_case());
  EXPECT_NO_THROW(simulation.advance(3000));
  EXPECT_LT(simulation.largest_overlap(), 0.02);
}

PowderBed one_grain(Vec3 const& velocity) {
  PowderBed bed;
  bed.add(42, {0, 50e-6, 50e-6}, 10e-6, 0);
  set_velocity(bed, 0, velocity);
  return bed;
}

TEST(Guards, LostGrainIsNamed) {
  Rig rig = empty_space();
  rig.z_range = {0, 1e-3};
  Simulation simulation(motion(plain_contact(), 10e-6), rig, alone());
  simulation.scatter(one_grain({0, 0, -0.2}));
  std::string const message = message_of([&] { simulation.advance(20000); });
  EXPECT_NE(message.find("grain 42 left the machine"), std::string::npos) << message;
}

TEST(Guards, GrainsOverTheSinkAreCountedInsteadOfLost) {
  Rig rig = empty_space();
  rig.x_range = {-1e-3, 300e-6};
  rig.sink_x = 100e-6;
  PowderBed bed = one_grain({0.2, 0, 0});
  bed.add(43, {0, 50e-6, 200e-6}, 10e-6, 0);
  Simulation simulation(motion(plain_contact(), 10e-6), rig, alone());
  simulation.scatter(bed);
  simulation.advance(30000);
  EXPECT_EQ(simulation.grains(), 1);
  EXPECT_EQ(simulation.gather().id, std::vector<std::int64_t>{43});
}

TEST(Guards, ValueThatIsNotFinite) {
  Simulation simulation(motion(plain_contact(), 10e-6), empty_space(), alone());
  std::string const message = message_of([&] {
    simulation.scatter(one_grain({0, std::numeric_limits<double>::quiet_NaN(), 0}));
  });
  EXPECT_NE(message.find("not finite"), std::string::npos) << message;
}

TEST(Guards, DeepOverlapNamesBothGrains) {
  PowderBed bed;
  bed.add(1, {0, 50e-6, 0}, 10e-6, 0);
  bed.add(2, {18.5e-6, 50e-6, 0}, 10e-6, 0);  // 7.5 % of the diameter
  Simulation simulation(motion(plain_contact(), 10e-6), empty_space(), alone());
  std::string const message = message_of([&] { simulation.scatter(bed); });
  EXPECT_NE(message.find("grain 1 overlaps grain 2 by"), std::string::npos) << message;
}

TEST(Guards, OverlapThatGrowsIsCaught) {
  ContactSettings contact = plain_contact();
  contact.youngs_modulus = 2e5;  // so soft that a fast impact goes deep
  PowderBed bed;
  bed.add(1, {0, 50e-6, 0}, 10e-6, 0);
  bed.add(2, {20.1e-6, 50e-6, 0}, 10e-6, 0);
  bed.vx = {0.15, -0.15};
  Simulation simulation(motion(contact, 10e-6), empty_space(), alone());
  simulation.scatter(bed);
  std::string const message = message_of([&] { simulation.advance(100); });
  EXPECT_NE(message.find("grain 1 overlaps grain 2 by"), std::string::npos) << message;
}

TEST(Guards, GrainThatIsBehindAMeshFaceIsNotAccepted) {
  Rig rig = empty_space();
  rig.walls.substrate = box({-100e-6, -50e-6, -50e-6}, {100e-6, 150e-6, 0});
  PowderBed bed;
  bed.add(7, {0, 40e-6, -3e-6}, 10e-6, 0);
  Simulation simulation(motion(plain_contact(), 10e-6), rig, alone());
  std::string const message = message_of([&] { simulation.scatter(bed); });
  EXPECT_NE(message.find("grain 7 overlaps the substrate"), std::string::npos) << message;
}

TEST(Guards, NarrowBedIsBadInput) {
  Rig rig = empty_space();
  rig.width = 39e-6;
  Simulation simulation(motion(plain_contact(), 10e-6), rig, alone());
  EXPECT_THROW(simulation.scatter(one_grain(Vec3::Zero())), InputError);
}

TEST(Guards, RigidBladeStopsAtRaisedSolid) {
  Case c = small_case();
  TriangleSurface plate = plate_of(c);
  plate.vertices[4].z() = 4e-6;
  PowderBed bed;
  bed.add(0, {50e-6, 50e-6, -30e-6}, 10e-6, 0);
  std::string const message = message_of([&] { spread(bed, c, plate, alone(), false); });
  EXPECT_NE(message.find("4.00 um above the blade"), std::string::npos) << message;
  EXPECT_NE(message.find("blade_collision"), std::string::npos) << message;
}

}  // namespace
}  // namespace layerloop::dem
