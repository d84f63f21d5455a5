#include <gtest/gtest.h>

#include <numbers>

#include "heated_block.hpp"
#include "thermal/implicit_solver.hpp"

namespace layerloop::thermal {
namespace {

constexpr double length = 80e-6, rise = 400, density = 7500;

/// theta = T - 298 K = rise (1.5 + X Y Z) (1 + t / tau) with X = cos(pi x / length), Y = cos(2 pi y / length) and
/// Z = cos(pi z / length): no heat leaves. k = k0 (1 + bend_k theta), cp = c0 (1 + bend_c theta).
struct Manufactured {
  static constexpr double k0 = 12, c0 = 450, bend_k = 1e-3, bend_c = 5e-4, tau = 150e-6;

  static Material metal() {
    Material m = constant_metal(k0, density, c0);
    m.conductivity = {{298, 5298}, {k0, k0 * (1 + bend_k * 5000)}};
    m.specific_heat = {{298, 5298}, {c0, c0 * (1 + bend_c * 5000)}};
    return m;
  }
  static double theta(Vec3 const& at, double t) {
    double const p = std::numbers::pi / length;
    return rise * (1.5 + std::cos(p * at.x()) * std::cos(2 * p * at.y()) * std::cos(p * at.z())) * (1 + t / tau);
  }
  /// density cp dT/dt - div(k grad T) [W/m^3]
  static double source(Vec3 const& at, double t) {
    double const p = std::numbers::pi / length, growth = 1 + t / tau;
    double const cx = std::cos(p * at.x()), cy = std::cos(2 * p * at.y()), cz = std::cos(p * at.z());
    double const sx = std::sin(p * at.x()), sy = std::sin(2 * p * at.y()), sz = std::sin(p * at.z());
    double const now = theta(at, t), amplitude = rise * growth * p;
    double const laplacian = -6 * p * amplitude * cx * cy * cz;
    double const gradient2 =
        amplitude * amplitude * (std::pow(sx * cy * cz, 2) + 4 * std::pow(cx * sy * cz, 2) + std::pow(cx * cy * sz, 2));
    return density * c0 * (1 + bend_c * now) * now / growth / tau -
           k0 * ((1 + bend_k * now) * laplacian + bend_k * gradient2);
  }
};

std::vector<CellPower> source_at(HeatedBlock const& block, double t) {
  std::vector<CellPower> source;
  double const volume = block.cells.grid.cell_volume();
  block.for_cells([&](std::int32_t i, std::int32_t j, std::int32_t k, Vec3 const& at) {
    source.push_back({block.local(i, j, k), volume * Manufactured::source(at, t)});
  });
  return source;
}

/// Temperatures of n^3 cells after `duration` [s], from the exact ones at the start. \param steps 0: as many as the
/// explicit limit asks for, so that dt falls with the square of the cell
std::vector<double> march(std::int32_t n, HeatSolver solver, double duration, std::int64_t steps) {
  HeatedBlock block(solid_block(length / n, {n, n, n}), Manufactured::metal());
  block.for_cells([&](std::int32_t i, std::int32_t j, std::int32_t k, Vec3 const& at) {
    block.enthalpy(i, j, k) = block.table.enthalpy(298 + Manufactured::theta(at, 0));
  });
  finish_step(block.system, 0);
  double const stable = stable_step(block.system.conduction, block.table);
  if (steps == 0) steps = static_cast<std::int64_t>(std::ceil(duration / (0.9 * stable)));
  double const dt = duration / static_cast<double>(steps);
  ImplicitSolver implicit(block.system);
  for (std::int64_t s = 0; s < steps; ++s) {
    double const begin = static_cast<double>(s) * dt;
    if (solver == HeatSolver::implicit_steps) {
      implicit.step(source_at(block, begin + dt), dt);
    } else {
      explicit_step(block.system, source_at(block, begin), dt);
    }
  }
  std::vector<double> temperature;
  block.for_cells([&](std::int32_t i, std::int32_t j, std::int32_t k, Vec3 const&) {
    temperature.push_back(block.temperature(i, j, k));
  });
  return temperature;
}

double root_mean_square(std::vector<double> const& a, std::vector<double> const& b) {
  double sum = 0;
  for (std::size_t c = 0; c < a.size(); ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Manufactured, SecondOrderInSpace) {
  double const duration = 60e-6;
  std::vector<double> error;
  for (std::int32_t n : {8, 16, 32}) {
    std::vector<double> exact;
    VoxelGrid const grid = solid_block(length / n, {n, n, n}).grid;
    for (std::int64_t c = 0; c < grid.size(); ++c) {
      auto const [i, j, k] = grid.coordinates(c);
      exact.push_back(298 + Manufactured::theta(grid.centre(i, j, k), duration));
    }
    error.push_back(root_mean_square(march(n, HeatSolver::explicit_steps, duration, 0), exact));
  }
  for (std::size_t level = 1; level < error.size(); ++level) {
    double const order = std::log2(error[level - 1] / error[level]);
    std::printf("L2 error %.4g K, then %.4g K: order %.3f\n", error[level - 1], error[level], order);
    EXPECT_GT(order, 1.9);
    EXPECT_LT(order, 2.1);
  }
}

/// Both schemes are Euler's. On one grid, successive halvings of the step leave the error in space out.
TEST(Manufactured, FirstOrderInTime) {
  double const duration = 60e-6;
  struct Scheme {
    HeatSolver solver;
    std::int64_t steps;
    char const* name;
  };
  for (Scheme const& scheme :
       {Scheme{HeatSolver::explicit_steps, 64, "explicit"}, Scheme{HeatSolver::implicit_steps, 16, "implicit"}}) {
    std::vector<std::vector<double>> T;
    for (std::int64_t factor : {1, 2, 4}) T.push_back(march(8, scheme.solver, duration, factor * scheme.steps));
    double const order = std::log2(root_mean_square(T[0], T[1]) / root_mean_square(T[1], T[2]));
    std::printf("%s: %.4g K between the first two, order %.3f\n", scheme.name, root_mean_square(T[0], T[1]), order);
    EXPECT_NEAR(order, 1, 0.1) << scheme.name;
  }
}

}  // namespace
}  // namespace layerloop::thermal
