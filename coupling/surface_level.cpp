#include "coupling/surface_level.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/compensated_sum.hpp"

namespace layerloop::coupling {
namespace {

constexpr double metal = 0.5;  ///< a cell that is at least this full counts as metal

std::int64_t wrap(std::int64_t j, std::int64_t n) { return ((j % n) + n) % n; }

/// Calls visit(neighbour) for the face neighbours of a cell inside the grid; y is periodic.
template <class Visit>
void for_face_neighbours(VoxelGrid const& grid, std::int64_t cell, Visit visit) {
  auto const c = grid.coordinates(cell);
  if (c[0] > 0) visit(cell - 1);
  if (c[0] + 1 < grid.n[0]) visit(cell + 1);
  visit(grid.index(c[0], wrap(c[1] - 1, grid.n[1]), c[2]));
  visit(grid.index(c[0], wrap(c[1] + 1, grid.n[1]), c[2]));
  if (c[2] > 0) visit(grid.index(c[0], c[1], c[2] - 1));
  if (c[2] + 1 < grid.n[2]) visit(grid.index(c[0], c[1], c[2] + 1));
}

/// Flags the cells that gas from above reaches through cells less than half full.
std::vector<char> reached_by_gas(VoxelGrid const& grid, std::vector<double> const& fill) {
  std::vector<char> gas(fill.size(), 0);
  std::vector<std::int64_t> front;
  auto const enter = [&](std::int64_t cell) {
    auto const c = static_cast<std::size_t>(cell);
    if (gas[c] || fill[c] >= metal) return;
    gas[c] = 1;
    front.push_back(cell);
  };
  std::int64_t const layer = std::int64_t{grid.n[0]} * grid.n[1];
  for (std::int64_t cell = grid.size() - layer; cell < grid.size(); ++cell) enter(cell);
  while (!front.empty()) {
    std::int64_t const cell = front.back();
    front.pop_back();
    for_face_neighbours(grid, cell, enter);
  }
  return gas;
}

/// Cells that gas does not reach and that do not border on it become full.
void fill_enclosed(VoxelGrid const& grid, std::vector<double>& fill) {
  std::vector<char> const gas = reached_by_gas(grid, fill);
  for (std::int64_t cell = 0; cell < grid.size(); ++cell) {
    auto const c = static_cast<std::size_t>(cell);
    if (gas[c]) continue;
    bool at_surface = cell + std::int64_t{grid.n[0]} * grid.n[1] >= grid.size();
    for_face_neighbours(grid, cell,
                        [&](std::int64_t next) { at_surface = at_surface || gas[static_cast<std::size_t>(next)]; });
    if (!at_surface || fill[c] < metal) fill[c] = 1;
  }
}

/// Every cell under a column's highest metal becomes full.
void fill_under_top(VoxelGrid const& grid, std::vector<double>& fill) {
  std::int64_t const layer = std::int64_t{grid.n[0]} * grid.n[1];
  for (std::int64_t column = 0; column < layer; ++column) {
    bool roofed = false;
    for (std::int64_t k = grid.n[2] - 1; k >= 0; --k) {
      double& f = fill[static_cast<std::size_t>(column + k * layer)];
      if (roofed) f = 1;
      roofed = roofed || f > 1e-9;
    }
  }
}

/// Metal fraction of [k - 1/2, k + 3/2] around cell k from its own fill and those below and above; sheets of one cell,
/// which that average would wash out, keep the level that their own fill gives.
double two_cell_average(double below, double own, double above) {
  double const average = 0.5 * (std::max(0.0, below - 0.5) + own + std::min(above, 0.5));
  return own >= metal ? std::max(average, 0.25 + 0.5 * own) : average;
}

/// Metal cells that meet at an edge only leave a bilinear saddle near the level 0.5, where no manifold surface exists:
/// they get a neck, the gas cells beside the edge being raised (in the level only, the field keeps its mass).
void join_at_edges(SurfaceLevel& surface) {
  constexpr double neck = 0.4, near_critical = 0.1;
  std::vector<double> const before = surface.level;
  std::array<std::int64_t, 3> const stride{1, surface.n[0], surface.n[0] * surface.n[1]};
  for (auto [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
    for (std::int64_t node = 0; node < static_cast<std::int64_t>(before.size()); ++node) {
      std::array<std::int64_t, 3> const at{node % stride[1], node / stride[1] % surface.n[1], node / stride[2]};
      if (at[a] + 1 >= surface.n[a] || at[b] + 1 >= surface.n[b]) continue;
      std::array<std::int64_t, 4> const ring{node, node + stride[a], node + stride[a] + stride[b], node + stride[b]};
      auto const value = [&](std::size_t c) { return before[static_cast<std::size_t>(ring[c])]; };
      bool const first = value(0) >= metal;
      if ((value(2) >= metal) != first || (value(1) >= metal) == first || (value(3) >= metal) == first) continue;
      double const saddle = (value(0) * value(2) - value(1) * value(3)) / (value(0) + value(2) - value(1) - value(3));
      if (std::abs(saddle - metal) > near_critical) continue;
      for (std::size_t gas = first ? 1 : 0; gas < 4; gas += 2) {
        double& level = surface.level[static_cast<std::size_t>(ring[gas])];
        level = std::max(level, neck);
      }
    }
  }
}

}  // namespace

double SurfaceLevel::operator()(Vec3 const& p) const {
  std::array<std::int64_t, 3> low{};
  std::array<double, 3> t{};
  for (std::size_t a = 0; a < 3; ++a) {
    double const node =
        std::clamp(p[static_cast<int>(a)] - 0.5 - static_cast<double>(first[a]), 0.0, static_cast<double>(n[a] - 1));
    low[a] = std::min(static_cast<std::int64_t>(node), n[a] - 2);
    t[a] = node - static_cast<double>(low[a]);
  }
  double const* const corner = level.data() + low[0] + n[0] * (low[1] + n[1] * low[2]);
  auto const along_x = [&](std::int64_t j, std::int64_t k) {
    double const* const row = corner + n[0] * (j + n[1] * k);
    return row[0] + t[0] * (row[1] - row[0]);
  };
  double const front = along_x(0, 0) + t[1] * (along_x(1, 0) - along_x(0, 0));
  double const back = along_x(0, 1) + t[1] * (along_x(1, 1) - along_x(0, 1));
  return front + t[2] * (back - front);
}

double SurfaceLevel::top(std::int64_t i, std::int64_t j) const {
  std::int64_t k = first[2] + n[2] - 2;  // the topmost nodes are gas, the lowest two are plate
  while (at(i, j, k) < metal) --k;
  double const below = at(i, j, k), above = at(i, j, k + 1);
  return static_cast<double>(k) + 0.5 + (below - metal) / (below - above);
}

SurfaceLevel surface_level(SolidField const& solid, double density, Voids voids, std::int64_t margin_y) {
  VoxelGrid const& grid = solid.grid;
  std::vector<double> fill = fill_fraction(solid, density);
  voids == Voids::enclosed ? fill_enclosed(grid, fill) : fill_under_top(grid, fill);
  auto const highest = std::find_if(fill.rbegin(), fill.rend(), [](double f) { return f > 0; });
  std::int64_t const layers = highest == fill.rend() ? 0 : grid.coordinates(fill.rend() - highest - 1)[2] + 1;

  SurfaceLevel surface;
  surface.first = {-1, -margin_y - 1, -2};
  surface.n = {grid.n[0] + 2, grid.n[1] + 2 * margin_y + 2, layers + 4};
  surface.level.reserve(static_cast<std::size_t>(surface.n[0] * surface.n[1] * surface.n[2]));
  auto const fill_at = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    if (k < 0) return 1.0;
    bool const blank = i < 0 || i >= grid.n[0] || j < -margin_y || j >= grid.n[1] + margin_y || k >= layers;
    return blank ? 0.0 : std::min(1.0, fill[static_cast<std::size_t>(grid.index(i, wrap(j, grid.n[1]), k))]);
  };
  CompensatedSum cells;
  for (std::int64_t k = -2; k < surface.n[2] - 2; ++k) {
    for (std::int64_t j = surface.first[1]; j < surface.first[1] + surface.n[1]; ++j) {
      for (std::int64_t i = -1; i < surface.n[0] - 1; ++i) {
        double const own = fill_at(i, j, k);
        if (k >= 0) cells.add(own);
        surface.level.push_back(two_cell_average(fill_at(i, j, k - 1), own, fill_at(i, j, k + 1)));
      }
    }
  }
  surface.metal_cells = cells.value();
  join_at_edges(surface);
  return surface;
}

Voids ignored_voids(Case const& checked) { return checked.machine.frozen_zone ? Voids::under_top : Voids::enclosed; }

HeightMap top_of_solid(SolidField const& solid, Case const& checked) {
  VoxelGrid const& grid = solid.grid;
  SurfaceLevel const level = surface_level(solid, checked.material.density, ignored_voids(checked), 1);
  HeightMap map{grid.origin.x(), grid.origin.y(), grid.cell, grid.n[0], grid.n[1], {}};
  map.values.reserve(static_cast<std::size_t>(solid.columns()));
  for (std::int32_t j = 0; j < grid.n[1]; ++j) {
    for (std::int32_t i = 0; i < grid.n[0]; ++i) map.values.push_back(solid.plate_top() + grid.cell * level.top(i, j));
  }
  return map;
}

}  // namespace layerloop::coupling
