#include <gtest/gtest.h>
#include <omp.h>

#include <numbers>

#include "heated_block.hpp"
#include "thermal/bulk_flow.hpp"
#include "thermal/heat_bench.hpp"
#include "thermal/heat_system.hpp"

namespace layerloop::thermal {
namespace {

/// A plate with grains that starts hot in the middle, and power on part of it.
struct HotPlate {
  HeatCells cells = make_heat_cells(plate_with_grains({20, 14, 12}, 6), SideY::periodic);
  EnthalpyTable table{built_in_materials().at("IN718"), 298, 4500};
  HeatGrid grid{cells.grid, true, Communicator()};
  HeatSystem system =
      make_heat_system(table, grid, make_conduction(cells, grid.box(), {40e-6, 40e-6}, 25, 0.3), SurfaceSink{});
  std::vector<CellPower> source;
  double step = 0;

  HotPlate() {
    for (std::int64_t c = cells.grid.size() - 1; c >= 0; --c) {
      if (cells.fill[static_cast<std::size_t>(c)] == 0) continue;
      auto const at = cells.grid.coordinates(c);
      std::int64_t const own = grid.box().own(at);
      double const r2 = std::pow(at[0] - 9.3, 2) + std::pow(at[1] - 6.1, 2) + std::pow(at[2] - 6.0, 2);
      system.enthalpy[static_cast<std::size_t>(own)] = 1.4 * table.liquidus() * std::exp(-r2 / 30);
      if (r2 < 9) source.push_back({own, 0.01 / (1 + r2)});
    }
    finish_step(system, 0);
    step = 0.9 * stable_step(system.conduction, table);
  }
};

/// The same step from its parts, one sweep each: every face with its share, every cell with its capacity.
void step_by_parts(HeatSystem& system, std::vector<CellPower> const& source, double dt) {
  Conduction const& conduction = system.conduction;
  auto const before = system.enthalpy;
  auto const T = [&](std::int64_t c) { return system.table.temperature(before[static_cast<std::size_t>(c)]); };
  auto const theta = [&](std::int64_t c) { return system.integral[static_cast<std::size_t>(c)]; };
  auto const heat = [&](std::int64_t c, double flow) {
    system.enthalpy[static_cast<std::size_t>(c)] += dt * (conduction.per_capacity[static_cast<std::size_t>(c)] * flow);
  };
  for (ContactFace const& face : conduction.contacts)
    heat(face.cell, face.conductivity * (T(face.neighbour) - T(face.cell)));
  for (FarFace const& face : conduction.far) {
    heat(face.cell, -face.share * theta(face.cell));
    system.heat_to_far_field += dt * face.share * theta(face.cell) * conduction.cell;
  }
  for (CellPower const& heated : source) heat(heated.cell, heated.watts / conduction.cell);
  BulkFlow const bulk(conduction);
  for (Row const& row : conduction.rows) {
    for (std::int64_t c = row.begin; c < row.end; ++c) heat(c, bulk(c, theta, theta, theta, theta));
  }
  finish_step(system, dt);
}

TEST(ExplicitStep, OnePassHasTheBitsOfItsParts) {
  HotPlate fused, parts;
  fused.system.floor = -1;  // no cell is too cold to conduct
  std::int64_t uniform = 0;
  for (Row const& row : fused.system.conduction.uniform) uniform += row.end - row.begin;
  EXPECT_GT(uniform, 500);  // both kinds of cells are in it
  EXPECT_LT(uniform, fused.cells.unknowns - 100);
  EXPECT_FALSE(fused.system.conduction.contacts.empty());
  auto const melted_before = std::ranges::count(fused.system.melted, 1);
  for (int i = 0; i < 100; ++i) {
    explicit_step(fused.system, fused.source, fused.step);
    step_by_parts(parts.system, parts.source, parts.step);
  }
  EXPECT_GT(std::ranges::count(fused.system.melted, 1), melted_before);
  EXPECT_NEAR(fused.system.heat_to_far_field, parts.system.heat_to_far_field, 1e-13 * parts.system.heat_to_far_field);
  for (Row const& row : fused.system.conduction.rows) {
    for (auto c = static_cast<std::size_t>(row.begin); c < static_cast<std::size_t>(row.end); ++c) {
      ASSERT_EQ(fused.system.enthalpy[c], parts.system.enthalpy[c]);
      ASSERT_EQ(fused.system.peak[c], parts.system.peak[c]);
      ASSERT_EQ(fused.system.time_above_liquidus[c], parts.system.time_above_liquidus[c]);
      ASSERT_EQ(fused.system.melted[c], parts.system.melted[c]);
    }
  }
}

/// A spot that moves over a plate with grains, cold at first. Leaving cold cells out costs not a bit.
TEST(ExplicitStep, SleepingCellsLeaveTheSameBits) {
  auto const run = [](bool all_awake) {
    CellContent const content = plate_with_grains({40, 28, 16}, 10);
    HeatedBlock block(content, built_in_materials().at("316L"), {50e-6, 50e-6}, 0.5, SideY::periodic);
    if (all_awake) block.system.awake.cold = AwakeRows::Cold::awake;
    double const step = 0.9 * stable_step(block.system.conduction, block.table);
    std::int64_t awake = 0, cells = 0;
    for (int i = 0; i < 90; ++i) {
      std::vector<CellPower> const source{{block.local(8 + i / 6, 27, 9), 0.05}, {block.local(8 + i / 6, 0, 9), 0.05}};
      explicit_step(block.system, source, step);
      for (Row const& row : block.system.awake.stepped()) awake += row.end - row.begin;
      for (Row const& row : block.system.conduction.rows) cells += row.end - row.begin;
    }
    double const in = 90 * step * 0.1;
    EXPECT_NEAR((stored_heat(block.system) + block.system.heat_to_far_field) / in, 1, 1e-13);
    EXPECT_TRUE(all_awake ? awake == cells : awake < cells / 2) << awake << " of " << cells;
    return std::pair{block.system.enthalpy, block.system.peak};
  };
  EXPECT_EQ(run(false), run(true));
}

/// Metal that keeps its heat while it is cold changes the hottest place of a pool, and its size, by less than 0.1 %.
TEST(ExplicitStep, SleepMovesThePoolByLessThanAThousandth) {
  auto const pool = [](double floor) {
    HeatedBlock block(solid_block(5e-6, {60, 60, 40}), built_in_materials().at("316L"), {150e-6, 150e-6});
    block.system.floor *= floor;
    std::vector<CellPower> source;
    for (std::int32_t j = 25; j < 35; ++j) {
      for (std::int32_t i = 25; i < 35; ++i) source.push_back({block.local(i, j, 39), 0.08});
    }
    double const step = 0.9 * stable_step(block.system.conduction, block.table);
    for (int s = 0; s < 250; ++s) explicit_step(block.system, source, step);
    double melt = 0;  // enthalpy above the solidus: moves smoothly, unlike a count of cells
    for (double const h : block.system.enthalpy) melt += std::max(0.0, h - block.table.solidus());
    return std::pair{hottest(block.system), melt};
  };
  auto const [top, melt] = pool(1);
  auto const [exact_top, exact_melt] = pool(1e-6);
  EXPECT_GT(exact_melt, 0);
  EXPECT_NE(melt, exact_melt);
  EXPECT_NEAR(top / exact_top, 1, 1e-3);
  EXPECT_NEAR(melt / exact_melt, 1, 1e-3);
}

TEST(ExplicitStep, ThreadsLeaveTheSameBits) {
  CellContent const content = plate_with_grains({20, 14, 12}, 6);
  HeatSettings settings = closed_settings(5e-6);
  settings.margin = settings.substrate_depth = 40e-6;
  auto const run = [&](int threads) {
    omp_set_num_threads(threads);
    HeatOutcome const outcome =
        expose(content, beam_from_above(content, 20, 30e-6, 1.0, 30e-6, 70e-6), built_in_materials().at("IN718"),
               settings, effects_on({"latent_heat", "variable_conductivity", "evaporation", "surface_losses"}),
               SideY::periodic, Communicator(), Report::silent);
    omp_set_num_threads(1);
    return outcome;
  };
  HeatOutcome const alone = run(1);
  EXPECT_GT(alone.heat_evaporated, 0);
  for (int const threads : {2, 5}) {
    HeatOutcome const shared = run(threads);
    EXPECT_EQ(shared.melt.peak_temperature, alone.melt.peak_temperature);
    EXPECT_EQ(shared.melt.time_above_liquidus, alone.melt.time_above_liquidus);
    EXPECT_EQ(shared.heat_stored, alone.heat_stored);
    EXPECT_EQ(shared.heat_out, alone.heat_out);
  }
}

/// A bar with a cosine along x of constant properties: the mode decays as exp(-t rate) with the rate of seven cells.
TEST(SuperStep, IsOfSecondOrderAndKeepsTheHeat) {
  std::int32_t const n = 16;
  double const cell = 5e-6, a = 24 / (7300.0 * 789), p = std::numbers::pi / n;
  double const rate = a / (cell * cell) * 2 * (1 - std::cos(p)), duration = 1 / rate;
  auto const error = [&](int steps) {
    HeatedBlock bar(solid_block(cell, {n, 1, 1}), constant_metal(24, 7300, 789));
    auto const exact = [&](std::int32_t i, double t) {
      return 600 + 200 * std::cos(p * (i + 0.5)) * std::exp(-rate * t);
    };
    for (std::int32_t i = 0; i < n; ++i) bar.enthalpy(i, 0, 0) = bar.table.enthalpy(exact(i, 0));
    double const dt = duration / steps, before = stored_heat(bar.system);
    int const stages = super_step_stages(dt, stable_step(bar.system.conduction, bar.table));
    for (int s = 0; s < steps; ++s) super_step(bar.system, {}, dt, stages);
    EXPECT_NEAR(stored_heat(bar.system) / before, 1, 1e-13);
    return std::abs(bar.temperature(0, 0, 0) - exact(0, duration));
  };
  double const coarse = error(4), fine = error(8);
  std::printf("super steps: %.3g K, then %.3g K\n", coarse, fine);
  EXPECT_LT(coarse, 1);
  EXPECT_GT(std::log2(coarse / fine), 1.8);
}

TEST(HeatBench, CountsWhatItDoes) {
  HeatBench const bench = bench_heat(40 * 40 * 40, 2, 1);
  EXPECT_EQ(bench.cells, 64000);
  EXPECT_GT(bench.liquid_share, 0.005);
  EXPECT_GE(bench.bytes_per_update, 24);  // enthalpy and peak, and what rows with liquid need
  EXPECT_LE(bench.bytes_per_update, 24 + 9);
  EXPECT_NEAR(bench.share_of_triad, 24 * bench.cell_updates_per_second / bench.triad_bytes_per_second,
              0.5 * bench.share_of_triad);  // medians of both, and of their ratio
}

}  // namespace
}  // namespace layerloop::thermal
