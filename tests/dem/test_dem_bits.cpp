// Bit for bit the same on 1 and 2 threads, and after a stop and a fresh start from the gathered bed.
#include <gtest/gtest.h>
#include <omp.h>

#include "pile.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

TEST(Bits, DoNotDependOnThreads) {
  Pile const pile(900);
  omp_set_num_threads(1);
  PowderBed const one = pile.run(alone(), 12000);
  omp_set_num_threads(2);
  PowderBed const two = pile.run(alone(), 12000);
  omp_set_num_threads(1);
  EXPECT_GT(one.contacts.size(), 20U);
  EXPECT_EQ(differences(one, two), 0);
}

TEST(Bits, DoNotDependOnThreadsOrAStopInAMixture) {
  Pile pile(900);
  mix(pile);
  pile.rig.walls.blocks[1].motion.velocity = 0;
  omp_set_num_threads(1);
  PowderBed const one = pile.run(alone(), 12000);
  omp_set_num_threads(2);
  PowderBed const two = pile.run(alone(), 12000, 5917);
  omp_set_num_threads(1);
  EXPECT_GT(one.contacts.size(), 20U);
  EXPECT_EQ(differences(one, two), 0);
}

TEST(Bits, DoNotDependOnAStopInBetween) {
  omp_set_num_threads(1);
  Pile pile(160);
  pile.rig.walls.blocks[1].motion.velocity = 0;
  PowderBed const through = pile.run(alone(), 26000);
  EXPECT_GT(through.contacts.size(), 60U);
  EXPECT_EQ(differences(through, pile.run(alone(), 26000, 11617)), 0);
}

}  // namespace
}  // namespace layerloop::dem
