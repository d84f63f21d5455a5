#include "thermal/heat_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/compensated_sum.hpp"

namespace layerloop::thermal {

HeatSystem make_heat_system(EnthalpyTable const& table, HeatGrid const& grid, Conduction conduction, SurfaceSink sink) {
  auto const n = static_cast<std::size_t>(grid.box().size());
  return {table,
          grid,
          std::move(conduction),
          std::move(sink),
          std::vector<double>(n, 0),
          std::vector<double>(n, 0),
          std::vector<double>(n, 0),
          std::vector<float>(n, 0),
          std::vector<float>(n, 0),
          std::vector<char>(n, 0),
          0};
}

namespace {

/// One row: Theta and peak; returns the row's largest enthalpy.
double look_up(EnthalpyTable const& table, Row const& row, double const* __restrict h, double* __restrict theta,
               float* __restrict peak) {
  double largest = 0;
#pragma omp simd reduction(max : largest)
  for (std::int64_t c = row.begin; c < row.end; ++c) {
    theta[c] = table.conductivity_integral(h[c]);
    float const now = static_cast<float>(h[c]);
    peak[c] = now > peak[c] ? now : peak[c];
    largest = h[c] > largest ? h[c] : largest;
  }
  return largest;
}

/// Cells of a row with liquid in it: their time above the liquidus, and who has just melted.
void record_liquid(HeatSystem& system, Row const& row, double dt, std::vector<std::int64_t>& newly_melted) {
  for (std::int64_t c = row.begin; c < row.end; ++c) {
    if (system.enthalpy[c] < system.table.liquidus()) continue;
    system.time_above_liquidus[c] += static_cast<float>(dt);
    if (!system.melted[c]) newly_melted.push_back(c);
  }
}

}  // namespace

void finish_step(HeatSystem& system, double dt) {
  system.grid.exchange(system.enthalpy);
  std::vector<std::int64_t> newly_melted;
  for (Row const& row : system.conduction.rows_with_neighbours) {
    double const largest =
        look_up(system.table, row, system.enthalpy.data(), system.integral.data(), system.peak.data());
    if (largest >= system.table.liquidus()) record_liquid(system, row, dt, newly_melted);
  }
  for (std::int64_t c : newly_melted) {
    system.melted[c] = 1;
    system.conduction.melt(c);
  }
}

void explicit_step(HeatSystem& system, std::span<CellPower const> source, double dt) {
  Conduction const& conduction = system.conduction;
  double const far = conduction_balance(conduction, system.table, system.enthalpy, system.integral, system.balance);
  for (CellPower const& heated : source) system.balance[heated.cell] += heated.watts / conduction.cell;
  system.heat_to_far_field += dt * far;
  double* const h = system.enthalpy.data();
  double const* const balance = system.balance.data();
  double const* const per_capacity = conduction.per_capacity.data();
  for (Row const& row : conduction.rows) {
#pragma omp simd
    for (std::int64_t c = row.begin; c < row.end; ++c) h[c] += dt * per_capacity[c] * balance[c];
  }
  drain(system.sink, system.table, dt, system.enthalpy);
  finish_step(system, dt);
}

double stored_heat(HeatSystem const& system) {
  CompensatedSum heat;
  for (Row const& row : system.conduction.rows) {
    for (std::int64_t c = row.begin; c < row.end; ++c) {
      if (system.conduction.fill[c] > 0) heat.add(system.enthalpy[c] * system.metal_volume(c));
    }
  }
  return heat.value();
}

double largest_imbalance(HeatSystem& system) {
  conduction_balance(system.conduction, system.table, system.enthalpy, system.integral, system.balance);
  double largest = 0;
  for (Row const& row : system.conduction.rows) {
    for (std::int64_t c = row.begin; c < row.end; ++c) largest = std::max(largest, std::abs(system.balance[c]));
  }
  return largest;
}

double hottest(HeatSystem const& system) {
  double largest = 0;
  for (Row const& row : system.conduction.rows) {
    for (std::int64_t c = row.begin; c < row.end; ++c) {
      if (std::isnan(system.enthalpy[c])) return std::numeric_limits<double>::quiet_NaN();
      largest = std::max(largest, system.enthalpy[c]);
    }
  }
  return largest;
}

}  // namespace layerloop::thermal
