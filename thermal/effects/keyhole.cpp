#include "thermal/effects/keyhole.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/compensated_sum.hpp"

namespace layerloop::thermal {
namespace {
constexpr double gas_constant = 8.314462618;  // [J/(mol K)]
constexpr double atmosphere = 101325;         // [Pa]
constexpr double recoil_share = 0.54;         // of the saturation pressure
}  // namespace

Keyhole::Keyhole(Material const& m, HeatCells const& cells, double strength)
    : cells_(cells),
      strength_(strength),
      surface_tension_(m.surface_tension + m.surface_tension_slope * (m.boiling_point - m.liquidus)),
      boiling_(m.boiling_point),
      onset_(m.heat_of_vaporisation * m.molar_mass / gas_constant) {
  VoxelGrid const& grid = cells.grid;
  for (std::int64_t c = 0; c < std::int64_t{grid.n[0]} * grid.n[1]; ++c) {
    std::int64_t const top = next_below(c + grid.index(0, 0, grid.n[2]));
    columns_.push_back({top, top});
  }
}

double Keyhole::saturation_pressure(double T) const { return atmosphere * std::exp(onset_ * (1 / boiling_ - 1 / T)); }

double Keyhole::saturation_temperature(double pressure) const {
  return 1 / (1 / boiling_ - std::log(pressure / atmosphere) / onset_);
}

bool Keyhole::reached(std::size_t column, BeamReach const& beam) const {
  auto const c = static_cast<std::int64_t>(column);
  Vec3 const at = cells_.grid.centre(c % cells_.grid.n[0], c / cells_.grid.n[0], 0);
  return std::hypot(at.x() - beam.centre.x(), at.y() - beam.centre.y()) <= beam.radius;
}

std::int64_t Keyhole::next_below(std::int64_t cell) const {
  do cell -= std::int64_t{cells_.grid.n[0]} * cells_.grid.n[1];
  while (cell >= 0 && cells_.fill[static_cast<std::size_t>(cell)] == 0);
  return std::max<std::int64_t>(cell, -1);
}

double Keyhole::height_of(std::int64_t cell, double share) const {
  VoxelGrid const& grid = cells_.grid;
  return grid.origin.z() + grid.cell * (grid.coordinates(cell)[2] + share);
}

double Keyhole::radius_of(std::size_t columns) const {
  return cells_.grid.cell * std::sqrt(static_cast<double>(columns) / std::numbers::pi);
}

double Keyhole::wall_temperature(std::size_t columns) const {
  return saturation_temperature(atmosphere + surface_tension_ / radius_of(columns));
}

/// Columns of the part of a closed surface that gives way; 0: none does. The highest cell's temperature is that of its
/// centre; the surface lies half a cell above it.
std::size_t Keyhole::gives_way(std::span<double const> h, EnthalpyTable const& table) const {
  double const boils = table.enthalpy(boiling_);
  std::vector<double> surface;
  for (Column const& column : columns_) {
    if (column.top < 0 || h[static_cast<std::size_t>(column.top)] < boils) continue;
    double const T = table.temperature(h[static_cast<std::size_t>(column.top)]);
    std::int64_t const below = next_below(column.top);
    double const under = below < 0 ? T : table.temperature(h[static_cast<std::size_t>(below)]);
    surface.push_back(T + 0.5 * std::max(0.0, T - under));
  }
  std::ranges::sort(surface, std::greater{});
  std::size_t n = surface.size();
  while (n > 0 && surface[n - 1] < wall_temperature(n)) --n;
  double push = 0;
  for (std::size_t c = 0; c < n; ++c) push += recoil_share * saturation_pressure(surface[c]) - atmosphere;
  return n > 0 && push / static_cast<double>(n) > 2 * surface_tension_ / radius_of(n) ? n : 0;
}

/// Cells at the wall's enthalpy become hollow, from the top down; what one holds beyond it heats the next.
void Keyhole::sink(Column& column, std::span<double> h, double wall) {
  double beyond = 0;  // [J/m^3] times cells
  for (std::int64_t c = column.top; c >= 0; c = next_below(c)) {
    auto const cell = static_cast<std::size_t>(c);
    double const with = h[cell] + beyond / cells_.fill[cell], kept = std::min(with, wall);
    if (kept != h[cell]) changed_.push_back(c);
    beyond = cells_.fill[cell] * (with - kept);
    h[cell] = kept;
    if (c > column.floor) continue;
    if (with < wall) return;
    column.floor = next_below(c);
  }
}

/// Metal that shares a face with the cavity, ascending.
std::vector<std::int64_t> Keyhole::cells_of_wall() const {
  std::int64_t const nx = cells_.grid.n[0], ny = cells_.grid.n[1];
  std::vector<std::int64_t> cells;
  auto const consider = [&](std::int64_t c) {
    if (cells_.fill[static_cast<std::size_t>(c)] > 0 && c <= columns_[static_cast<std::size_t>(c % (nx * ny))].floor)
      cells.push_back(c);
  };
  for (std::int64_t column = 0; column < nx * ny; ++column) {
    Column const& open = columns_[static_cast<std::size_t>(column)];
    if (!open.is_open()) continue;
    std::int64_t const i = column % nx, j = column / nx;
    if (open.floor >= 0) consider(open.floor);
    for (std::int64_t c = open.top; c != open.floor; c = next_below(c)) {
      if (i > 0) consider(c - 1);
      if (i + 1 < nx) consider(c + 1);
      if (j > 0) consider(c - nx);
      if (j + 1 < ny) consider(c + nx);
    }
  }
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// What light heats beyond the wall's temperature boils instead, and condenses where the wall is colder.
void Keyhole::condense(std::span<double> h, double wall) {
  std::vector<std::int64_t> const cells = cells_of_wall();
  CompensatedSum vapour, room;
  for (std::int64_t const c : cells) {
    double const beyond = cells_.fill[static_cast<std::size_t>(c)] * (h[static_cast<std::size_t>(c)] - wall);
    (beyond > 0 ? vapour : room).add(std::abs(beyond));
  }
  if (vapour.value() == 0 || room.value() == 0) return;
  double const condensed = std::min(1.0, vapour.value() / room.value()),
               stays = std::max(0.0, 1 - room.value() / vapour.value());
  for (std::int64_t const c : cells) {
    double& value = h[static_cast<std::size_t>(c)];
    value += (value > wall ? 1 - stays : condensed) * (wall - value);
    changed_.push_back(c);
  }
}

/// The wall lies where the temperatures of the two cells under it lead to that of the cavity, at most half a cell from
/// the face: so it moves steadily while cells give way one by one.
void Keyhole::follow_wall(std::span<double const> h, EnthalpyTable const& table) {
  wall_.assign(columns_.size(), std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    Column const& column = columns_[c];
    if (!column.is_open()) continue;
    double const top = height_of(column.top, 1);
    double height = height_of(std::max<std::int64_t>(column.floor, 0), column.floor < 0 ? 0 : 1);
    std::int64_t const below = column.floor < 0 ? -1 : next_below(column.floor);
    if (below >= 0) {
      double const T1 = table.temperature(h[static_cast<std::size_t>(column.floor)]),
                   T2 = table.temperature(h[static_cast<std::size_t>(below)]);
      double const up = T1 > T2 ? (wall_temperature_ - T1) / (T1 - T2) : 1;
      height = height_of(column.floor, 0.5) + cells_.grid.cell * std::clamp(up, 0.0, 1.0);
    }
    wall_[c] = top - strength_ * std::max(0.0, top - height);
    depth_ = std::max(depth_, top - wall_[c]);
  }
  deepest_ = std::max(deepest_, depth_);
}

void Keyhole::update(std::span<double> h, EnthalpyTable const& table, BeamReach const& beam) {
  changed_.clear();
  wall_.clear();
  radius_ = depth_ = 0;
  std::size_t open = 0;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (!reached(c, beam)) columns_[c].floor = columns_[c].top;
    open += columns_[c].is_open();
  }
  if (open == 0) open = gives_way(h, table);
  if (open == 0) return;
  wall_temperature_ = wall_temperature(open);
  radius_ = radius_of(open);
  double const wall = table.enthalpy(wall_temperature_);
  for (std::size_t c = 0; c < columns_.size(); ++c)
    if (reached(c, beam)) sink(columns_[c], h, wall);
  condense(h, wall);
  follow_wall(h, table);
}

}  // namespace layerloop::thermal
