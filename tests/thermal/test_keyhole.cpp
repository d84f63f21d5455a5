#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/thermal/plate.hpp"
#include "thermal/effects/keyhole.hpp"

namespace layerloop::thermal {
namespace {

constexpr double atmosphere = 101325;

/// Metal of constant properties that can boil: h = density cp (T - 298).
Material boiling_metal() {
  Material m = constant_metal(30, 7000, 800);
  m.boiling_point = 3000;
  m.heat_of_vaporisation = 7e6;
  m.molar_mass = 0.056;
  m.surface_tension = 1.6;
  m.surface_tension_slope = -0.3e-3;
  return m;
}

/// A plate of 40 x 40 x 40 cells with a hot round patch in its middle, T(r, z) as given, and the keyhole on it.
struct Patch {
  Material metal = boiling_metal();
  HeatCells cells = make_heat_cells(solid_block(5e-6, {40, 40, 40}), SideY::far_field);
  EnthalpyTable table{metal, 298, 9000};
  Keyhole keyhole{metal, cells, 1};
  std::vector<double> h = std::vector<double>(static_cast<std::size_t>(cells.grid.size()), 0);
  BeamReach beam{{100e-6, 100e-6, 0}, 1};

  /// \param temperature  over the depth of a cell's centre [m] \return columns of the patch
  template <class Temperature>
  std::size_t heat(double radius, Temperature const& temperature) {
    std::size_t columns = 0;
    for (std::int64_t c = 0; c < cells.grid.size(); ++c) {
      auto const [i, j, k] = cells.grid.coordinates(c);
      Vec3 const at = cells.grid.centre(i, j, k);
      if (std::hypot(at.x() - 100e-6, at.y() - 100e-6) > radius) continue;
      columns += k == 0;
      h[static_cast<std::size_t>(c)] = table.enthalpy(temperature(200e-6 - at.z()));
    }
    return columns;
  }
  double surface_tension() const { return 1.6 - 0.3e-3 * (metal.boiling_point - metal.liquidus); }
  double wall_temperature(double radius) const {
    return keyhole.saturation_temperature(atmosphere + surface_tension() / radius);
  }
};

TEST(Keyhole, SaturationPressureIsOneAtmosphereAtTheBoilingPoint) {
  Patch const patch;
  EXPECT_NEAR(patch.keyhole.saturation_pressure(3000), atmosphere, 1e-9 * atmosphere);
  EXPECT_NEAR(patch.keyhole.saturation_temperature(patch.keyhole.saturation_pressure(3456)), 3456, 1e-9);
  double const slope = 7e6 * 0.056 / 8.314462618 / (3000.0 * 3000.0);  // d ln p / dT of Clausius and Clapeyron
  EXPECT_NEAR(std::log(patch.keyhole.saturation_pressure(3000.01) / atmosphere), slope * 0.01, 1e-4 * slope * 0.01);
}

TEST(Keyhole, OpensOnceTheRecoilExceedsWhatARimCanHold) {
  double const area = 25e-12;
  for (double const radius : {15e-6, 30e-6}) {
    Patch probe;
    auto const columns = static_cast<double>(probe.heat(radius, [](double) { return 300.0; }));
    double const R = std::sqrt(columns * area / 3.14159265358979);
    double const needed = (2 * probe.surface_tension() / R + atmosphere) / 0.54;
    double const T = probe.keyhole.saturation_temperature(needed);
    for (double const beside : {-1.0, 1.0}) {
      Patch patch;
      patch.heat(radius, [&](double depth) { return depth < 10e-6 ? T + beside : 2000; });
      // The two highest cells are alike: the surface is as hot as they are.
      patch.keyhole.update(patch.h, patch.table, patch.beam);
      EXPECT_EQ(patch.keyhole.wall().empty(), beside < 0) << "radius " << radius;
      if (beside < 0) continue;
      EXPECT_NEAR(patch.keyhole.radius(), R, 1e-12);
      EXPECT_NEAR(patch.keyhole.wall_temperature(), patch.wall_temperature(R), 1e-9);
    }
  }
}

/// Under a surface that is hotter than the wall by D, with a gradient g, the metal down to D / g holds D^2 / (2 g) too
/// much. Handed down, it brings as much below to the wall's temperature: the wall lies at 2 D / g.
TEST(Keyhole, WallLiesWhereTheHeatBeyondItIsUsedUp) {
  Patch patch;
  double const gradient = 2e7, surface = 4200;
  auto const columns = patch.heat(30e-6, [&](double depth) { return surface - gradient * depth; });
  double const R = 5e-6 * std::sqrt(static_cast<double>(columns) / 3.14159265358979);
  double const before = std::accumulate(patch.h.begin(), patch.h.end(), 0.0);
  patch.keyhole.update(patch.h, patch.table, patch.beam);
  double const expected = 2 * (surface - patch.wall_temperature(R)) / gradient;
  EXPECT_GT(expected, 60e-6);
  EXPECT_NEAR(patch.keyhole.depth(), expected, 5e-6) << "cells give way one by one";
  EXPECT_NEAR(std::accumulate(patch.h.begin(), patch.h.end(), 0.0) / before, 1, 1e-13);
  double const middle = patch.keyhole.wall()[20 + 40 * 20], beside = patch.keyhole.wall()[2 + 40 * 20];
  EXPECT_NEAR(200e-6 - middle, expected, 5e-6);
  EXPECT_TRUE(std::isinf(beside));
}

TEST(Keyhole, ClosesWhereTheBeamNoLongerReachesAndLeavesTheHeat) {
  Patch patch;
  patch.heat(30e-6, [&](double depth) { return 4200 - 2e7 * depth; });
  patch.keyhole.update(patch.h, patch.table, patch.beam);
  ASSERT_FALSE(patch.keyhole.wall().empty());
  double const deepest = patch.keyhole.deepest();
  std::vector<double> const before = patch.h;
  patch.keyhole.update(patch.h, patch.table, {{100e-6, 100e-6, 0}, -1});
  EXPECT_TRUE(patch.keyhole.wall().empty());
  EXPECT_EQ(patch.keyhole.depth(), 0);
  EXPECT_EQ(patch.keyhole.deepest(), deepest);
  EXPECT_EQ(patch.h, before) << "the wall alone is not hot enough to open it again";
}

/// Light heats one side of the wall: what it holds beyond T_w shows up on the rest of the wall, share for share of what
/// that lacks.
TEST(Keyhole, VapourCarriesHeatFromHotWallToCold) {
  Patch patch;
  patch.heat(30e-6, [&](double depth) { return 4200 - 2e7 * depth; });
  patch.keyhole.update(patch.h, patch.table, patch.beam);
  auto const hot = static_cast<std::size_t>(patch.cells.grid.index(26, 20, 33));  // just beside the cavity
  double const cold_before = patch.h[static_cast<std::size_t>(patch.cells.grid.index(13, 20, 33))];
  ASSERT_LT(patch.h[hot], patch.table.enthalpy(2900));
  patch.h[hot] = patch.table.enthalpy(8000);
  double const sum = std::accumulate(patch.h.begin(), patch.h.end(), 0.0);
  patch.keyhole.update(patch.h, patch.table, patch.beam);
  EXPECT_NEAR(patch.table.temperature(patch.h[hot]), patch.keyhole.wall_temperature(), 1);
  EXPECT_GT(patch.h[static_cast<std::size_t>(patch.cells.grid.index(13, 20, 33))], cold_before);
  EXPECT_NEAR(std::accumulate(patch.h.begin(), patch.h.end(), 0.0) / sum, 1, 1e-13);
}

HeatOutcome on_plate(double strength, double absorbed) {
  CellContent const content = solid_block(5e-6, {60, 40, 24});
  HeatSettings const settings = closed_settings(5e-6);
  Effects effects = effects_on({"latent_heat", "evaporation"});
  if (strength >= 0) effects["keyhole"] = {true, strength, {}};
  HeatSource source = gaussian_track(content.grid, absorbed, 60e-6, 0.5, 80e-6, 220e-6, 100e-6, 0.5e-6);
  source.beam_radius = 30e-6;
  Material metal = boiling_metal();
  metal.latent_heat = 2.6e5;
  return expose(content, source, metal, settings, effects, SideY::far_field, Communicator(), Report::silent);
}

TEST(Keyhole, OfNoStrengthChangesNothing) {
  HeatOutcome const without = on_plate(-1, 25), null = on_plate(0, 25), with = on_plate(1, 25);
  EXPECT_EQ(null.melt.peak_temperature, without.melt.peak_temperature);
  EXPECT_EQ(null.melt.time_above_liquidus, without.melt.time_above_liquidus);
  EXPECT_EQ(null.heat_stored, without.heat_stored);
  EXPECT_EQ(null.keyhole_depth, 0);
  EXPECT_GT(with.keyhole_depth, 10e-6);
  EXPECT_LT(with.heat_energy_relative_error, 1e-12);
  EXPECT_GT(with.melt.pool.depth, without.melt.pool.depth) << "heat goes down with the wall";
}

}  // namespace
}  // namespace layerloop::thermal
