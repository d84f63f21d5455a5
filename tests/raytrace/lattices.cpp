#include <gtest/gtest.h>

#include "raytrace/fresnel.hpp"
#include "scenes.hpp"

// Shapes whose absorptivity is known in closed form, through the tracer of the layer loop.
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

}  // namespace
}  // namespace layerloop::raytrace
