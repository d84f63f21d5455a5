#include <mpi.h>

#include <cstdio>

#include "scenes.hpp"

// Run by mpirun: rays shared among the ranks give the bits of one rank that traces all of them.
namespace layerloop::raytrace {
namespace {

bool same(Absorption const& a, Absorption const& b) {
  bool same = a.grain_share == b.grain_share && a.map.values == b.map.values &&
              a.map_error.values == b.map_error.values && a.cell == b.cell && a.cell_share == b.cell_share &&
              a.rays == b.rays;
  for (std::size_t k = 0; k < a.sets.size(); ++k) {
    same = same && a.sets[k].absorptivity == b.sets[k].absorptivity &&
           a.sets[k].standard_error == b.sets[k].standard_error && a.sets[k].d_n == b.sets[k].d_n &&
           a.sets[k].residual == b.sets[k].residual;
  }
  for (std::size_t l = 0; l < a.depth_profile.size(); ++l) {
    same = same && a.depth_profile[l].fraction == b.depth_profile[l].fraction;
  }
  return same;
}

int run() {
  Communicator const ranks;
  Lattice const lattice = hexagonal_layers(2);
  BedScene const scene(lattice.bed, flat_floor(-3, 4, -3, 5, 0), lattice.period);
  std::array const sets{bare(stainless_steel), bare(silver)};
  AbsorptionSettings const settings{.rays = 3000,
                                    .diffuse_share = 0.1,
                                    .target_standard_error = 1.5e-3,
                                    .derivatives = true,
                                    .grid = VoxelGrid{{0, 0, -0.2}, 0.2, {5, 9, 12}},
                                    .map_spacing = 0.2};
  Absorption const shared = absorb(scene, uniform_light(lattice.period), sets, 0, settings, &ranks);
  Absorption const alone = absorb(scene, uniform_light(lattice.period), sets, 0, settings);
  bool const differs = ranks.any(!same(shared, alone));
  if (ranks.is_root()) std::printf("%d ranks: %s\n", ranks.size(), differs ? "FAILED, bits differ" : "same bits");
  return differs ? 1 : 0;
}

}  // namespace
}  // namespace layerloop::raytrace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int const failed = layerloop::raytrace::run();
  MPI_Finalize();
  return failed;
}
