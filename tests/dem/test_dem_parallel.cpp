// Bit for bit the same on 1, 2 and 4 ranks. Run with 4 ranks.
#include <gtest/gtest.h>
#include <omp.h>

#include "core/error.hpp"
#include "pile.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

/// Ranks [0, count) of the run; the others get a communicator of their own and do the same work for themselves.
Communicator first_ranks(int count) {
  Communicator const world;
  MPI_Comm part;
  MPI_Comm_split(world.handle(), world.rank() < count ? 0 : 1 + world.rank(), world.rank(), &part);
  return Communicator(part);
}

TEST(Bits, DoNotDependOnRanks) {
  omp_set_num_threads(1);
  Pile const pile(160);
  PowderBed const single = pile.run(alone(), 35000);
  EXPECT_GT(single.contacts.size(), 60U);
  for (int ranks : {2, 4}) {
    PowderBed const shared = pile.run(first_ranks(ranks), 35000);
    EXPECT_EQ(differences(single, shared), 0) << ranks << " ranks";
  }
}

TEST(Guards, ThrowTheSameOnEveryRank) {
  Pile pile(200);
  pile.rig.z_range[0] = -55e-6;  // above the floor
  std::string message;
  try {
    pile.run(Communicator(), 35000);
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
