#include <gtest/gtest.h>

#include "scenes.hpp"

// Lattices that another tracer has computed (built-in Embree spheres, random rays, 4e5 paths), light straight down,
// unpolarised. Its standard errors: .0002 to .0005.
namespace layerloop::raytrace {
namespace {

constexpr double target = 3e-4;

/// n + ik near 1 um, as in the hexagonal layers of Boley et al., Appl. Opt. 54 (2015) 2477.
std::array const metals{bare({0.35, 6.97}), bare({3.27, 4.48}), bare({3.45, 4.00}), bare({1.244, 10.0}),
                        bare({0.23, 7.09})};

void expect_absorptivities(BedScene const& scene, std::span<OpticalSet const> sets, std::span<double const> expected,
                           double their_error) {
  AbsorptionSettings const settings{.rays = 32768, .cut_off = 1e-6, .target_standard_error = target};
  Absorption const result = absorb(scene, uniform_light(scene.period()), sets, 0, settings);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    SetAbsorption const& found = result.sets[k];
    EXPECT_LE(found.standard_error, target) << "set " << k;
    EXPECT_NEAR(found.absorptivity, expected[k], 3 * std::hypot(found.standard_error, their_error)) << "set " << k;
  }
}

TEST(ReferenceLattices, HexagonalLayers) {
  struct {
    int layers;
    bool floor;
    std::array<double, 5> expected;  ///< copper, steel, titanium, aluminium, silver
  } const rows[] = {{1, false, {.0634, .4892, .5281, .1073, .0416}},
                    {1, true, {.1204, .5589, .5987, .1744, .0875}},
                    {2, false, {.1226, .5761, .6136, .1838, .0864}},
                    {2, true, {.1693, .5948, .6321, .2236, .1334}}};
  for (auto const& row : rows) {
    SCOPED_TRACE(std::to_string(row.layers) + (row.floor ? " layers on a floor" : " layers"));
    Lattice const lattice = hexagonal_layers(row.layers);
    BedScene const scene(lattice.bed, row.floor ? flat_floor(-3, 4, -3, 5, 0) : TriangleSurface{}, lattice.period);
    expect_absorptivities(scene, metals, row.expected, 5e-4);
  }
}

TEST(ReferenceLattices, SixteenFaceCentredCubicLayers) {
  Lattice const lattice = face_centred_cubic(16);
  std::array const sets{grey(.10), grey(.30), grey(.36), grey(.60), bare(stainless_steel)};
  std::array const expected{.30988, .57015, .62591, .80309, .61876};
  expect_absorptivities(BedScene(lattice.bed, {}, lattice.period), sets, expected, 4.8e-4);
}

TEST(ReferenceLattices, FourteenSimpleCubicLayers) {
  Lattice const lattice = simple_cubic(14);
  std::array const sets{grey(.36), grey(.10)};
  std::array const expected{.47138, .24321};
  expect_absorptivities(BedScene(lattice.bed, {}, lattice.period), sets, expected, 5.8e-4);
}

}  // namespace
}  // namespace layerloop::raytrace
