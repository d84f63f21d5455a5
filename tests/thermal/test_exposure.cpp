#include <gtest/gtest.h>

#include "plate.hpp"

namespace layerloop::thermal {
namespace {

Effects all_effects() { return effects_on({"latent_heat", "variable_conductivity", "evaporation", "surface_losses"}); }

HeatSettings open_settings(HeatSolver solver = HeatSolver::explicit_steps) {
  HeatSettings settings = closed_settings(5e-6);
  settings.margin = settings.substrate_depth = 50e-6;
  settings.powder_contact_conductivity = 0.5;
  settings.solver = solver;
  return settings;
}

HeatOutcome track_on_grains(HeatSettings const& settings, Effects const& effects, double absorbed = 25) {
  CellContent const content = plate_with_grains({40, 24, 18}, 11);
  HeatSource const source = beam_from_above(content, absorbed, 35e-6, 1.0, 50e-6, 150e-6);
  return expose(content, source, with_effects(built_in_materials().at("IN718"), effects), settings, effects,
                SideY::periodic, Communicator(), Report::silent);
}

void expect_same_bits(HeatOutcome const& a, HeatOutcome const& b) {
  EXPECT_EQ(a.melt.peak_temperature, b.melt.peak_temperature);
  EXPECT_EQ(a.melt.time_above_liquidus, b.melt.time_above_liquidus);
  EXPECT_EQ(a.melt.melted, b.melt.melted);
  EXPECT_EQ(a.heat_stored, b.heat_stored);
  EXPECT_EQ(a.heat_out, b.heat_out);
}

TEST(Exposure, EveryEffectIsNeutralAtItsNullValue) {
  for (char const* name : {"latent_heat", "variable_conductivity", "evaporation", "surface_losses"}) {
    Effects off = all_effects(), null = all_effects();
    off[name].enabled = false;
    null[name].strength = 0;
    double const absorbed = 10;  // stays below the limit without evaporation
    HeatOutcome const without = track_on_grains(open_settings(), off, absorbed);
    expect_same_bits(without, track_on_grains(open_settings(), null, absorbed));
    HeatOutcome const with = track_on_grains(open_settings(), all_effects(), absorbed);
    EXPECT_NE(without.heat_stored, with.heat_stored) << name;
  }
}

TEST(Exposure, EnergyIsBalancedWithEverythingOn) {
  HeatOutcome const result = track_on_grains(open_settings(), all_effects());
  EXPECT_LT(result.heat_energy_relative_error, 1e-12);
  EXPECT_NEAR(result.heat_stored + result.heat_out, result.heat_in, 1e-12 * result.heat_in);
  EXPECT_GT(result.heat_evaporated, 0);
  EXPECT_GT(result.heat_out, result.heat_evaporated);
}

TEST(Exposure, MirroredBedGivesMirroredPeaks) {
  HeatOutcome const result = track_on_grains(open_settings(), all_effects());
  VoxelGrid const& grid = result.melt.grid;
  for (std::int64_t c = 0; c < grid.size(); ++c) {
    auto const [i, j, k] = grid.coordinates(c);
    auto const mirrored = static_cast<std::size_t>(grid.index(i, grid.n[1] - 1 - j, k));
    EXPECT_NEAR(result.melt.peak_temperature[static_cast<std::size_t>(c)], result.melt.peak_temperature[mirrored],
                1e-3);
  }
}

/// A beam that stands still for 150 us on a plate: long against a step of either kind, so that first order in time is
/// not what is compared.
HeatOutcome spot_on_plate(HeatSolver solver) {
  CellContent const content = solid_block(5e-6, {20, 20, 10});
  HeatSource source = beam_from_above(content, 9, 35e-6, 1.0, 45e-6, 55e-6);
  source.time = {0, 150e-6};
  source.tracks.clear();
  return expose(content, source, built_in_materials().at("IN718"), open_settings(solver), all_effects(),
                SideY::periodic, Communicator(), Report::silent);
}

TEST(Exposure, ImplicitStepsAreAnOracleForExplicitOnes) {
  HeatOutcome const result = spot_on_plate(HeatSolver::explicit_steps);
  HeatOutcome const oracle = spot_on_plate(HeatSolver::implicit_steps);
  for (HeatOutcome const& o : {result, oracle}) {
    std::printf("peak %.1f K, evaporated %.6g J, %ld cells melted, frozen at %.4g ms, %ld + %ld steps, energy %.2g\n",
                o.peak_temperature, o.heat_evaporated, std::ranges::count(o.melt.melted, 1), o.end_time * 1e3,
                o.explicit_steps, o.implicit_steps, o.heat_energy_relative_error);
  }
  EXPECT_EQ(oracle.explicit_steps, 0);
  EXPECT_EQ(result.implicit_steps, 0);
  EXPECT_EQ(oracle.melt.melted, result.melt.melted);
  EXPECT_GT(std::ranges::count(result.melt.melted, 1), 100);
  for (std::size_t c = 0; c < result.melt.melted.size(); ++c) {
    if (!result.melt.melted[c]) continue;  // others peak after the run has ended, which the two see at different times
    EXPECT_NEAR(oracle.melt.peak_temperature[c] / result.melt.peak_temperature[c], 1, 0.005);
  }
  EXPECT_GT(result.heat_evaporated, 1e-4 * result.heat_in);
  EXPECT_NEAR(oracle.heat_evaporated / result.heat_evaporated, 1, 0.03);  // 0.6 % a kelvin
  EXPECT_LT(oracle.heat_energy_relative_error, 1e-10);
}

/// A dwell of a second after a pulse: the stages of a few super steps end where ten thousands of explicit steps do.
TEST(Exposure, AutomaticTakesLongStepsThroughADwell) {
  HeatSettings settings = closed_settings(20e-6);
  settings.margin = settings.substrate_depth = 1e-3;
  CellContent const content = solid_block(20e-6, {10, 6, 12});
  HeatSource source = constant_source({content.grid.index(5, 3, 11)}, 3, 100e-6);
  source.power.push_back({});
  source.time.push_back(1);
  auto const run = [&](HeatSolver solver) {
    settings.solver = solver;
    return expose(content, source, built_in_materials().at("IN718"), settings, all_effects(), SideY::periodic,
                  Communicator(), Report::silent);
  };
  HeatOutcome const all = run(HeatSolver::explicit_steps), few = run(HeatSolver::automatic);
  std::printf("explicit: %ld steps, stored %.6g of %.6g J; automatic: %ld + %ld steps, stored %.6g J\n",
              all.explicit_steps, all.heat_stored, all.heat_in, few.explicit_steps, few.implicit_steps,
              few.heat_stored);
  EXPECT_EQ(few.implicit_steps, 0);
  EXPECT_LT(few.explicit_steps, all.explicit_steps / 10);
  EXPECT_LT(few.heat_energy_relative_error, 1e-12);
  EXPECT_NEAR(few.heat_stored, all.heat_stored, 0.01 * all.heat_in);
  EXPECT_EQ(few.melt.melted, all.melt.melted);
}

/// A grain passes its heat on slowly until it melts; then it wets the plate.
TEST(Exposure, MeltWetsWhatItTouches) {
  CellContent content = solid_block(5e-6, {3, 3, 4});
  auto const grain = static_cast<std::size_t>(content.grid.index(1, 1, 3));
  for (std::int64_t c = content.grid.index(0, 0, 3); c < content.grid.size(); ++c)
    content.solid[static_cast<std::size_t>(c)] = 0;
  content.powder[grain] = 1;
  content.grain[grain] = 0;
  HeatSettings settings = closed_settings(5e-6);
  Material const metal = constant_metal(24, 7300, 789);
  struct Temperatures {
    double grain, plate;
  };
  auto const heat_grain = [&](double watts, double duration) {
    HeatOutcome const o = expose(content, constant_source({static_cast<std::int64_t>(grain)}, watts, duration), metal,
                                 settings, effects_on({}), SideY::adiabatic, Communicator(), Report::silent);
    return Temperatures{o.peak_temperature,
                        o.melt.peak_temperature[static_cast<std::size_t>(content.grid.index(1, 1, 2))]};
  };
  double const contact = 1 / (1 / 24.0 + 1 / 0.3), watts = contact * 5e-6 * 500;  // for a steady difference of 500 K
  Temperatures const cold = heat_grain(watts, 4e-3);
  double const passed_on = watts * 27 / 28;  // one cell of 28 stays in step with the rest
  EXPECT_NEAR(passed_on / (5e-6 * (cold.grain - cold.plate)), contact, 0.005 * contact);
  // Enough to pass 5000 K without wetting; with it the grain cools to within watts / (24 * 5 um) = 200 K of the plate.
  Temperatures const wet = heat_grain(0.024, 200e-6);
  EXPECT_GT(wet.grain, 1708);
  EXPECT_LT(wet.grain, 1760);
}

}  // namespace
}  // namespace layerloop::thermal
