// Angle of repose and slipping angle: the measurements on made-up beds whose angle is known, the tests on cases that
// have a closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/repose_pile.hpp"
#include "dem/tilting_plate.hpp"
#include "support.hpp"

namespace layerloop::dem {
namespace {
using namespace test;
constexpr double degree = std::numbers::pi / 180;

/// Small grains that fill a cone of this slope on a base.
PowderBed cone(double base_radius, double slope, double grain) {
  PowderBed bed;
  std::int64_t id = 0;
  int const n = static_cast<int>(base_radius / grain);
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      double const x = i * grain, y = j * grain, r = std::hypot(x, y), top = (base_radius - r) * std::tan(slope);
      if (r < base_radius && top > grain) bed.add(id++, {x, y, top - grain}, grain, 0);
    }
  }
  return bed;
}

TEST(Pile, SlopeOfACone) {
  double const base = 200e-6, grain = 2e-6;
  for (double const slope : {10.0, 28.7, 40.0}) {
    ReposePile const pile = measure_pile(cone(base, slope * degree, grain), 2 * base, 0, 0, 10e-6);
    ASSERT_EQ(pile.profiles.size(), 8u);
    EXPECT_NEAR(pile.angle_of_repose / degree, slope, 0.5) << slope;
    EXPECT_LT(pile.angle_of_repose_u / degree, 0.5) << slope;
    EXPECT_NEAR(pile.angle_from_height / degree, slope, 1.0) << slope;
  }
}

TEST(Pile, BareBaseIsFlat) {
  PowderBed bed;
  bed.add(0, {1e-3, 0, 0}, 1e-6, 0);
  EXPECT_EQ(measure_pile(bed, 400e-6, 0, 0, 10e-6).angle_of_repose, 0);
}

/// Rate of 1 degree a millisecond; the layer slides as a block of this friction angle.
TiltingPlate sliding_block(double friction_angle) {
  TiltingPlate plate{};
  double const dt = 1e-5, rate = 1000 * degree;
  double speed = 0, way = 0;
  for (double time = 0; time < 0.06; time += dt) {
    double const tilt = rate * time;
    if (tilt > friction_angle) speed += dt * 9.81 * (std::sin(tilt) - std::tan(friction_angle) * std::cos(tilt));
    way += speed * dt;
    plate.record.push_back({time, tilt, speed, way});
  }
  return plate;
}

TEST(Slip, FrictionOfASlidingBlock) {
  for (double const angle : {20.0, 34.0}) {
    TiltingPlate plate = sliding_block(angle * degree);
    find_slip(plate, 9.81, 25e-6);
    EXPECT_NEAR(plate.slipping_angle / degree, angle, 0.05);
    EXPECT_LT(plate.slipping_angle_u / degree, 0.1);
    EXPECT_GT(plate.tilt_at_one_diameter / degree, angle + 1);
  }
}

TEST(Slip, LayerThatSticksHasNoAngle) {
  TiltingPlate plate = sliding_block(80 * degree);
  find_slip(plate, 9.81, 25e-6);
  EXPECT_TRUE(std::isnan(plate.slipping_angle));
  EXPECT_TRUE(std::isnan(plate.tilt_at_one_diameter));
}

Case calibration_case() {
  Case c = small_case();
  c.run.grains_sleep = true;  // as cases have it: neither test may let a grain sleep
  CalibrateSettings& k = c.calibrate;
  k.base_diameter = 250e-6;
  k.pile_particles = 200;
  k.batches = 1;
  k.cloud_width = 0.85;
  k.cloud_density = 0.16;
  k.fall_speed = 0.1;
  k.settling_time = 3e-3;
  k.plate_length = 150e-6;
  k.plate_particles = 8;
  k.tilt_rate = 3000 * degree;
  k.tilt_from = 5 * degree;
  k.tilt_to = 60 * degree;
  return c;
}

TEST(Slip, GrainsThatCannotRollSlideAtTheFrictionOfThePlate) {
  Case c = calibration_case();
  c.contact.cohesion = Cohesion::none;
  c.contact.rolling_friction = 5;
  c.contact.restitution = 0.1;  // at rest within milliseconds
  c.calibrate.fall_speed = 0.01;
  for (double const friction : {0.2, 0.4}) {
    c.contact.wall_friction = friction;
    TiltingPlate const plate = tilting_plate(c, motion_of(c), alone(), false);
    EXPECT_NEAR(plate.slipping_angle, std::atan(friction), 1 * degree) << friction;
  }
}

TEST(Pile, GrainsThatDoNotFitRunOverTheEdge) {
  Case c = calibration_case();
  ReposePile const pile = repose_pile(c, motion_of(c), alone(), false);
  EXPECT_EQ(pile.grains_fed, 200);
  EXPECT_LT(pile.grains_on_base, 200);
  EXPECT_GT(pile.grains_on_base, 50);
  EXPECT_GT(pile.angle_of_repose / degree, 5);
  for (std::size_t i = 0; i < pile.bed.size(); ++i) EXPECT_GT(pile.bed.z[i], -83e-6);
  Case slippery = c;
  slippery.contact.sliding_friction = slippery.contact.wall_friction = slippery.contact.rolling_friction = 0;
  slippery.contact.cohesion = Cohesion::none;
  ReposePile const flat = repose_pile(slippery, motion_of(slippery), alone(), false);
  EXPECT_LT(flat.grains_on_base, pile.grains_on_base);
}

}  // namespace
}  // namespace layerloop::dem
