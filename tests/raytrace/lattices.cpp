#include <gtest/gtest.h>

#include "raytrace/fresnel.hpp"
#include "scenes.hpp"

// Absorptivity of shapes whose answer is known in closed form, or from an independent tracer run to high precision.
namespace layerloop::raytrace {
namespace {

/// 2 c A(c) integrated over c from 0 to 1: what a convex body absorbs of light from one direction, over its shadow.
double hemispherical_absorptivity(std::complex<double> metal) {
  int const steps = 20000;  // midpoint rule
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    double const c = (i + 0.5) / steps;
    sum += 2 * c * (1 - fresnel_reflectance(metal, c).average()) / steps;
  }
  return sum;
}

TEST(Lattices, FlatFloorIsFresnel) {
  BedScene const scene({}, flat_floor(-1, 2, -1, 2, 0), {1, 1});
  AbsorbedPower const power = trace_uniform(scene, stainless_steel, 1000);
  EXPECT_NEAR(power.absorptivity, 1 - fresnel_reflectance(stainless_steel, 1).average(), 1e-12);
  EXPECT_NEAR(power.absorptivity, .34148, 6e-6);
  EXPECT_LT(power.standard_error, 1e-12);
  EXPECT_EQ(power.mean_bounces, 1);
}

TEST(Lattices, OneSphereAbsorbsTheHemisphericalShare) {
  PowderBed bed;
  add_grain(bed, 0.5, 0.5, 0.5, 0.5);
  BedScene const scene(bed, {}, {0, 0});
  Beam const beam = uniform_light({1, 1});
  std::array const metals{stainless_steel};
  AbsorbedPower const power = trace(scene, beam, metals, 0, one_cell(scene), {.rays = 100000});
  double const shadow = std::numbers::pi / 4;
  EXPECT_NEAR(power.absorptivity / shadow, hemispherical_absorptivity(stainless_steel),
              4 * power.standard_error / shadow);
  EXPECT_NEAR(power.absorptivity / shadow, .35862, 3e-4);
  EXPECT_NEAR(power.mean_bounces, shadow, 1e-3) << "no ray may meet a single sphere twice";
}

TEST(Lattices, BlackLayersLetTheGapsThrough) {
  // 1 - pi / (2 sqrt(3)) for one close-packed layer, 1 - pi / 4 for a simple cubic lattice of any depth.
  Lattice const hexagonal = hexagonal_layers(1), cubic = simple_cubic(5);
  AbsorbedPower const one = trace_uniform(BedScene(hexagonal.bed, {}, hexagonal.period), black, 200000);
  EXPECT_LT(one.standard_error, 2e-4);
  EXPECT_NEAR(1 - one.absorptivity, .0931003, 3 * one.standard_error);
  AbsorbedPower const deep = trace_uniform(BedScene(cubic.bed, {}, cubic.period), black, 200000);
  EXPECT_LT(deep.standard_error, 2e-4);
  EXPECT_NEAR(1 - deep.absorptivity, .2146018, 3 * deep.standard_error);
}

TEST(Lattices, RightAngledGrooveTellsTrackedFromAveragedPolarisation) {
  // Two hits at 45 degrees with the same s and p directions: 1 - (Rs^2 + Rp^2)/2 tracked, 1 - ((Rs + Rp)/2)^2 averaged.
  TriangleSurface groove;
  groove.vertices = {{-1, -1, 1}, {0, -1, 0}, {1, -1, 1}, {-1, 2, 1}, {0, 2, 0}, {1, 2, 1}};
  groove.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  BedScene const scene({}, groove, {0, 1});
  Beam const beam{.centre = {0, 0.5, 0}, .power = 1, .profile = BeamProfile::uniform, .size_x = 1.9, .size_y = 1};
  std::array const metals{stainless_steel};
  auto const absorptivity = [&](Polarisation polarisation) {
    return trace(scene, beam, metals, 0, one_cell(scene), {.rays = 2000, .polarisation = polarisation}).absorptivity;
  };
  EXPECT_NEAR(absorptivity(Polarisation::tracked), .568139, 1e-6);
  EXPECT_NEAR(absorptivity(Polarisation::averaged), .577152, 1e-6);
}

// The bars below were computed with another tracer (built-in Embree spheres, random rays, 4e5 paths, se .0002 to
// .0005).

TEST(Lattices, HexagonalLayersOnAFloor) {
  struct {
    int layers;
    std::complex<double> metal;
    double expected;
  } const cases[] = {{1, stainless_steel, .5589}, {2, stainless_steel, .5948}, {1, silver, .0875}, {2, silver, .1334}};
  for (auto const& c : cases) {
    Lattice const lattice = hexagonal_layers(c.layers);
    BedScene const scene(lattice.bed, flat_floor(-3, 4, -3, 5, 0), lattice.period);
    AbsorbedPower const power = trace_uniform(scene, c.metal, 60000);
    EXPECT_LT(power.standard_error, 1e-3);
    EXPECT_NEAR(power.absorptivity, c.expected, 3 * power.standard_error + .0015) << c.layers << " layers";
  }
}

TEST(Lattices, HexagonalLayersWithoutFloor) {
  Lattice const one = hexagonal_layers(1), two = hexagonal_layers(2);
  EXPECT_NEAR(trace_uniform(BedScene(one.bed, {}, one.period), stainless_steel, 60000).absorptivity, .4892, .0025);
  EXPECT_NEAR(trace_uniform(BedScene(two.bed, {}, two.period), stainless_steel, 60000).absorptivity, .5761, .0025);
}

TEST(Lattices, SixteenFaceCentredCubicLayers) {
  Lattice const lattice = face_centred_cubic(16);
  AbsorbedPower const power = trace_uniform(BedScene(lattice.bed, {}, lattice.period), stainless_steel, 60000);
  EXPECT_NEAR(power.absorptivity, .61876, 3 * std::hypot(power.standard_error, .00047));
}

}  // namespace
}  // namespace layerloop::raytrace
