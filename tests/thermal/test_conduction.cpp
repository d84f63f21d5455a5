#include <gtest/gtest.h>

#include "heated_block.hpp"

namespace layerloop::thermal {
namespace {

/// Balances [W/m] of a bar along z at given temperatures, lowest first.
std::vector<double> balances(HeatedBlock& bar, std::vector<double> const& temperature) {
  for (std::size_t k = 0; k < temperature.size(); ++k) {
    bar.enthalpy(0, 0, static_cast<std::int32_t>(k)) = bar.table.enthalpy(temperature[k]);
  }
  finish_step(bar.system, 0);
  conduction_balance(bar.system.conduction, bar.table, bar.system.enthalpy, bar.system.integral, bar.system.balance);
  std::vector<double> result;
  for (std::size_t k = 0; k < temperature.size(); ++k) {
    result.push_back(bar.system.balance[static_cast<std::size_t>(bar.local(0, 0, static_cast<std::int32_t>(k)))]);
  }
  return result;
}

/// What a flux (W/m^2) through a bar leaves behind: it enters at the top, leaves at the bottom, and stays nowhere.
void expect_steady(std::vector<double> const& balance, double flux, double cell, double tolerance) {
  double const through = flux * cell;
  EXPECT_NEAR(balance.front() / through, 1, tolerance);
  EXPECT_NEAR(balance.back() / through, -1, tolerance);
  for (std::size_t k = 1; k + 1 < balance.size(); ++k) EXPECT_NEAR(balance[k] / through, 0, tolerance) << k;
}

/// A grain on a plate whose contact conducts a thousandth of the metal: resistances in series, the harmonic mean.
TEST(Conduction, ContactIsInSeriesWithTheMetal) {
  double const cell = 5e-6, k = 24, contact = 0.024, flux = 2e6;
  std::int32_t const n = 12, first_of_grain = 6;
  CellContent content = solid_block(cell, {1, 1, n});
  for (auto c = static_cast<std::size_t>(first_of_grain); c < static_cast<std::size_t>(n); ++c) {
    content.solid[c] = 0, content.powder[c] = 1, content.grain[c] = 0;
  }
  HeatedBlock bar(content, constant_metal(k, 7300, 789), {infinite, infinite}, contact);
  std::vector<double> temperature{400};
  for (std::int32_t at = 1; at < n; ++at) {
    double const resistance = at == first_of_grain ? cell * (1 / k + 1 / contact) : cell / k;
    temperature.push_back(temperature.back() + flux * resistance);
  }
  expect_steady(balances(bar, temperature), flux, cell, 1e-10);
}

/// One metal whose k rises a thousandfold at 2300 K. The integral of k is linear along the bar, T has a kink.
TEST(Conduction, FluxIsExactAcrossAJumpOfConductivity) {
  double const cell = 5e-6, poor = 0.024, good = 24, kink = 2300;
  Material metal = constant_metal(good, 7300, 789);
  metal.conductivity = {{298, kink - 1e-9, kink}, {poor, poor, good}};
  HeatedBlock bar(solid_block(cell, {1, 1, 12}), metal);
  double const until_kink = poor * (kink - 298), flux = until_kink / (1.5 * cell);  // between the second and third
  std::vector<double> temperature;
  for (int at = 0; at < 12; ++at) {
    double const integral = at * cell * flux;
    temperature.push_back(integral < until_kink ? 298 + integral / poor : kink + (integral - until_kink) / good);
  }
  expect_steady(balances(bar, temperature), flux, cell, 1e-8);
}

TEST(Conduction, UniformHeatingRaisesEveryCellAlike) {
  double const cell = 5e-6, rise = 700, dt = 1e-7;
  int const steps = 200;
  HeatedBlock block(solid_block(cell, {6, 5, 4}), constant_metal(24, 7300, 789));
  std::vector<CellPower> source;
  block.for_cells([&](std::int32_t i, std::int32_t j, std::int32_t k, Vec3 const&) {
    source.push_back({block.local(i, j, k), 7300 * 789 * rise * std::pow(cell, 3) / (steps * dt)});
  });
  for (int s = 0; s < steps; ++s) explicit_step(block.system, source, dt);
  block.for_cells([&](std::int32_t i, std::int32_t j, std::int32_t k, Vec3 const&) {
    EXPECT_NEAR(block.temperature(i, j, k), 298 + rise, 1e-9 * (298 + rise));
  });
}

/// Grains on a plate under a beam that melts some of them: y -> -y to round-off.
TEST(Conduction, MirroredGrainsStayMirrored) {
  CellContent const content = plate_with_grains({40, 24, 18}, 11);
  HeatedBlock block(content, built_in_materials().at("IN718"), {50e-6, 50e-6}, 0.5, SideY::periodic);
  HeatSource const beam = beam_from_above(content, 15, 35e-6, 1, 50e-6, 150e-6);
  double const dt = 0.9 * stable_step(block.system.conduction, block.table);
  for (std::size_t m = 0; m < beam.power.size(); ++m) {
    std::vector<CellPower> source;
    for (std::size_t c = 0; c < beam.power[m].cell.size(); ++c) {
      std::int64_t const host = block.cells.host[static_cast<std::size_t>(beam.power[m].cell[c])];
      source.push_back({block.grid.box().own(content.grid.coordinates(host)), beam.power[m].watts[c]});
    }
    double const duration = beam.time[m + 1] - beam.time[m];
    auto const steps = static_cast<int>(std::ceil(duration / dt));
    for (int s = 0; s < steps; ++s) explicit_step(block.system, source, duration / steps);
  }
  double hottest = 0, difference = 0;
  block.for_cells([&](std::int32_t i, std::int32_t j, std::int32_t k, Vec3 const&) {
    double const T = block.temperature(i, j, k);
    hottest = std::max(hottest, T);
    difference = std::max(difference, std::abs(T - block.temperature(i, content.grid.n[1] - 1 - j, k)));
  });
  std::printf("hottest %.1f K, sides differ by %.2g K\n", hottest, difference);
  EXPECT_GT(hottest, 1609);
  EXPECT_LT(difference, 1e-9 * hottest);
}

}  // namespace
}  // namespace layerloop::thermal
