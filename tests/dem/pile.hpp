#pragma once
#include <bit>
#include <cstdint>

#include "dem/dosing.hpp"
#include "support.hpp"

namespace layerloop::dem::test {

/// A column of grains that collapses sideways over floor, mesh and edge, crossing the borders of slices.
struct Pile {
  Case checked = small_case();
  Rig rig;
  PowderBed bed;

  explicit Pile(std::int64_t grains) {
    checked.machine.accumulation_length = 150e-6 + 0.2e-6 * static_cast<double>(grains);
    add_cloud(bed, checked, grains, 0);
    rig.gravity = {0, 0, -800};  // settles in thousands of steps instead of hundreds of thousands
    rig.width = checked.machine.width;
    rig.walls.blocks = {{"floor", -500e-6, 200e-6, -1e-3, -60e-6, 10e-6, 0},
                        {"pusher", -90e-6, -20e-6, -59e-6, 1e-3, 5e-6, 0.05}};
    rig.walls.substrate = box({190e-6, -200e-6, -300e-6}, {500e-6, 300e-6, -70e-6});
    rig.x_range = {-1e-3, 2e-3};
    rig.z_range = {-400e-6, 20e-3};
  }

  PowderBed run(Communicator const& communicator, std::int64_t steps, std::int64_t stop_after = 0) const {
    Simulation simulation(motion_of(checked), rig, communicator);
    simulation.scatter(bed);
    if (stop_after > 0) {
      simulation.advance(stop_after);
      PowderBed const half_way = simulation.gather();
      Rig shifted = rig;  // the clock starts at 0 again
      Simulation second(motion_of(checked), shifted, communicator);
      second.scatter(half_way);
      second.advance(steps - stop_after);
      return second.gather();
    }
    simulation.advance(steps);
    return simulation.gather();
  }
};

/// Makes the pile one of two materials that are unlike in everything.
inline void mix(Pile& pile) {
  Case& c = pile.checked;
  c.material.name = "light";
  c.admixtures = {c.material};
  c.admixtures[0].name = "heavy";
  c.admixtures[0].density *= 3;
  c.powder.mixture = {{"light", 0.4}, {"heavy", 0.6}};
  c.bodies["heavy"].youngs_modulus = 0.5e9;
  c.bodies[walls_name].youngs_modulus = 2e9;
  c.pairs[{"heavy", "light"}].sliding_friction = 0.3;
  c.pairs[{"heavy", walls_name}].restitution = 0.5;
  for (std::size_t i = 0; i < pile.bed.size(); ++i) pile.bed.material[i] = draw_material(c, pile.bed.id[i]);
}

/// Number of values whose bits differ.
inline std::int64_t differences(PowderBed const& a, PowderBed const& b) {
  if (a.id != b.id || a.contacts.size() != b.contacts.size()) return 1 << 20;
  std::int64_t count = 0;
  auto const compare = [&](double p, double q) {
    count += std::bit_cast<std::uint64_t>(p) != std::bit_cast<std::uint64_t>(q);
  };
  for (auto const member : {&PowderBed::x, &PowderBed::y, &PowderBed::z, &PowderBed::vx, &PowderBed::vy, &PowderBed::vz,
                            &PowderBed::wx, &PowderBed::wy, &PowderBed::wz, &PowderBed::radius})
    for (std::size_t i = 0; i < a.size(); ++i) compare((a.*member)[i], (b.*member)[i]);
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    count += a.contacts[k].key_a != b.contacts[k].key_a || a.contacts[k].key_b != b.contacts[k].key_b;
    for (std::size_t d = 0; d < 3; ++d) compare(a.contacts[k].spring[d], b.contacts[k].spring[d]);
  }
  return count;
}

}  // namespace layerloop::dem::test
