#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "plate.hpp"
#include "thermal/effects/evaporation.hpp"
#include "thermal/enthalpy_table.hpp"

namespace layerloop::thermal {
namespace {

std::vector<std::int64_t> every_cell(VoxelGrid const& grid) {
  std::vector<std::int64_t> cells(static_cast<std::size_t>(grid.size()));
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

HeatOutcome run(CellContent const& content, HeatSource const& source, Material const& metal,
                HeatSettings const& settings, Effects const& effects) {
  return expose(content, source, metal, settings, effects, SideY::periodic, Communicator(), Report::silent);
}

TEST(Energy, UniformHeatingIsExact) {
  CellContent const block = solid_block(5e-6, {6, 5, 4});
  double const rise = 700, duration = 20e-6;
  double const watts = 7300 * 789 * rise * block.grid.cell_volume() / duration;
  HeatOutcome const result = run(block, constant_source(every_cell(block.grid), watts, duration),
                                 constant_metal(24, 7300, 789), closed_settings(5e-6), effects_on({}));
  for (float T : result.melt.peak_temperature) EXPECT_NEAR(T, 298 + rise, 1e-4);  // stored in single precision
  EXPECT_NEAR(result.heat_stored / (watts * 120 * duration), 1, 1e-13);
  EXPECT_EQ(result.heat_out, 0);
}

/// Heating IN718 from ambient to T takes density * (int cp dT + L); the integral by Simpson's rule, exact for the
/// piecewise linear cp when its points are among the nodes.
TEST(Energy, MeltingStoresTheLatentHeat) {
  Material const metal = built_in_materials().at("IN718");
  double const T = 2000;
  double sensible = 0;
  for (int t = 298; t < T; ++t)
    sensible += (metal.specific_heat(t) + 4 * metal.specific_heat(t + 0.5) + metal.specific_heat(t + 1)) / 6;
  double const stored = metal.density * (sensible + metal.latent_heat);

  CellContent const block = solid_block(5e-6, {4, 4, 4});
  double const duration = 50e-6, watts = stored * block.grid.cell_volume() / duration;
  HeatOutcome const result = run(block, constant_source(every_cell(block.grid), watts, duration), metal,
                                 closed_settings(5e-6), effects_on({"latent_heat"}));
  for (float peak : result.melt.peak_temperature) EXPECT_NEAR(peak, T, 1e-3);
  for (char melted : result.melt.melted) EXPECT_TRUE(melted);
}

TEST(Energy, TableInvertsItself) {
  for (auto const& [name, metal] : built_in_materials()) {
    EnthalpyTable const table(metal, 298, 1.5 * metal.boiling_point);
    for (double T = 298; T < 1.5 * metal.boiling_point; T += 7.3) {
      if (T == metal.solidus) continue;
      EXPECT_NEAR(table.temperature(table.enthalpy(T)), T, 1e-8 * T) << name;
    }
    double const plateau = table.liquidus() - table.solidus();
    EXPECT_GE(plateau, 0.999999 * metal.density * metal.latent_heat) << name;
  }
}

/// A cell under constant power with nowhere else to lose heat boils at q_evaporation(T) = power / area.
TEST(Energy, EvaporatingCellSettlesWhereTheSinkEqualsThePower) {
  Material metal = constant_metal(28, 7300, 800);
  metal.boiling_point = 3086, metal.heat_of_vaporisation = 6.3e6, metal.molar_mass = 0.0558;
  Evaporation const evaporation(metal, 1);
  CellContent const cell = solid_block(5e-6, {1, 1, 1});  // open at the top only
  double const watts = evaporation.flux(3400) * 25e-12;
  HeatOutcome const result =
      run(cell, constant_source({0}, watts, 400e-6), metal, closed_settings(5e-6), effects_on({"evaporation"}));
  EXPECT_NEAR(result.peak_temperature, 3400, 3400 * 1e-6);
  EXPECT_LT(result.heat_energy_relative_error, 1e-12);
  EXPECT_NEAR(result.mass_evaporated, result.heat_evaporated / 6.3e6, 1e-30);
}

/// Share of its heat that a slab keeps when its top is cooled by convection for a Fourier number of 0.5, Biot number 1.
double heat_kept(std::int32_t n) {
  double const depth = 1e-3, cell = depth / n;
  Material const metal = constant_metal(25, 7500, 700);
  Effects effects = effects_on({"surface_losses"});
  effects["surface_losses"].parameters["convection"] = 25 / depth;
  CellContent const slab = solid_block(cell, {1, 1, n});
  double const diffusivity = 25.0 / (7500.0 * 700), rest = 0.5 * depth * depth / diffusivity;
  double const pulse = 1e-7 * rest;  // heats the slab evenly
  double const watts = 7500.0 * 700 * 500 * slab.grid.cell_volume() / pulse;
  HeatSource source = constant_source(every_cell(slab.grid), watts, pulse);
  source.power.push_back({});
  source.time.push_back(pulse + rest);
  HeatOutcome const result = run(slab, source, metal, closed_settings(cell), effects);
  EXPECT_LT(result.heat_energy_relative_error, 1e-11);
  return result.heat_stored / result.heat_in;
}

/// zeta tan zeta = Bi; kept = sum 4 sin z / (2 z + sin 2z) sin z / z exp(-z^2 Fo).
TEST(Energy, ConvectionCoolsASlabLikeTheBiotSeries) {
  double kept = 0;
  for (int root = 0; root < 6; ++root) {
    double low = root * std::numbers::pi, high = low + 0.5 * std::numbers::pi;
    for (int i = 0; i < 100; ++i) {
      double const z = 0.5 * (low + high), sign = root % 2 == 0 ? 1 : -1;
      (sign * (z * std::sin(z) - std::cos(z)) < 0 ? low : high) = z;
    }
    double const z = low;
    kept += 4 * std::sin(z) / (2 * z + std::sin(2 * z)) * std::sin(z) / z * std::exp(-z * z * 0.5);
  }
  double const coarse = heat_kept(100), fine = heat_kept(200);
  std::printf("slab keeps %.6f and %.6f of its heat, exact %.6f\n", coarse, fine, kept);
  EXPECT_NEAR(fine, kept, 1e-3 * kept);               // the sink sees the centre of the cell: first order
  EXPECT_NEAR(2 * fine - coarse, kept, 1e-5 * kept);  // that order taken out
}

/// A cell that radiates from its top: with u = T / Ta and one for its start,
///   4 e sigma A Ta^3 t / (rho c V) = [ln((u + 1) / (u - 1)) + 2 atan u] from the start to u.
TEST(Energy, RadiatingCellCoolsByTheClosedForm) {
  double const cell = 5e-6, start = 1600, pulse = 1e-6, rest = 20e-3, ambient = 298;
  Material metal = constant_metal(24, 7300, 789);
  metal.emissivity = 0.9;
  Effects effects = effects_on({"surface_losses"});
  effects["surface_losses"].parameters["convection"] = 0;
  double const heat = 7300 * 789 * (start - ambient) * std::pow(cell, 3);
  HeatSource source = constant_source({0}, heat / pulse, pulse);
  source.power.push_back({});
  source.time.push_back(pulse + rest);
  HeatOutcome const result = run(solid_block(cell, {1, 1, 1}), source, metal, closed_settings(cell), effects);
  double const end = ambient + (start - ambient) * result.heat_stored / result.heat_in;
  auto const along = [&](double T) {
    double const u = T / ambient;
    return std::log((u + 1) / (u - 1)) + 2 * std::atan(u);
  };
  double const rate = 4 * 0.9 * 5.670374419e-8 * std::pow(ambient, 3) / (7300 * 789 * cell);
  EXPECT_LT(end, start - 100);
  EXPECT_NEAR((along(end) - along(start)) / (rate * rest), 1, 1e-3);
}

TEST(Energy, PowerInGasIsMovedNotLost) {
  CellContent content = solid_block(5e-6, {6, 6, 6});
  for (std::int64_t c = 0; c < content.grid.size(); ++c) {
    if (content.grid.coordinates(c)[2] >= 4) content.solid[static_cast<std::size_t>(c)] = 0;
  }
  content.solid[static_cast<std::size_t>(content.grid.index(2, 2, 4))] = 0.1;  // too little for an unknown of its own
  std::vector<std::int64_t> const places{content.grid.index(2, 2, 3), content.grid.index(2, 2, 4),
                                         content.grid.index(3, 3, 5)};
  HeatOutcome const result = run(content, constant_source(places, 1e-3, 10e-6), constant_metal(24, 7300, 789),
                                 closed_settings(5e-6), effects_on({}));
  EXPECT_NEAR(result.heat_in, 3e-8, 1e-20);
  EXPECT_NEAR(result.heat_stored / 3e-8, 1, 1e-13);
  EXPECT_NEAR(result.moved_power_share, 2.0 / 3, 1e-12);
  auto const peak = [&](std::int64_t c) { return result.melt.peak_temperature[static_cast<std::size_t>(c)]; };
  EXPECT_EQ(peak(places[0]), peak(places[1]));  // shares the unknown of the cell below
  EXPECT_EQ(peak(places[2]), 298);              // gas stays out of the record
}

TEST(Energy, TooHotIsStoppedWithTheRemedy) {
  CellContent const block = solid_block(5e-6, {2, 2, 2});
  Material metal = constant_metal(24, 7300, 789);
  metal.boiling_point = 3000;
  try {
    run(block, constant_source({0}, 1, 100e-6), metal, closed_settings(5e-6), effects_on({}));
    FAIL() << "not stopped";
  } catch (PhysicsError const& error) {
    EXPECT_NE(std::string(error.what()).find("effects.evaporation"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("laser.power"), std::string::npos);
  }
}

TEST(Energy, ArraysThatDoNotFitAreRefused) {
  CellContent block = solid_block(5e-6, {2, 2, 2});
  HeatSource const outside = constant_source({8}, 1e-3, 1e-6);
  Material const metal = constant_metal(24, 7300, 789);
  EXPECT_THROW(run(block, outside, metal, closed_settings(5e-6), effects_on({})), InputError);
  block.powder.pop_back();
  EXPECT_THROW(run(block, constant_source({0}, 1e-3, 1e-6), metal, closed_settings(5e-6), effects_on({})), InputError);
}

}  // namespace
}  // namespace layerloop::thermal
