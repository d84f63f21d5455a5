#include <gtest/gtest.h>

#include "plate.hpp"
#include "thermal/enthalpy_table.hpp"
#include "thermal/heat_system.hpp"

namespace layerloop::thermal {
namespace {

/// A bar of cells along z between a wall that is held hot and cold metal, with a melting point.
struct Bar {
  Material metal;
  double cell, wall, start, duration;
  std::int32_t cells;
};

/// Enthalpies along the bar after `duration`. The wall is a layer of cells that is reset before every step; half a cell
/// of metal lies between its surface and the first cell, as in the bar itself, so x = 0 is half a cell below cell 1.
std::vector<double> melt_bar(Bar const& bar, EnthalpyTable const& table) {
  HeatCells const cells = make_heat_cells(solid_block(bar.cell, {1, 1, bar.cells + 1}), SideY::adiabatic);
  HeatGrid const grid(cells.grid, false, Communicator());
  HeatSystem system = make_heat_system(table, grid, make_conduction(cells, grid.box(), {infinite, infinite}, 1, 0), {});
  auto const at = [&](std::int32_t k) { return static_cast<std::size_t>(grid.box().index(0, 0, k)); };
  for (std::int32_t k = 1; k <= bar.cells; ++k) system.enthalpy[at(k)] = table.enthalpy(bar.start);
  double const hot = table.enthalpy(bar.wall);
  double const stable = 0.6 * stable_step(system.conduction, table);
  auto const steps = static_cast<int>(std::ceil(bar.duration / stable));
  // The surface of the wall, not the centre of its cell, is at the wall temperature: mirror the first cell.
  double const wall_integral = table.conductivity_integral(hot);
  for (int s = 0; s < steps; ++s) {
    finish_step(system, 0);
    system.integral[at(0)] = 2 * wall_integral - system.integral[at(1)];
    conduction_balance(system.conduction, table, system.enthalpy, system.integral, system.balance);
    double const dt = bar.duration / steps;
    for (std::int32_t k = 1; k <= bar.cells; ++k) {
      system.enthalpy[at(k)] += dt * system.conduction.per_capacity[at(k)] * system.balance[at(k)];
    }
  }
  std::vector<double> enthalpy;
  for (std::int32_t k = 1; k <= bar.cells; ++k) enthalpy.push_back(system.enthalpy[at(k)]);
  return enthalpy;
}

/// Position of the front: molten cells, and of the cell that is melting the share that has melted.
double front(std::vector<double> const& enthalpy, EnthalpyTable const& table, double cell) {
  double molten = 0;
  for (double h : enthalpy) {
    molten += std::clamp((h - table.solidus()) / (table.liquidus() - table.solidus()), 0.0, 1.0);
  }
  return molten * cell;
}

Material melting_metal(double latent_heat) {
  Material m = constant_metal(25, 7500, 700);
  m.solidus = m.liquidus = 1700;
  m.latent_heat = latent_heat;
  return m;
}

/// One phase: solid at the melting point. x = 2 lambda sqrt(a t), sqrt(pi) lambda exp(lambda^2) erf(lambda) = St.
TEST(Stefan, OnePhaseFront) {
  struct Case {
    double stefan_number, lambda;
  };
  for (auto const& [stefan_number, lambda] : {Case{0.5, 0.464785921}, Case{1, 0.620062633}, Case{2, 0.800601363}}) {
    double const superheat = 1000, cell = 0.25e-6;
    Material const metal = melting_metal(700 * superheat / stefan_number);
    EnthalpyTable const table(metal, 300, 3000);
    double const diffusivity = 25.0 / (7500 * 700), duration = 40e-6;
    double const exact = 2 * lambda * std::sqrt(diffusivity * duration);
    std::int32_t const cells = static_cast<std::int32_t>(1.2 * exact / cell);
    std::vector<double> const enthalpy = melt_bar({metal, cell, 1700 + superheat, 1700, duration, cells}, table);
    double const found = front(enthalpy, table, cell);
    std::printf("St %g: front %.4f um, exact %.4f um\n", stefan_number, found * 1e6, exact * 1e6);
    EXPECT_NEAR(found, exact, cell) << "St " << stefan_number;
    EXPECT_NEAR(found / exact, 1, 0.005) << "St " << stefan_number;
  }
}

/// Two phases that differ in k and cp (the table takes both as steps at the melting point), wall at 2800 K, cold metal
/// at 298 K: the front is at 2 lambda sqrt(a_liquid t), lambda = .442582698, 13.555180 um after 50 us.
Material two_phase_metal() {
  Material metal = constant_metal(24, 7300, 640);
  metal.solidus = metal.liquidus = 1691.5;
  metal.latent_heat = 290e3;
  metal.conductivity = {{298, 1691.499, 1691.501}, {24, 24, 29}};
  metal.specific_heat = {{298, 1691.499, 1691.501}, {640, 640, 847}};
  return metal;
}

TEST(Stefan, TwoPhaseNeumannFront) {
  Material const metal = two_phase_metal();
  EnthalpyTable const table(metal, 298, 3000);
  double const exact = 13.555180e-6, cell = 0.25e-6;
  std::vector<double> const enthalpy = melt_bar({metal, cell, 2800, 298, 50e-6, 480}, table);
  double const found = front(enthalpy, table, cell);
  std::printf("two phases: front %.4f um, exact %.4f um\n", found * 1e6, exact * 1e6);
  EXPECT_NEAR(found, exact, 0.5 * cell);
  EXPECT_NEAR(found / exact, 1, 0.01);
  EXPECT_LT(table.temperature(enthalpy.back()), 299);  // the bar is long enough to be half infinite
}

/// The error of one instant depends on where in its cell the front stands, so it is taken over many.
TEST(Stefan, TwoPhaseFrontConvergesAtFirstOrder) {
  Material const metal = two_phase_metal();
  EnthalpyTable const table(metal, 298, 3000);
  auto const error = [&](double cell) {
    double squares = 0;
    int const instants = 12;
    for (int m = 0; m < instants; ++m) {
      double const time = 25e-6 * (1 + m / 12.0);
      double const exact = 13.555180e-6 * std::sqrt(time / 50e-6);
      auto const cells = static_cast<std::int32_t>(120e-6 / cell);
      squares += std::pow(front(melt_bar({metal, cell, 2800, 298, time, cells}, table), table, cell) - exact, 2);
    }
    return std::sqrt(squares / instants);
  };
  double const coarse = error(2e-6), middle = error(1e-6), fine = error(0.5e-6);
  std::printf("front error %.4f, %.4f, %.4f um at 2, 1, 0.5 um: order %.2f\n", coarse * 1e6, middle * 1e6, fine * 1e6,
              0.5 * std::log2(coarse / fine));
  EXPECT_GT(0.5 * std::log2(coarse / fine), 0.9);
}

}  // namespace
}  // namespace layerloop::thermal
