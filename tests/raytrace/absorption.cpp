#include "raytrace/absorption.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <numeric>

#include "core/error.hpp"
#include "scenes.hpp"

namespace layerloop::raytrace {
namespace {

constexpr double length = 4e-4, width = 2e-4, wavelength = 1.07e-6;

/// Grains of two materials on a plate of material 0.
PowderBed const& powder() {
  static PowderBed const bed = [] {
    PowderBed mixed = random_bed(length, width, 8e-5, 8000);
    for (std::size_t i = 0; i < mixed.size(); ++i) mixed.material[i] = i % 3 == 0;
    return mixed;
  }();
  return bed;
}

BedScene const& scene() {
  static BedScene const bed(powder(), flat_floor(-1e-4, length + 1e-4, -1e-4, width + 1e-4, 0), {0, width});
  return bed;
}

Beam const spot{.centre = {2e-4, 1e-4, 0}, .power = 200, .radius = 35e-6};

OpticalSet pair_of(Surface const& first, Surface const& second) { return {"", {first, second}, wavelength}; }
OpticalSet pair_of(std::complex<double> first, std::complex<double> second) {
  return pair_of(Surface{.refractive_index = first}, Surface{.refractive_index = second});
}

Surface const oxidised{.refractive_index = {1.244, 10.0}, .film_thickness = 8e-8, .film_index = {1.75, 0.05}};

std::vector<OpticalSet> const sets{pair_of(stainless_steel, silver), pair_of(silver, {1.244, 10.0}),
                                   pair_of(oxidised, {.refractive_index = 1, .grey_reflectance = 0.9})};

double sum(std::vector<double> const& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(Absorption, SetsTogetherAreSetsAloneToTheBit) {
  for (Polarisation const polarisation : {Polarisation::averaged, Polarisation::tracked}) {
    AbsorptionSettings const settings{
        .rays = 4000, .polarisation = polarisation, .diffuse_share = 0.2, .derivatives = true};
    Absorption const together = absorb(scene(), spot, sets, 0, settings);
    for (std::size_t k = 0; k < sets.size(); ++k) {
      SetAbsorption const& one = together.sets[k];
      Absorption const run = absorb(scene(), spot, {&sets[k], 1}, 0, settings);
      SetAbsorption const& alone = run.sets[0];
      EXPECT_EQ(one.absorptivity, alone.absorptivity);
      EXPECT_EQ(one.standard_error, alone.standard_error);
      EXPECT_EQ(one.by_material, alone.by_material);
      EXPECT_EQ(one.substrate, alone.substrate);
      EXPECT_EQ(one.residual, alone.residual);
      EXPECT_EQ(one.d_n, alone.d_n);
      EXPECT_EQ(one.d_k, alone.d_k);
      if (k == 0) {
        EXPECT_EQ(together.grain_share, run.grain_share);
        EXPECT_EQ(together.mean_bounces, run.mean_bounces);
      }
    }
  }
}

TEST(Absorption, PartsAddUpToTheTotal) {
  VoxelGrid const grid{{1e-4, 0, -2e-5}, 5e-6, {40, 40, 40}};  // smaller than the bed
  AbsorptionSettings const settings{.rays = 20000, .grid = grid, .depth_bins = 30, .map_spacing = 7e-6};
  Absorption const result = absorb(scene(), spot, sets, 0, settings);
  double const total = result.sets[0].absorptivity;
  EXPECT_NEAR(sum(result.grain_share) + result.substrate_share, total, 1e-12);
  EXPECT_NEAR(sum(result.cell_share) + result.outside_grid, total, 1e-12);
  EXPECT_GT(result.outside_grid, 0);
  EXPECT_LT(result.outside_grid, 0.1);
  EXPECT_NEAR(sum(result.map.values) * 49e-12 + result.outside_map, total, 1e-12);
  double layers = 0;
  for (DepthLayer const& layer : result.depth_profile) layers += layer.fraction;
  EXPECT_NEAR(layers, total, 1e-12);
  for (SetAbsorption const& set : result.sets) {
    EXPECT_NEAR(sum(set.by_material), set.absorptivity, 1e-12);
    EXPECT_NEAR(set.absorptivity + set.escaped + set.residual, 1, 1e-12);
    EXPECT_LT(set.residual, 1e-6);
    EXPECT_GE(set.residual, 0);
  }
  double of_silver = 0;
  for (std::size_t i = 0; i < powder().size(); ++i)
    of_silver += powder().material[i] == 1 ? result.grain_share[i] : 0.0;
  EXPECT_NEAR(of_silver, result.sets[0].by_material[1], 1e-12);
}

TEST(Absorption, TwoNamesOfOneMetalAreThatMetal) {
  PowderBed one_metal = powder();
  std::ranges::fill(one_metal.material, 0);
  BedScene const plain(one_metal, scene().substrate(), scene().period());
  std::array const same{pair_of(stainless_steel, stainless_steel)}, steel{bare(stainless_steel)};
  double const mixed = absorb(scene(), spot, same, 0, {.rays = 8000}).sets[0].absorptivity;
  EXPECT_NEAR(absorb(plain, spot, steel, 0, {.rays = 8000}).sets[0].absorptivity, mixed, 1e-13);
}

TEST(Absorption, DepthAndMapSeeWhereLightStays) {
  // A black grain of radius 1 over a mirror: half of the tile's light, spread over its upper half.
  double const edge = std::sqrt(2 * std::numbers::pi);
  PowderBed bed;
  add_grain(bed, 0.5 * edge, 0.5 * edge, 3, 1);
  bed.material[0] = 1;
  BedScene const one(bed, flat_floor(-9, 9, -9, 9, 0), {edge, edge});
  std::array const black_on_mirror{
      pair_of({.refractive_index = 1, .grey_reflectance = 1}, {.refractive_index = 1, .grey_reflectance = 0})};
  AbsorptionSettings const settings{
      .rays = 200000, .depth_bins = 4, .depth_range = std::array{2.0, 4.0}, .map_spacing = edge / 4};
  Absorption const result = absorb(one, uniform_light({edge, edge}), black_on_mirror, 0, settings);
  // Rays that pass it come back from the mirror straight up and miss it again.
  EXPECT_NEAR(result.sets[0].absorptivity, 0.5, 1e-3);
  EXPECT_EQ(result.substrate_share, 0);
  ASSERT_EQ(result.depth_profile.size(), 4u);
  // Share above a height h over the centre, by projection: 1 - h^2.
  EXPECT_EQ(result.depth_profile[0].fraction + result.depth_profile[1].fraction, 0);
  EXPECT_NEAR(result.depth_profile[2].fraction, 0.5 * 0.25, 5 * result.depth_profile[2].error);
  EXPECT_NEAR(result.depth_profile[3].fraction, 0.5 * 0.75, 5 * result.depth_profile[3].error);
  EXPECT_NEAR(result.depth_profile[3].z, 3.75, 1e-12);
  ASSERT_EQ(result.map.values.size(), 16u);
  // The pixel from the middle outwards reaches to 0.886 < 1: the grain covers all of it.
  double const area = edge * edge;
  EXPECT_NEAR(result.map.at(1, 1) * area, 1, 5 * result.map_error.at(1, 1) * area + 1e-12);
  EXPECT_LT(result.map_error.at(1, 1) * area, 1e-2);
  EXPECT_NEAR(result.map.at(0, 0), result.map.at(3, 3),
              5 * std::hypot(result.map_error.at(0, 0), result.map_error.at(3, 3)));
  EXPECT_LT(result.map.at(0, 0) * area, 0.5);
}

TEST(Absorption, DerivativesAreDifferenceQuotients) {
  for (Polarisation const polarisation : {Polarisation::averaged, Polarisation::tracked}) {
    for (double const diffuse : {0.0, 0.3}) {
      AbsorptionSettings const settings{
          .rays = 2000, .polarisation = polarisation, .diffuse_share = diffuse, .cut_off = 1e-13, .derivatives = true};
      OpticalSet const set = pair_of(oxidised, {.refractive_index = stainless_steel});
      double const h = 1e-5;
      std::vector<OpticalSet> moved{set};
      for (std::size_t m = 0; m < 2; ++m) {
        for (std::complex<double> const step :
             {std::complex(h, 0.0), std::complex(-h, 0.0), std::complex(0.0, h), std::complex(0.0, -h)}) {
          moved.push_back(set);
          moved.back().surface[m].refractive_index += step;
        }
      }
      std::vector<SetAbsorption> const found = absorb(scene(), spot, moved, 0, settings).sets;
      for (std::size_t m = 0; m < 2; ++m) {
        auto const quotient = [&](std::size_t first) {
          return (found[1 + 4 * m + first].absorptivity - found[2 + 4 * m + first].absorptivity) / (2 * h);
        };
        EXPECT_NEAR(found[0].d_n[m], quotient(0), 1e-8);
        EXPECT_NEAR(found[0].d_k[m], quotient(2), 1e-8);
        EXPECT_GT(std::abs(found[0].d_k[m]), 1e-4);
      }
    }
  }
}

TEST(Absorption, DerivativesOfAFlatPlateAreTheClosedForm) {
  BedScene const plate({}, flat_floor(-1, 2, -1, 2, 0), {1, 1});
  double const n = 3.27, k = 4.48, d = (n + 1) * (n + 1) + k * k;
  std::array const steel{bare(stainless_steel)};
  SetAbsorption const flat = absorb(plate, uniform_light({1, 1}), steel, 0, {.rays = 100, .derivatives = true}).sets[0];
  EXPECT_NEAR(flat.d_n[0], 4 / d - 8 * n * (n + 1) / (d * d), 1e-13);
  EXPECT_NEAR(flat.d_k[0], -8 * n * k / (d * d), 1e-13);
  EXPECT_LT(flat.d_n_error[0], 1e-13);
}

TEST(Absorption, EndsOfAbsorptivity) {
  BedScene const plate({}, flat_floor(-1, 2, -1, 2, 0), {1, 1});
  std::array const flat{grey(0), grey(1), bare(black), bare({1.5, 0}), bare({1e-6, 1e3})};
  std::vector<SetAbsorption> const found = absorb(plate, uniform_light({1, 1}), flat, 0, {.rays = 100}).sets;
  EXPECT_EQ(found[0].absorptivity, 0) << "mirror";
  EXPECT_EQ(found[1].absorptivity, 1);
  EXPECT_EQ(found[2].absorptivity, 1) << "index of gas";
  EXPECT_NEAR(found[3].absorptivity, 0.96, 1e-14) << "what glass lets through counts as absorbed";
  EXPECT_NEAR(found[4].absorptivity, 4e-12, 1e-15) << "nearly a mirror";

  // Mirrors all the way down: nothing is absorbed, nothing is lost, and the trace ends.
  std::array const mirror{
      pair_of({.refractive_index = 1, .grey_reflectance = 1}, {.refractive_index = 1, .grey_reflectance = 1})};
  SetAbsorption const lit = absorb(scene(), spot, mirror, 0, {.rays = 1000}).sets[0];
  EXPECT_EQ(lit.absorptivity, 0);
  EXPECT_NEAR(lit.escaped + lit.residual, 1, 1e-12);
}

TEST(Absorption, WhatIsCutOffIsBooked) {
  std::array const mixed{sets[1]};
  SetAbsorption const by_hits = absorb(scene(), spot, mixed, 0, {.rays = 2000, .max_bounces = 2}).sets[0];
  EXPECT_GT(by_hits.residual, 0.1);
  EXPECT_NEAR(by_hits.absorptivity + by_hits.escaped + by_hits.residual, 1, 1e-12);
  SetAbsorption const early = absorb(scene(), spot, mixed, 0, {.rays = 2000, .cut_off = 0.5}).sets[0],
                      late = absorb(scene(), spot, mixed, 0, {.rays = 2000, .cut_off = 1e-14}).sets[0];
  EXPECT_GT(early.residual, late.residual);
  // The residual bounds what the cut-off has taken away.
  EXPECT_GE(late.absorptivity, early.absorptivity);
  EXPECT_LE(late.absorptivity, early.absorptivity + early.residual);
}

TEST(Absorption, NoDiffuseShareDrawsNothing) {
  // With a share of zero and with one far below the resolution of the random numbers.
  Absorption const none = absorb(scene(), spot, sets, 0, {.rays = 2000}),
                   hardly = absorb(scene(), spot, sets, 0, {.rays = 2000, .diffuse_share = 1e-15}),
                   some = absorb(scene(), spot, sets, 0, {.rays = 2000, .diffuse_share = 0.1});
  EXPECT_EQ(none.sets[0].absorptivity, hardly.sets[0].absorptivity);
  EXPECT_EQ(none.grain_share, hardly.grain_share);
  EXPECT_NE(none.sets[0].absorptivity, some.sets[0].absorptivity);
}

TEST(Absorption, StopsAtTheErrorThatWasAskedFor) {
  std::array const steel{sets[0]};
  Absorption const reached = absorb(scene(), spot, steel, 0, {.rays = 1600, .target_standard_error = 1e-3});
  EXPECT_TRUE(reached.target_reached);
  EXPECT_LE(reached.sets[0].standard_error, 1e-3);
  EXPECT_GT(reached.rays, 1600);
  Absorption const at_once = absorb(scene(), spot, steel, 0, {.rays = reached.rays});
  EXPECT_NEAR(at_once.sets[0].absorptivity, reached.sets[0].absorptivity, 1e-13) << "the same rays";

  Absorption const too_few =
      absorb(scene(), spot, steel, 0, {.rays = 1600, .max_rays = 5000, .target_standard_error = 1e-6});
  EXPECT_FALSE(too_few.target_reached);
  EXPECT_EQ(too_few.rays, 5008) << "313 rays in each of 16 replicates";
}

TEST(Absorption, ThreadsDoNotChangeABit) {
  auto const run = [&](int threads) {
    omp_set_num_threads(threads);
    return absorb(scene(), spot, sets, 0,
                  {.rays = 16000, .diffuse_share = 0.1, .derivatives = true, .map_spacing = 1e-5});
  };
  Absorption const one = run(1), two = run(2), three = run(3);
  omp_set_num_threads(omp_get_num_procs());
  for (Absorption const* other : {&two, &three}) {
    EXPECT_EQ(one.grain_share, other->grain_share);
    EXPECT_EQ(one.map.values, other->map.values);
    EXPECT_EQ(one.sets[1].absorptivity, other->sets[1].absorptivity);
    EXPECT_EQ(one.sets[1].standard_error, other->sets[1].standard_error);
    EXPECT_EQ(one.sets[1].d_n, other->sets[1].d_n);
  }
}

TEST(Absorption, RefusesWhatMakesNoSense) {
  Beam beside = spot, polarised = spot;
  beside.centre.x() = 1;
  polarised.polarisation = BeamPolarisation::x;
  EXPECT_THROW(absorb(scene(), beside, sets, 0, {}), PhysicsError) << "beam off the bed";
  EXPECT_THROW(absorb(scene(), polarised, sets, 0, {}), InputError) << "averaged light has no polarisation";
  EXPECT_THROW(absorb(scene(), spot, {}, 0, {}), InputError);
  EXPECT_THROW(absorb(scene(), spot, sets, 5, {}), InputError) << "no such material";
  EXPECT_THROW(absorb(scene(), spot, sets, -1, {}), InputError);
  EXPECT_THROW(absorb(scene(), spot, sets, 0, {.rays = 0}), InputError);
  EXPECT_THROW(absorb(scene(), spot, sets, 0, {.replicates = 1}), InputError);
  EXPECT_THROW(absorb(scene(), spot, sets, 0, {.diffuse_share = 1.5}), InputError);
  EXPECT_THROW(absorb(scene(), spot, sets, 0, {.cut_off = std::nan("")}), InputError);
  EXPECT_THROW(absorb(scene(), spot, sets, 0, {.target_standard_error = -1}), InputError);
  EXPECT_THROW(absorb(scene(), spot, sets, 0, {.depth_range = std::array{1.0, 0.0}}), InputError);
  EXPECT_THROW(absorb(scene(), spot, sets, 0, {.map_spacing = 1e-12}), InputError) << "more pixels than memory";
}

}  // namespace
}  // namespace layerloop::raytrace
