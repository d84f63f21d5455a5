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
          std::vector<double, HugePages<double>>(n, 0),
          std::vector<double>(n, 0),
          std::vector<double>(n, 0),
          std::vector<float, HugePages<float>>(n, 0),
          std::vector<float>(n, 0),
          std::vector<char>(n, 0),
          0,
          AwakeRows::share_of_solidus * table.solidus(),
          {},
          {}};
}

double record_peak(HeatSystem& system, Row const& row) {
  double const* const h = system.enthalpy.data();
  float* __restrict const peak = system.peak.data();
  double largest = 0;
#pragma omp simd reduction(max : largest) if (row.end - row.begin > 8)
  for (std::int64_t c = row.begin; c < row.end; ++c) {
    float const now = static_cast<float>(h[c]);
    peak[c] = now > peak[c] ? now : peak[c];
    largest = h[c] > largest ? h[c] : largest;
  }
  return largest;
}

void record_liquid(HeatSystem& system, Row const& row, double dt, std::vector<std::int64_t>& newly_melted) {
  double const* const h = system.enthalpy.data();
  float* __restrict const time = system.time_above_liquidus.data();
  char const* const melted = system.melted.data();
  double const liquidus = system.table.liquidus();
  auto const step = static_cast<float>(dt);
  int any_new = 0;
#pragma omp simd reduction(| : any_new)
  for (std::int64_t c = row.begin; c < row.end; ++c) {
    bool const liquid = h[c] >= liquidus;
    time[c] += liquid ? step : 0;
    any_new |= liquid && !melted[c];
  }
  if (!any_new) return;
  for (std::int64_t c = row.begin; c < row.end; ++c) {
    if (h[c] >= liquidus && !melted[c]) newly_melted.push_back(c);
  }
}

std::vector<std::int64_t> neighbours_that_melted(HeatSystem const& system) {
  std::vector<std::int64_t> cells;
  std::ranges::copy_if(system.conduction.neighbours, std::back_inserter(cells), [&](std::int64_t c) {
    return system.enthalpy[c] >= system.table.liquidus() && !system.melted[c];
  });
  return cells;
}

void join_melted(HeatSystem& system, std::vector<std::int64_t> const& cells) {
  for (std::int64_t const c : cells) {
    system.melted[c] = 1;
    system.conduction.melt(c);
  }
}

namespace {

void look_up_integral(HeatSystem& system) {
  for (Row const& row : system.conduction.rows_with_neighbours) {
    for (std::int64_t c = row.begin; c < row.end; ++c) {
      system.integral[c] = system.table.conductivity_integral(system.enthalpy[c]);
    }
  }
}

}  // namespace

void finish_step(HeatSystem& system, double dt) {
  system.grid.exchange(system.enthalpy);
  look_up_integral(system);
  std::vector<std::int64_t> newly_melted = neighbours_that_melted(system);
  for (Row const& row : system.conduction.rows) {
    if (record_peak(system, row) >= system.table.liquidus()) record_liquid(system, row, dt, newly_melted);
  }
  join_melted(system, newly_melted);
  system.awake.forget();
}

std::vector<CellPower> ascending(std::span<CellPower const> source) {
  std::vector<CellPower> sorted(source.begin(), source.end());
  if (!std::ranges::is_sorted(sorted, {}, &CellPower::cell)) std::ranges::stable_sort(sorted, {}, &CellPower::cell);
  return sorted;
}

double stored_heat(HeatSystem const& system) {
  Conduction const& conduction = system.conduction;
  CompensatedSum heat;
  for (Row const& row : conduction.rows) {
    double in_row = 0;
#pragma omp simd reduction(+ : in_row)
    for (std::int64_t c = row.begin; c < row.end; ++c) {
      in_row +=
          conduction.per_capacity[c] > 0 ? system.enthalpy[c] * (conduction.cell / conduction.per_capacity[c]) : 0;
    }
    heat.add(in_row);
  }
  return heat.value();
}

double largest_imbalance(HeatSystem& system) {
  look_up_integral(system);
  conduction_balance(system.conduction, system.table, system.enthalpy, system.integral, system.balance);
  double largest = 0;
  for (Row const& row : system.conduction.rows) {
    for (std::int64_t c = row.begin; c < row.end; ++c) largest = std::max(largest, std::abs(system.balance[c]));
  }
  return largest;
}

double hottest(HeatSystem const& system) {
  double largest = 0;
  int any_nan = 0;
  for (Row const& row : system.conduction.rows) {
#pragma omp simd reduction(max : largest) reduction(| : any_nan)
    for (std::int64_t c = row.begin; c < row.end; ++c) {
      double const h = system.enthalpy[c];
      any_nan |= h != h;
      largest = h > largest ? h : largest;
    }
  }
  return any_nan ? std::numeric_limits<double>::quiet_NaN() : largest;
}

}  // namespace layerloop::thermal
