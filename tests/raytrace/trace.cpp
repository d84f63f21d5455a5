#include "raytrace/trace.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <numeric>

#include "core/error.hpp"
#include "scenes.hpp"

namespace layerloop::raytrace {
namespace {

constexpr double length = 4e-4, width = 2e-4, cell = 5e-6;
std::array const steel{stainless_steel};

PowderBed const& powder() {
  static PowderBed const bed = random_bed(length, width, 8e-5, 8000);
  return bed;
}

TriangleSurface plate() { return flat_floor(-1e-4, length + 1e-4, -1e-4, width + 1e-4, 0); }

VoxelGrid grid_over(double y0) { return {{-1e-4, y0, -2e-5}, cell, {120, 40, 40}}; }

Beam beam_at(double x, double y) { return {.centre = {x, y, 0}, .power = 200, .radius = 35e-6}; }

double sum(std::vector<double> const& watts) { return std::accumulate(watts.begin(), watts.end(), 0.0); }

TEST(Trace, EnergyIsClosedAndEveryWattHasACell) {
  BedScene const scene(powder(), plate(), {0, width});
  for (std::complex<double> const metal : {stainless_steel, silver}) {
    std::array const metals{metal};
    AbsorbedPower const power = trace(scene, beam_at(2e-4, 1e-4), metals, 0, grid_over(0), {.rays = 16000});
    EXPECT_LT(ray_energy_error(power), 1e-12);
    EXPECT_LT(power.residual, 1e-6 * power.incident);
    EXPECT_GE(power.residual, 0);
    EXPECT_EQ(power.outside_grid, 0);
    EXPECT_NEAR(sum(power.watts), power.absorbed, 1e-12 * power.incident);
    EXPECT_TRUE(std::is_sorted(power.cell.begin(), power.cell.end()));
    EXPECT_EQ(power.rays, 16000);
    EXPECT_GT(power.mean_bounces, 1);
  }
}

TEST(Trace, CutOffPowerIsBookedNotDropped) {
  BedScene const scene(powder(), plate(), {0, width});
  AbsorbedPower const power =
      trace(scene, beam_at(2e-4, 1e-4), std::array{silver}, 0, grid_over(0), {.rays = 4000, .max_bounces = 2});
  EXPECT_GT(power.residual, 0.1 * power.incident);
  EXPECT_LT(ray_energy_error(power), 1e-12);
}

TEST(Trace, WattsLandInCellsThatHoldMetal) {
  BedScene const scene(powder(), plate(), {0, width});
  VoxelGrid const grid = grid_over(0);
  AbsorbedPower const power = trace(scene, beam_at(2e-4, 1e-4), steel, 0, grid, {.rays = 16000});
  double in_gas = 0;
  for (std::size_t c = 0; c < power.cell.size(); ++c) {
    auto const [i, j, k] = grid.coordinates(power.cell[c]);
    Vec3 const centre = grid.centre(i, j, k);
    bool metal = centre.z() < cell;
    for (std::size_t g = 0; g < powder().size() && !metal; ++g) {
      Vec3 d = centre - powder().position(g);
      d.y() -= width * std::round(d.y() / width);
      metal = d.norm() < powder().radius[g] + 0.5 * std::sqrt(3.0) * cell;
    }
    if (!metal) in_gas += power.watts[c];
  }
  EXPECT_EQ(in_gas, 0);
}

TEST(Trace, ABeamOnThePeriodicEdgeSeesTheSameBed) {
  // Bed, beam and grid moved by half a width: the same light in the same place, only wrapped.
  PowderBed moved = powder();
  for (double& y : moved.y) y = std::fmod(y + width / 2, width);
  BedScene const scene(powder(), plate(), {0, width}), moved_scene(moved, plate(), {0, width});
  TraceSettings const settings{.rays = 8000};
  AbsorbedPower const middle = trace(scene, beam_at(2e-4, width / 2), steel, 0, grid_over(0), settings);
  AbsorbedPower const edge = trace(moved_scene, beam_at(2e-4, 0), steel, 0, grid_over(0), settings);
  EXPECT_NEAR(edge.absorptivity, middle.absorptivity, 1e-4);  // rounding, amplified from bounce to bounce
  EXPECT_EQ(edge.outside_grid, 0);
  EXPECT_NEAR(sum(edge.watts), edge.absorbed, 1e-12 * edge.incident);

  VoxelGrid const grid = grid_over(0);
  std::vector<double> difference(static_cast<std::size_t>(grid.size()), 0.0);
  for (std::size_t c = 0; c < middle.cell.size(); ++c)
    difference[static_cast<std::size_t>(middle.cell[c])] += middle.watts[c];
  for (std::size_t c = 0; c < edge.cell.size(); ++c) {
    auto const [i, j, k] = grid.coordinates(edge.cell[c]);
    difference[static_cast<std::size_t>(grid.index(i, (j + 20) % 40, k))] -= edge.watts[c];
  }
  double misplaced = 0;
  for (double const watts : difference) misplaced += std::abs(watts);
  EXPECT_LT(misplaced, 2e-3 * middle.absorbed);
}

TEST(Trace, ATileTwiceAsWideGivesTheSame) {
  PowderBed twice = powder();
  for (std::size_t i = 0; i < powder().size(); ++i) {
    add_grain(twice, powder().x[i], powder().y[i] + width, powder().z[i], powder().radius[i]);
  }
  BedScene const scene(powder(), plate(), {0, width});
  BedScene const wide(twice, flat_floor(-1e-4, length + 1e-4, -1e-4, 2 * width + 1e-4, 0), {0, 2 * width});
  TraceSettings const settings{.rays = 8000};
  double const one = trace(scene, beam_at(2e-4, 1e-4), steel, 0, one_cell(scene), settings).absorptivity;
  double const two = trace(wide, beam_at(2e-4, 1e-4), steel, 0, one_cell(wide), settings).absorptivity;
  EXPECT_NEAR(one, two, 1e-4);
}

TEST(Trace, SizeDoesNotMatter) {
  PowderBed big = powder();
  for (auto* values : {&big.x, &big.y, &big.z, &big.radius}) {
    for (double& v : *values) v *= 1024;
  }
  TriangleSurface big_plate = plate();
  for (Vec3& v : big_plate.vertices) v *= 1024;
  BedScene const scene(powder(), plate(), {0, width}), big_scene(big, big_plate, {0, 1024 * width});
  Beam big_beam = beam_at(1024 * 2e-4, 1024 * 1e-4);
  big_beam.radius *= 1024;
  double const small = trace(scene, beam_at(2e-4, 1e-4), steel, 0, one_cell(scene), {.rays = 4000}).absorptivity;
  EXPECT_NEAR(trace(big_scene, big_beam, steel, 0, one_cell(big_scene), {.rays = 4000}).absorptivity, small, 1e-12);
}

TEST(Trace, ThreadsDoNotChangeABit) {
  BedScene const scene(powder(), plate(), {0, width});
  auto const run = [&](int threads) {
    omp_set_num_threads(threads);
    return trace(scene, beam_at(2e-4, 1e-4), steel, 0, grid_over(0), {.rays = 16000});
  };
  AbsorbedPower const one = run(1), two = run(2), three = run(3);
  omp_set_num_threads(omp_get_num_procs());
  for (AbsorbedPower const* other : {&two, &three}) {
    EXPECT_EQ(one.cell, other->cell);
    EXPECT_EQ(one.watts, other->watts);
    EXPECT_EQ(one.absorbed, other->absorbed);
    EXPECT_EQ(one.escaped, other->escaped);
    EXPECT_EQ(one.standard_error, other->standard_error);
  }
}

TEST(Trace, StandardErrorIsHonest) {
  BedScene const scene(powder(), plate(), {0, width});
  int const seeds = 40;
  double mean = 0, reported = 0;
  std::vector<double> found;
  for (int s = 0; s < seeds; ++s) {
    AbsorbedPower const power = trace(scene, beam_at(2e-4, 1e-4), steel, 0, one_cell(scene),
                                      {.rays = 1600, .seed = static_cast<std::uint64_t>(100 + s)});
    found.push_back(power.absorptivity);
    mean += power.absorptivity / seeds;
    reported += power.standard_error * power.standard_error / seeds;
  }
  double spread = 0;
  for (double const a : found) spread += (a - mean) * (a - mean) / (seeds - 1);
  // chi-square with 39 degrees of freedom, over 39: 0.1 % and 99.9 % points.
  EXPECT_GT(spread / reported, 0.44);
  EXPECT_LT(spread / reported, 1.85);
}

TEST(Trace, TracesOfDifferentIdAreIndependent) {
  BedScene const scene(powder(), plate(), {0, width});
  auto const at = [&](std::uint64_t id) {
    return trace(scene, beam_at(2e-4, 1e-4), steel, 0, one_cell(scene), {.rays = 1600, .id = id});
  };
  EXPECT_EQ(at(1).absorbed, at(1).absorbed);
  EXPECT_NE(at(1).absorbed, at(2).absorbed);
}

TEST(Trace, EveryMaterialHasItsOwnIndex) {
  PowderBed bed;
  bed.add(0, {0.5, 0.5, 0.5}, 0.5, 1);
  BedScene const scene(bed, flat_floor(-1, 2, -1, 2, -5), {1, 1});
  // A black grain takes what falls on its shadow; the floor, nearly a mirror, sends the rest back up.
  std::array const metals{std::complex<double>(0.01, 100.0), black};
  AbsorbedPower const power = trace(scene, uniform_light({1, 1}), metals, 0, one_cell(scene), {.rays = 50000});
  EXPECT_NEAR(power.absorptivity, std::numbers::pi / 4, 3e-4);
}

TEST(Trace, RefusesWhatMakesNoSense) {
  BedScene const scene(powder(), plate(), {0, width});
  VoxelGrid const grid = grid_over(0);
  EXPECT_THROW(trace(scene, beam_at(1, 1e-4), steel, 0, grid, {}), PhysicsError) << "beam off the bed";
  EXPECT_THROW(trace(scene, beam_at(2e-4, 1e-4), std::span<std::complex<double> const>{}, 0, grid, {}), InputError)
      << "no refractive index";
  EXPECT_THROW(trace(scene, beam_at(2e-4, 1e-4), std::array{std::complex<double>(3, -4)}, 0, grid, {}), InputError);
  EXPECT_THROW(trace(scene, beam_at(2e-4, 1e-4), steel, 0, grid, {.rays = 0}), InputError);
  Beam dark = beam_at(2e-4, 1e-4);
  dark.power = 0;
  EXPECT_THROW(trace(scene, dark, steel, 0, grid, {}), InputError);
  Beam nowhere = beam_at(std::nan(""), 1e-4);
  EXPECT_THROW(trace(scene, nowhere, steel, 0, grid, {}), Error);
}

}  // namespace
}  // namespace layerloop::raytrace
