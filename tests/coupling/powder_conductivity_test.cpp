// A bed that DEM settled conducts on the heat grid as the law of packed beds says.
#include "thermal/effects/powder_conductivity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Sparse>
#include <filesystem>

#include "core/case_file.hpp"
#include "dem/settled_plate.hpp"

namespace layerloop::coupling {
namespace {

constexpr double um = 1e-6, period = 150 * um;

Case powder() {
  return read_case(std::filesystem::path(LAYERLOOP_SOURCE_DIR) / "tests/loop/absorb_small.toml",
                   {"powder.diameters=[\"20 um\", \"30 um\", \"40 um\"]", "powder.fractions=[0.3, 0.4, 0.3]",
                    "powder.particles=300", "run.replicates=1"},
                   Process::absorbing);
}

/// Plate below z = 0, the bed up to `height`, a lid above it.
CellContent between_plates(PowderBed const& bed, double height, double cell) {
  auto const n = static_cast<std::int32_t>(std::llround(period / cell)),
             layers = static_cast<std::int32_t>(std::llround(height / cell));
  CellContent content;
  content.grid.cell = cell;
  content.grid.n = {n, n, layers + 4};
  content.grid.origin = {0, 0, -2 * cell};
  auto const size = static_cast<std::size_t>(content.grid.size());
  content.solid.assign(size, 0), content.powder.assign(size, 0), content.grain.assign(size, -1);
  std::vector<double> largest(size, 0);
  for (std::size_t row = 0; row < bed.size(); ++row) {
    for (GrainShare const& share : grain_shares(bed, row, content.grid, period)) {
      auto const c = static_cast<std::size_t>(share.cell);
      content.powder[c] = std::min(1.0, content.powder[c] + share.volume / content.grid.cell_volume());
      if (share.volume > largest[c]) largest[c] = share.volume, content.grain[c] = static_cast<std::int32_t>(row);
    }
  }
  for (std::int64_t c = 0; c < content.grid.size(); ++c) {
    std::int32_t const k = content.grid.coordinates(c)[2];
    if (k >= 2 && k < layers + 2) continue;
    auto const at = static_cast<std::size_t>(c);
    content.solid[at] = 1, content.powder[at] = 0, content.grain[at] = -1;
  }
  return content;
}

struct Measured {
  double porosity, conductivity;
};

/// Steady heat from the lid to the plate: flux over the gradient of the mean temperature in the middle half of the bed.
Measured measure(CellContent const& content, double metal, thermal::ContactLaw const& contacts) {
  using namespace thermal;
  double const infinite = std::numeric_limits<double>::infinity(), cell = content.grid.cell;
  HeatCells const cells = make_heat_cells(content, SideY::adiabatic);
  HeatGrid const grid(cells.grid, false, Communicator());
  Conduction const conduction = make_conduction(cells, grid.box(), {infinite, infinite}, metal, contacts);
  LocalBox const& box = conduction.box;
  std::int32_t const planes = cells.grid.n[2];

  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> diagonal(static_cast<std::size_t>(box.size()), 0);
  auto const join = [&](std::int64_t a, std::int64_t b, double conductance) {
    diagonal[static_cast<std::size_t>(a)] += conductance, diagonal[static_cast<std::size_t>(b)] += conductance;
    entries.emplace_back(a, b, -conductance), entries.emplace_back(b, a, -conductance);
  };
  std::int64_t const strides[] = {1, box.stride_y(), box.stride_z()};
  std::vector<float> const* const shares[] = {&conduction.share_x, &conduction.share_y, &conduction.share_z};
  for (std::int64_t c = 0; c + box.stride_z() < box.size(); ++c)
    for (int axis = 0; axis < 3; ++axis)
      if (float const share = (*shares[axis])[static_cast<std::size_t>(c)]; share > 0)
        join(c, c + strides[axis], metal * share * cell);
  for (ContactFace const& face : conduction.contacts)
    if (face.cell < face.neighbour) join(face.cell, face.neighbour, face.conductivity * cell);

  Eigen::VectorXd heat = Eigen::VectorXd::Zero(box.size());
  double const held = 1e3 * metal * cell;  // to 0 at the bottom plane, to 1 K at the top one
  for (std::int32_t j = 0; j < cells.grid.n[1]; ++j)
    for (std::int32_t i = 0; i < cells.grid.n[0]; ++i)
      for (std::int32_t const k : {0, planes - 1}) {
        diagonal[static_cast<std::size_t>(box.index(i, j, k))] += held;
        if (k > 0) heat[box.index(i, j, k)] = held;
      }
  for (std::int64_t c = 0; c < box.size(); ++c)
    entries.emplace_back(c, c, std::max(diagonal[static_cast<std::size_t>(c)], 1e-9 * metal * cell));
  Eigen::SparseMatrix<double> matrix(box.size(), box.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(matrix);
  solver.setTolerance(1e-9);
  Eigen::VectorXd const temperature = solver.solve(heat);

  double flow = 0, filled = 0, n = 0, sz = 0, st = 0, szz = 0, szt = 0;
  for (std::int32_t k = 0; k < planes; ++k) {
    double weight = 0, mean = 0;
    for (std::int32_t j = 0; j < cells.grid.n[1]; ++j)
      for (std::int32_t i = 0; i < cells.grid.n[0]; ++i) {
        double const fill = conduction.fill[static_cast<std::size_t>(box.index(i, j, k))];
        if (k == 0) flow += held * temperature[box.index(i, j, k)];
        weight += fill, mean += fill * temperature[box.index(i, j, k)];
      }
    if (k < planes / 4 || k >= planes - planes / 4) continue;
    double const z = k * cell, t = mean / weight;
    filled += weight / (cells.grid.n[0] * cells.grid.n[1]);
    n += 1, sz += z, st += t, szz += z * z, szt += z * t;
  }
  double const gradient = (n * szt - sz * st) / (n * szz - sz * sz);
  return {1 - filled / n, flow / (period * period) / gradient};
}

double sauter_diameter(PowderBed const& bed) {
  double r3 = 0, r2 = 0;
  for (double const r : bed.radius) r3 += r * r * r, r2 += r * r;
  return 2 * r3 / r2;
}

/// In argon and helium, at two cell sizes and at a tenth of the pressure: within 30 % of the law with the shape of
/// packed beds, the law's own error, and within 15 % of it with spheres, the unit cell that the contacts are made of.
/// Neither is fitted. (Gas in the pores, which the grid leaves out, is what is missing at low pressure.)
TEST(PowderConductivity, SettledBedConductsAsTheLawSays) {
  Case checked = powder();
  checked.heat.ambient_temperature = 300;
  PowderBed const bed = dem::settled_plate(checked, Communicator(), false);
  double const top = *std::ranges::max_element(bed.z), height = 0.8 * top;
  thermal::Effects const effects{{"powder_conductivity", {true, 1}}};
  double const T = 0.5 * (300 + checked.material.solidus), metal = checked.material.conductivity(T);
  struct Setting {
    Gas gas;
    double pressure, cell;
  };
  for (Setting const& s : {Setting{Gas::argon, 101325, 5 * um}, Setting{Gas::argon, 101325, 3.75 * um},
                           Setting{Gas::helium, 101325, 5 * um}, Setting{Gas::argon, 10132.5, 5 * um}}) {
    checked.heat.gas = s.gas, checked.heat.gas_pressure = s.pressure;
    CellContent const content = between_plates(bed, std::floor(height / (15 * um)) * 15 * um, s.cell);
    thermal::HeatCells const cells = thermal::make_heat_cells(content, thermal::SideY::adiabatic);
    Measured const grid = measure(content, metal, thermal::contact_law(cells, checked.heat, checked.material, effects));
    thermal::GapGas const gas = thermal::gap_gas(checked.heat, 0.85, checked.material.emissivity, T);
    double const d = sauter_diameter(bed),
                 law = thermal::bed_conductivity(grid.porosity, d, metal, gas, thermal::shape_in_bed(grid.porosity)),
                 spheres = thermal::bed_conductivity(grid.porosity, d, metal, gas, 1);
    std::printf("gas %d, %.0f Pa, cells of %.2f um: porosity %.3f, grid %.4f, law %.4f (shape 1: %.4f) W/(m K)\n",
                static_cast<int>(s.gas), s.pressure, 1e6 * s.cell, grid.porosity, grid.conductivity, law, spheres);
    EXPECT_NEAR(grid.conductivity / law, 1, 0.3);
    EXPECT_NEAR(grid.conductivity / spheres, 1, 0.15);
  }
}

}  // namespace
}  // namespace layerloop::coupling
