// Bit for bit the same on 1, 2 and 4 ranks. Run with 4 ranks.
#include <gtest/gtest.h>
#include <omp.h>

#include "core/error.hpp"
#include "pile.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

/// The pile as the first `count` ranks compute it together; empty on the others.
PowderBed on_ranks(int count, Pile const& pile, std::int64_t steps) {
  Communicator const world;
  bool const takes_part = world.rank() < count;
  MPI_Comm part;
  MPI_Comm_split(world.handle(), takes_part ? 0 : MPI_UNDEFINED, world.rank(), &part);
  PowderBed bed;
  if (takes_part) {
    bed = pile.run(Communicator(part), steps);
    MPI_Comm_free(&part);
  }
  world.barrier();
  return bed;
}

TEST(Bits, DoNotDependOnRanks) {
  omp_set_num_threads(1);
  constexpr std::int64_t steps = 4000;
  Pile pile(160);
  pile.bed = pile.run(alone(), 24000);  // in contact and on the move
  pile.rig.walls.blocks[1].x0 += 40e-6;
  pile.rig.walls.blocks[1].x1 += 40e-6;
  PowderBed const single = on_ranks(1, pile, steps), two = on_ranks(2, pile, steps), four = on_ranks(4, pile, steps);
  int const rank = Communicator().rank();
  if (rank == 0) {
    EXPECT_GT(single.contacts.size(), 60U);
    EXPECT_EQ(differences(single, two), 0);
    EXPECT_EQ(differences(single, four), 0);
  }
  if (rank == 1) {
    EXPECT_EQ(differences(two, four), 0);  // every rank gathers the same bed
  }
}

TEST(Bits, DoNotDependOnRanksWhenGrainsSleep) {
  omp_set_num_threads(1);
  Pile pile(160);
  pile.rig.gravity = {0, 0, -9.81};
  pile.bed = {};
  for (std::int64_t k = 0; k < 40; ++k)  // lie in a row on the floor, and one falls on them
    pile.bed.add(k, {-10e-6 + 5e-6 * static_cast<double>(k), 2.5e-6 + 25e-6 * static_cast<double>(k % 4), -50.001e-6},
                 10e-6 - 1e-9, 0);
  pile.bed.add(99, {60e-6, 50e-6, -10e-6}, 14e-6, 0);
  pile.rig.walls.blocks[1].motion.velocity = 0;
  constexpr std::int64_t steps = 12000;
  PowderBed const awake = on_ranks(1, pile, steps);
  pile.checked.run.grains_sleep = true;
  PowderBed const single = on_ranks(1, pile, steps), four = on_ranks(4, pile, steps);
  if (Communicator().rank() == 0) {
    EXPECT_EQ(differences(single, four), 0);
    EXPECT_GT(differences(single, awake), 0);  // some did sleep
  }
}

TEST(Bits, DoNotDependOnRanksWhenAWallYields) {
  omp_set_num_threads(1);
  Pile pile(160);
  pile.bed = pile.run(alone(), 24000);
  pile.rig.walls.blocks[1].x0 += 40e-6;
  pile.rig.walls.blocks[1].x1 += 40e-6;
  WallMotion& pusher = pile.rig.walls.blocks[1].motion;
  pusher.suspension = Suspension{1e-9, 5, 1e-5};
  pusher.amplitude = 1e-6;
  pusher.frequency = 2e3;
  PowderBed const single = on_ranks(1, pile, 1500), four = on_ranks(4, pile, 1500);
  if (Communicator().rank() == 0) {
    EXPECT_EQ(differences(single, four), 0);
    pusher.suspension.reset();
    EXPECT_GT(differences(single, pile.run(alone(), 1500)), 0);  // it did yield
  }
}

TEST(Bits, DoNotDependOnRanksInAMixture) {
  omp_set_num_threads(1);
  Pile pile(160);
  mix(pile);
  pile.bed = pile.run(alone(), 24000);
  PowderBed const single = on_ranks(1, pile, 1500), two = on_ranks(2, pile, 1500), four = on_ranks(4, pile, 1500);
  if (Communicator().rank() != 0) return;
  EXPECT_GT(single.contacts.size(), 60U);
  EXPECT_EQ(differences(single, two), 0);
  EXPECT_EQ(differences(single, four), 0);
}

