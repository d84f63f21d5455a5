#include <gtest/gtest.h>

#include <cmath>

#include "plate.hpp"
#include "thermal/effects/powder_conductivity.hpp"

namespace layerloop::thermal {
namespace {

/// Beds of 30 um grains at 300 K without jump and with shape 1, computed apart from the program [W/(m K)].
TEST(PowderConductivity, ValuesOfTheLaw) {
  struct Value {
    double solid, gas, porosity, conductivity;
  };
  for (Value const& v : {Value{14, 0.0177, 0.45, 0.155}, Value{14, 0.0177, 0.60, 0.135}, Value{14, 0.0259, 0.45, 0.21},
                         Value{14, 0.0259, 0.60, 0.18}, Value{14, 0.1557, 0.45, 0.85}, Value{14, 0.1557, 0.60, 0.75},
                         Value{160, 0.0177, 0.45, 0.22}, Value{160, 0.0177, 0.60, 0.19}}) {
    EXPECT_NEAR(bed_conductivity(v.porosity, 30e-6, v.solid, {v.gas, 0, 0}, 1), v.conductivity, 0.03 * v.conductivity)
        << v.gas << " " << v.porosity;
  }
}

/// Zehner and Schluender's closed form of the unit cell; and that of spheres with a jump.
TEST(PowderConductivity, UnitCellAgainstClosedForms) {
  double const solid = 14, gas = 0.0177, l = gas / solid;
  for (double const B : {0.8, 1.25, 1.56, 4.0}) {
    double const N = 1 - l * B;
    double const exact = 2 / N * ((1 - l) * B / (N * N) * std::log(1 / (l * B)) - 0.5 * (B + 1) - (B - 1) / N);
    EXPECT_NEAR(touching_grains(solid, {gas, 0, 0}, 30e-6, B), exact, 1e-8 * exact) << B;
  }
  double const jump = 0.2e-6, D = 30e-6, a = 2 * jump / D;
  double const exact = 2 * ((1 + a) / ((1 - l) * (1 - l)) * std::log((1 + a) / (a + l)) - 1 / (1 - l));
  EXPECT_NEAR(touching_grains(solid, {gas, jump, 0}, D), exact, 1e-8 * exact);
}

TEST(PowderConductivity, EndsAtTheSolidAndAtTheGas) {
  GapGas const argon{0.0177, 0, 0};
  auto const law = [&](double porosity) {
    return bed_conductivity(porosity, 30e-6, 14, argon, shape_in_bed(porosity));
  };
  EXPECT_NEAR(law(1e-7), 14, 0.01 * 14);
  EXPECT_NEAR(law(1 - 1e-9), 0.0177, 0.001 * 0.0177);
  for (double porosity = 0.1; porosity < 0.9; porosity += 0.1) EXPECT_GT(law(porosity), law(porosity + 0.05));
}

/// Argon at 300 K and 1 atm: mean free path mu / p sqrt(pi R T / 2) = 71 nm, jump 1.875 (2 - A) / A of it (Eucken's
/// factor 5/2, so that k = 5/2 cv mu).
TEST(PowderConductivity, JumpOfArgonIsThatOfItsFreePath) {
  HeatSettings settings;
  GapGas const gas = gap_gas(settings, 1, 0, 300);
  double const R = 8.314462618 / 0.039948, viscosity = 0.0177 / (2.5 * 1.5 * R);
  double const free_path = viscosity / 101325 * std::sqrt(0.5 * 3.14159265 * R * 300);
  EXPECT_NEAR(free_path, 71e-9, 1e-9);
  EXPECT_NEAR(gas.jump, 1.875 * free_path, 1e-3 * gas.jump);
  settings.gas_pressure = 1013.25;
  EXPECT_NEAR(gap_gas(settings, 1, 0, 300).jump, 100 * gas.jump, 1e-9 * gas.jump * 100);
  EXPECT_NEAR(gap_gas(settings, 0.5, 0, 300).jump, 300 * gas.jump, 1e-9 * gas.jump * 300);
  EXPECT_NEAR(gap_gas(settings, 1, 1, 1000).radiation, 4 * 5.670374419e-8 * 1e9, 1e-6);
}

/// The faces between two grains conduct together what the unit cell does, whatever the cell size.
TEST(PowderConductivity, FacesOfAPairShareItsConductance) {
  for (std::int32_t const cells_a_radius : {3, 4, 6}) {
    double const radius = 15e-6, cell = radius / cells_a_radius;
    std::int32_t const n = 2 * cells_a_radius;
    CellContent content = solid_block(cell, {2 * n, n, n});
    content.solid.assign(content.solid.size(), 0);
    PowderBed pair;
    pair.add(0, {radius, radius, radius}, radius, 0);
    pair.add(1, {3 * radius, radius, radius}, radius, 0);
    for (std::size_t row = 0; row < 2; ++row)
      for (GrainShare const& share : grain_shares(pair, row, content.grid, 0)) {
        content.powder[static_cast<std::size_t>(share.cell)] = share.volume / content.grid.cell_volume();
        content.grain[static_cast<std::size_t>(share.cell)] = static_cast<std::int32_t>(row);
      }
    HeatCells const cells = make_heat_cells(content, SideY::adiabatic);
    HeatSettings const settings = closed_settings(cell);
    Material const metal = built_in_materials().at("316L");
    Effects const on{{"powder_conductivity", {true, 1}}};
    double const T = 0.5 * (298 + metal.solidus), solid = metal.conductivity(T);
    GapGas const gas = gap_gas(settings, 0.85, metal.emissivity, T);
    double const exact = 0.5 * 3.14159265 * radius *
                         (touching_grains(solid, gas, 2 * radius) * gas.conductivity + gas.radiation * 2 * radius);
    double faces = 0;
    for (std::int32_t k = 0; k < n; ++k)
      for (std::int32_t j = 0; j < n; ++j) {
        double const a = cells.fill[static_cast<std::size_t>(content.grid.index(n - 1, j, k))],
                     b = cells.fill[static_cast<std::size_t>(content.grid.index(n, j, k))];
        if (a > 0 && b > 0) faces += std::min(1.0, 0.5 * (a + b));
      }
    EXPECT_GT(faces, 0);
    EXPECT_NEAR(contact_law(cells, settings, metal, on)(1, 0) * faces * cell, exact, 0.01 * exact);
  }
}

TEST(PowderConductivity, NullStrengthIsTheConstant) {
  CellContent const content = plate_with_grains({40, 24, 18}, 11);
  HeatSource const source = beam_from_above(content, 10, 35e-6, 1.0, 50e-6, 150e-6);
  HeatSettings settings = closed_settings(5e-6);
  auto const peaks = [&](Effects const& effects) {
    return expose(content, source, built_in_materials().at("IN718"), settings, effects, SideY::periodic, Communicator(),
                  Report::silent)
        .melt.peak_temperature;
  };
  Effects effects = effects_on({"latent_heat"});
  std::vector<float> const off = peaks(effects);
  effects["powder_conductivity"] = {true, 0};
  EXPECT_EQ(peaks(effects), off);
  effects["powder_conductivity"] = {true, 1};
  EXPECT_NE(peaks(effects), off);
}

}  // namespace
}  // namespace layerloop::thermal
