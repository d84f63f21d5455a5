// The same grains, the same law, the same steps in LIGGGHTS. Without damping the two integrate alike, and grains must
// follow the same path; with it this program corrects the damping of a leapfrog by a share of first order in the step,
// and the paths must meet as the step gets shorter.
#include <gtest/gtest.h>

#include "dem/dosing.hpp"
#include "liggghts.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

class AgainstLiggghts : public testing::Test {
 protected:
  void SetUp() override {
    if (!Liggghts::is_installed()) GTEST_SKIP() << "liggghts is not installed (apt-get install liggghts)";
  }
};

/// The thesis' law but for damping.
ContactSettings full_contact(double restitution) {
  ContactSettings contact = plain_contact();
  contact.cohesion = Cohesion::sjkr2;
  contact.rolling_friction = 0.15;
  contact.restitution = restitution;
  return contact;
}

Liggghts oblique_pair(double restitution, double step) {
  Liggghts run{.contact = full_contact(restitution)};
  run.bed.add(0, {-21e-6, 40e-6, 100e-6}, 21e-6, 0);
  run.bed.add(1, {6.6e-6, 46e-6, 107e-6}, 6.5e-6, 0);
  set_velocity(run.bed, 0, {0.08, 0.01, 0.02});
  set_velocity(run.bed, 1, {-0.09, 0.03, -0.01});
  run.bed.wx = {300, -2000};
  run.bed.wy = {-800, 900};
  run.bed.wz = {500, 4000};
  run.time_step = step * rayleigh_time(6.5e-6, density, run.contact);
  run.steps = static_cast<std::int64_t>(2.4e-5 / run.time_step);
  run.steps_a_frame = run.steps;
  return run;
}

/// Over the way that the smaller grain goes.
double relative_difference(Liggghts const& run) {
  PowderBed const there = run.run().back(), here = run_here(run).back();
  EXPECT_NE(here.wx[0], run.bed.wx[0]);  // they did touch
  return largest_distance(there, here, run.width) / (here.position(1) - run.bed.position(1)).norm();
}

TEST_F(AgainstLiggghts, ObliqueCollisionOfTwoGrains) { EXPECT_LT(relative_difference(oblique_pair(1, 0.149)), 1e-9); }

TEST_F(AgainstLiggghts, DampedCollisionAgreesToFirstOrderInTheStep) {
  double const coarse = relative_difference(oblique_pair(0.7, 0.04)),
               fine = relative_difference(oblique_pair(0.7, 0.01));
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.6);
}

TEST_F(AgainstLiggghts, GrainOnACohesiveFloorSticksSlidesAndRolls) {
  Liggghts run{.contact = full_contact(1), .floor = true, .gravity = standard_gravity};
  run.bed.add(0, {0, 40e-6, 12.5e-6 + 1e-10}, 12.5e-6, 0);
  set_velocity(run.bed, 0, {0.021, 0.004, 0});
  run.bed.wy = {200};
  run.time_step = 0.149 * rayleigh_time(12.5e-6, density, run.contact);
  run.steps = 20000;
  run.steps_a_frame = 1000;
  std::vector<PowderBed> const there = run.run(), here = run_here(run);
  ASSERT_EQ(there.size(), here.size());
  double const way = (here.back().position(0) - run.bed.position(0)).norm();
  EXPECT_GT(way, 12.5e-6);
  for (std::size_t k = 1; k < here.size(); ++k)
    EXPECT_LT(largest_distance(there[k], here[k], run.width), 1e-6 * way) << k;
}

TEST_F(AgainstLiggghts, TwoHundredGrainsThatArePoured) {
  Case c = small_case();
  Liggghts run{.contact = full_contact(1), .width = c.machine.width, .floor = true, .gravity = standard_gravity};
  c.machine.accumulation_depth = 0;
  add_cloud(run.bed, c, 200, 0);
  run.time_step = 0.149 * rayleigh_time(6.5e-6, density, run.contact);
  run.steps = 9000;  // later a grain that rattles between others parts two paths that differ in the last bit
  run.steps_a_frame = 1000;
  std::vector<PowderBed> const there = run.run(), here = run_here(run);
  ASSERT_EQ(there.size(), here.size());
  std::int64_t touched = 0;
  for (std::size_t i = 0; i < 200; ++i) touched += here.back().wx[i] != 0;
  EXPECT_GT(touched, 50);
  for (std::size_t k = 1; k < here.size(); ++k)
    EXPECT_LT(largest_distance(there[k], here[k], run.width), 1e-7 * 6.5e-6) << k;
}

}  // namespace
}  // namespace layerloop::dem