/// The ledger of energy as the first `count` ranks keep it; empty on the others.
EnergyLedger energy_on_ranks(int count, Motion motion, Rig const& rig, PowderBed const& bed, std::int64_t steps) {
  motion.keeps_energy_ledger = true;
  Communicator const world;
  bool const takes_part = world.rank() < count;
  MPI_Comm part;
  MPI_Comm_split(world.handle(), takes_part ? 0 : MPI_UNDEFINED, world.rank(), &part);
  EnergyLedger energy;
  if (takes_part) {
    Simulation simulation(motion, rig, Communicator(part));
    simulation.scatter(bed);
    simulation.advance(steps);
    energy = simulation.energy();
    MPI_Comm_free(&part);
  }
  world.barrier();
  return energy;
}

void expect_same(EnergyLedger const& a, EnergyLedger const& b) {
  EXPECT_EQ(a.kinetic, b.kinetic);
  EXPECT_EQ(a.potential, b.potential);
  EXPECT_EQ(a.elastic, b.elastic);
  EXPECT_EQ(a.dissipated_normal, b.dissipated_normal);
  EXPECT_EQ(a.dissipated_tangential, b.dissipated_tangential);
  EXPECT_EQ(a.dissipated_rolling, b.dissipated_rolling);
  EXPECT_EQ(a.dissipated_sleep, b.dissipated_sleep);
  EXPECT_EQ(a.wall_work, b.wall_work);
  EXPECT_EQ(a.carried_out, b.carried_out);
  EXPECT_EQ(a.residual, b.residual);
}

TEST(Energy, DoesNotDependOnRanks) {
  omp_set_num_threads(1);
  Pile pile(160);
  pile.bed = pile.run(alone(), 24000);
  pile.rig.walls.blocks[1].x0 += 40e-6;
  pile.rig.walls.blocks[1].x1 += 40e-6;
  pile.rig.sink_x = 215e-6;
  auto const on = [&](int ranks) { return energy_on_ranks(ranks, motion_of(pile.checked), pile.rig, pile.bed, 6000); };
  EnergyLedger const single = on(1), two = on(2), four = on(4);
  if (Communicator().rank() > 0) return;
  EXPECT_GT(single.wall_work, 0);
  EXPECT_NE(single.carried_out, 0);
  EXPECT_LT(single.relative_error(), 1e-3);
  expect_same(single, two);
  expect_same(single, four);
}

TEST(Energy, DoesNotDependOnRanksWhereGrainsSleep) {
  omp_set_num_threads(1);
  Rig rig;
  rig.walls.blocks = {floor_block()};
  rig.width = rig.length = 120e-6;
  PowderBed bed;
  for (std::int64_t k = 0; k < 36; ++k)
    bed.add(k, {20e-6 * static_cast<double>(k % 6), 20e-6 * static_cast<double>(k / 6), 10e-6}, 10e-6 - 1e-9, 0);
  bed.add(100, {50e-6, 50e-6, 60e-6}, 10e-6, 0);  // falls on them and wakes some
  Motion motion = test::motion(plain_contact(), 10e-6);
  motion.grains_sleep = true;
  auto const on = [&](int ranks) { return energy_on_ranks(ranks, motion, rig, bed, 120000); };
  EnergyLedger const single = on(1), two = on(2), four = on(4);
  if (Communicator().rank() > 0) return;
  EXPECT_NE(single.dissipated_sleep, 0);
  EXPECT_LT(single.relative_error(), 1e-3);
  expect_same(single, two);
  expect_same(single, four);
}

TEST(Guards, ThrowTheSameOnEveryRank) {
  Pile pile(200);
  pile.rig.z_range[0] = -55e-6;  // above the floor
  std::string message;
  try {
    pile.run(Communicator(), 20000);
  } catch (PhysicsError const& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("left the machine"), std::string::npos);
  std::string first = message;
  Communicator().broadcast(first);
  EXPECT_EQ(message, first);
}

}  // namespace
}  // namespace layerloop::dem
