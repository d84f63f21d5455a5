#include <gtest/gtest.h>

#include <algorithm>

#include "scenes.hpp"

// Is the reported error honest? Over many seeds the 95 % interval must hold the long-run value in 90 to 99 % of them.
namespace layerloop::raytrace {
namespace {

constexpr int seeds = 200;

struct Held {
  int total = 0;      ///< of `seeds`: the absorptivity
  double pixels = 0;  ///< share of all well lit pixels of all seeds
};

/// \param fixed  settings of the short runs
Held count_held(BedScene const& scene, Beam const& beam, std::complex<double> metal, AbsorptionSettings settings,
                std::int64_t long_run) {
  std::array const metals{bare(metal)};
  AbsorptionSettings const longer{.rays = long_run, .seed = 999, .map_spacing = settings.map_spacing};
  Absorption const truth = absorb(scene, beam, metals, 0, longer);
  double const brightest = truth.map.values.empty() ? 0.0 : *std::ranges::max_element(truth.map.values);
  Held held;
  double pixels = 0, pixels_held = 0;
  for (int s = 0; s < seeds; ++s) {
    settings.seed = static_cast<std::uint64_t>(s);
    Absorption const run = absorb(scene, beam, metals, 0, settings);
    SetAbsorption const& steel = run.sets[0];
    // The long run is off by its own error, which is small beside that of the short ones.
    held.total += std::abs(steel.absorptivity - truth.sets[0].absorptivity) <= steel.half_width;
    EXPECT_LT(truth.sets[0].standard_error, 0.2 * steel.standard_error) << "seed " << s;
    double const t = steel.half_width / steel.standard_error;
    for (std::size_t p = 0; p < run.map.values.size(); ++p) {
      if (truth.map.values[p] < 0.1 * brightest) continue;
      pixels += 1;
      pixels_held += std::abs(run.map.values[p] - truth.map.values[p]) <= t * run.map_error.values[p];
    }
  }
  held.pixels = pixels > 0 ? pixels_held / pixels : 0.0;
  return held;
}

TEST(Coverage, OfALatticeIsHonest) {
  Lattice const lattice = hexagonal_layers(2);
  BedScene const scene(lattice.bed, flat_floor(-3, 4, -3, 5, 0), lattice.period);
  Held const held =
      count_held(scene, uniform_light(lattice.period), stainless_steel, {.rays = 1600, .map_spacing = 0.25}, 1'000'000);
  EXPECT_GE(held.total, 180);
  EXPECT_LE(held.total, 198);
  EXPECT_GT(held.pixels, 0.90);
  EXPECT_LT(held.pixels, 0.99);
}

TEST(Coverage, OfARandomBedUnderABeamIsHonest) {
  double const length = 4e-4, width = 2e-4;
  BedScene const scene(random_bed(length, width, 8e-5, 8000), flat_floor(-1e-4, length + 1e-4, -1e-4, width + 1e-4, 0),
                       {0, width});
  Beam const spot{.centre = {2e-4, 1e-4, 0}, .power = 200, .radius = 35e-6};
  Held const held = count_held(scene, spot, stainless_steel, {.rays = 1600, .map_spacing = 2e-5}, 1'000'000);
  EXPECT_GE(held.total, 180);
  EXPECT_LE(held.total, 198);
  EXPECT_GT(held.pixels, 0.90);
  EXPECT_LT(held.pixels, 0.99);
}

TEST(Coverage, OfARunThatStopsAtATargetIsHonest) {
  // Stopping as soon as the error looks small enough favours errors that are too small.
  Lattice const lattice = hexagonal_layers(2);
  BedScene const scene(lattice.bed, flat_floor(-3, 4, -3, 5, 0), lattice.period);
  Held const held = count_held(scene, uniform_light(lattice.period), stainless_steel,
                               {.rays = 800, .target_standard_error = 2e-3}, 1'000'000);
  EXPECT_GE(held.total, 180);
  EXPECT_LE(held.total, 198);
}

}  // namespace
}  // namespace layerloop::raytrace
