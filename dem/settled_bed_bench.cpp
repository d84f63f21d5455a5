#include "dem/settled_bed_bench.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "core/error.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem {
namespace {

Rig floor_under(BedFile const& file) {
  if (!file.floor_z) throw InputError("the bed has no floor (grains would fall) give floor_z in its first line");
  constexpr double far = 1;  // [m]
  Rig rig;
  rig.walls.blocks.push_back({"the floor", -far, far, *file.floor_z - far, *file.floor_z, 0});
  if (file.periodic_x) rig.length = *file.periodic_x;
  if (file.periodic_y)
    rig.width = *file.periodic_y;
  else  // wide enough that nothing meets its image
    rig.width = 2 * far;
  rig.x_range = rig.z_range = {-far, far};
  return rig;
}
}  // namespace

ContactSettings thesis_contact() {
  ContactSettings contact;
  contact.youngs_modulus = 0.2e9;
  contact.poisson_ratio = 0.3;
  contact.restitution = 0.7;
  contact.sliding_friction = contact.wall_friction = 0.7;
  contact.rolling_friction = 0.15;
  contact.cohesion = Cohesion::sjkr2;
  contact.cohesion_energy_density = 9e4;
  contact.time_step_fraction = 0.149;
  return contact;
}

SettledBedBench bench_settled_bed(BedFile file, std::int64_t steps, Communicator const& communicator) {
  ContactSettings const contact = thesis_contact();
  constexpr double density = 9187, time_step = 3.592e-8;
  constexpr std::int64_t warm_up = 100;
  Simulation simulation({grain_law(contact), wall_law(contact), contact, file.density.value_or(density), time_step},
                        floor_under(file), communicator);
  simulation.scatter(file.bed);
  file.bed = {};  // its grains are in the simulation: the memory that is reported is that of the kernel
  simulation.advance(warm_up);
  PhaseTimes const before = simulation.phases();
  auto const begin = std::chrono::steady_clock::now();
  simulation.advance(steps);
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  SettledBedBench result{.particles = simulation.grains(),
                         .contacts = simulation.touching_pairs(),
                         .steps = steps,
                         .rebuilds = simulation.rebuilds(),
                         .seconds = communicator.max(seconds),
                         .imbalance = 1,
                         .phases = {}};
  double const work = simulation.phases().work() - before.work();
  result.imbalance = communicator.max(work) * communicator.size() / communicator.sum(work);
  auto const then = before.by_name();
  for (auto const& [phase, spent] : simulation.phases().by_name())
    result.phases[phase] = communicator.sum(spent - then.at(phase)) / communicator.size();
  return result;
}

}  // namespace layerloop::dem
