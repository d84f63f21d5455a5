// Grains that lie still sleep, wake when something comes, and lie where they would lie awake. A period along x.
#include <gtest/gtest.h>
#include <omp.h>

#include "pile.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

/// Grains on a floor that repeats along x and y.
struct Layer {
  ContactSettings contact = plain_contact();
  Rig rig;
  PowderBed bed;
  Motion motion;

  Layer() : motion(test::motion(contact, 10e-6)) {
    rig.walls.blocks = {floor_block()};
    rig.width = rig.length = 120e-6;
    for (std::int64_t k = 0; k < 36; ++k) {
      double const x = 20e-6 * static_cast<double>(k % 6), y = 20e-6 * static_cast<double>(k / 6);
      bed.add(k, {x, y, 10e-6}, 10e-6 - 1e-9, 0);
    }
    motion.grains_sleep = true;
  }
};

TEST(Sleep, GrainsAtRestFallAsleepAndStay) {
  Layer layer;
  Simulation simulation(layer.motion, layer.rig, alone());
  simulation.scatter(layer.bed);
  simulation.advance(20000);
  EXPECT_EQ(simulation.sleeping(), 36);
  PowderBed const early = simulation.gather();
  simulation.advance(5000);
  EXPECT_EQ(differences(early, simulation.gather()), 0) << "they do not move, and keep their springs";
}

TEST(Sleep, AFallingGrainWakesWhatItHits) {
  Layer layer;
  layer.bed.add(100, {50e-6, 50e-6, 60e-6}, 10e-6, 0);
  Simulation simulation(layer.motion, layer.rig, alone());
  Layer awake = layer;
  awake.motion.grains_sleep = false;
  Simulation reference(awake.motion, awake.rig, alone());
  simulation.scatter(layer.bed);
  reference.scatter(layer.bed);
  bool slept = false;
  std::int64_t least = 1000;
  for (int k = 0; k < 120; ++k) {
    simulation.advance(1000);
    reference.advance(1000);
    slept |= simulation.sleeping() >= 36;
    if (slept) least = std::min(least, simulation.sleeping());
  }
  EXPECT_TRUE(slept) << "the layer sleeps before the grain arrives";
  EXPECT_LT(least, 36) << "and some of it wakes then";
  PowderBed const a = simulation.gather(), b = reference.gather();
  EXPECT_NEAR(a.z.back(), b.z.back(), 0.3e-6) << "it lies in the same hollow";
}

TEST(Sleep, DoesNotDependOnThreads) {
  Pile pile(500);
  auto const run = [&](int threads) {
    omp_set_num_threads(threads);
    Motion motion = motion_of(pile.checked);
    motion.grains_sleep = true;
    Simulation simulation(motion, pile.rig, alone());
    simulation.scatter(pile.bed);
    simulation.advance(15000);
    return simulation.gather();
  };
  PowderBed const one = run(1), two = run(2);
  omp_set_num_threads(1);
  EXPECT_EQ(differences(one, two), 0);
}

TEST(Period, GrainsCollideAcrossTheSeam) {
  Rig rig = empty_space();
  rig.length = 200e-6;
  auto const after = [&](double shift, double length) {
    rig.length = length;
    Simulation simulation(motion(plain_contact(), 12.5e-6), rig, alone());
    PowderBed bed;
    bed.add(1, {std::fmod(shift, length), 50e-6, 0}, 12.5e-6, 0);
    bed.add(2, {std::fmod(shift + 25.5e-6, length), 50e-6, 0}, 12.5e-6, 0);
    bed.vx = {0.1, -0.1};
    simulation.scatter(bed);
    simulation.advance(400);
    return simulation.gather();
  };
  PowderBed const open = after(50e-6, 200e-6), seam = after(187e-6, 200e-6);
  EXPECT_LT(open.vx[0], -0.05) << "they have bounced";
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(seam.vx[i], open.vx[i], 1e-9);
  EXPECT_NEAR(std::remainder(seam.x[0] - open.x[0] - 137e-6, 200e-6), 0, 1e-15);
}

}  // namespace
}  // namespace layerloop::dem
