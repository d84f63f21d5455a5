#include "thermal/heat_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <tuple>

#include "core/error.hpp"

namespace layerloop::thermal {
namespace {

void check(CellContent const& content) {
  auto const n = static_cast<std::size_t>(content.grid.size());
  if (content.solid.size() != n || content.powder.size() != n || content.grain.size() != n || n == 0) {
    throw InputError(fmt::format("cell content has {} solid, {} powder and {} grain entries (the grid has {} cells)",
                                 content.solid.size(), content.powder.size(), content.grain.size(), n));
  }
  for (std::size_t c = 0; c < n; ++c) {
    double const metal = content.solid[c] + content.powder[c];
    if (!(content.solid[c] >= 0 && content.powder[c] >= 0 && metal <= 1 + 1e-9)) {
      throw InputError(fmt::format("cell {} holds {} solid and {} powder (volume fractions lie in [0, 1] together)", c,
                                   content.solid[c], content.powder[c]));
    }
  }
}

/// Host among the 26 cells around, in the order that HeatCells states; -1: none. Among equals the one below, then the
/// one at lower x: mirrored beds get mirrored hosts.
std::int64_t best_neighbour(HeatCells const& cells, std::vector<double> const& metal, std::int64_t cell) {
  auto const c = cells.grid.coordinates(cell);
  std::int64_t best = -1;
  std::tuple<int, int, double, int, int, int> best_rank;  // the smallest wins
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        std::array<std::int64_t, 3> at{c[0] + dx, c[1] + dy, c[2] + dz};
        if (cells.side_y == SideY::periodic) at[1] = (at[1] + cells.grid.n[1]) % cells.grid.n[1];
        if (!cells.grid.contains(at)) continue;
        std::int64_t const candidate = cells.grid.index(at[0], at[1], at[2]);
        if (metal[candidate] < HeatCells::least_fill) continue;
        bool const other_body = cells.body[candidate] != cells.body[cell];
        std::tuple const rank{int{other_body},
                              std::abs(dx) + std::abs(dy) + std::abs(dz),
                              -std::round(1e6 * metal[candidate]),
                              dz,
                              dx,
                              dy};
        if (best < 0 || rank < best_rank) best = candidate, best_rank = rank;
      }
    }
  }
  return best;
}

/// Fills the hosts that are still unknown (-1) from the nearest cell that has an unknown, counted in steps through
/// faces.
void spread_hosts(HeatCells& cells) {
  std::vector<std::int64_t> nearest(cells.host.size(), -1);
  std::deque<std::int64_t> front;
  for (std::int64_t c = 0; c < cells.grid.size(); ++c) {
    if (cells.host[c] != c) continue;
    nearest[c] = c;
    front.push_back(c);
  }
  while (!front.empty()) {
    std::int64_t const c = front.front();
    front.pop_front();
    for (int axis = 2; axis >= 0; --axis) {
      for (int step : {-1, 1}) {
        std::int64_t const next = cells.neighbour(cells.grid.coordinates(c), axis, step);
        if (next < 0 || nearest[next] >= 0) continue;
        nearest[next] = nearest[c];
        front.push_back(next);
      }
    }
  }
  for (std::size_t c = 0; c < cells.host.size(); ++c) {
    if (cells.host[c] < 0) cells.host[c] = nearest[c];
  }
}

}  // namespace

std::int64_t HeatCells::neighbour(std::array<std::int32_t, 3> c, int axis, int step) const {
  auto const a = static_cast<std::size_t>(axis);
  c[a] += step;
  if (axis == 1 && side_y == SideY::periodic) c[1] = (c[1] + grid.n[1]) % grid.n[1];
  return c[a] < 0 || c[a] >= grid.n[a] ? -1 : grid.index(c[0], c[1], c[2]);
}

HeatCells make_heat_cells(CellContent const& content, SideY side_y) {
  check(content);
  auto const n = content.solid.size();
  HeatCells cells{content.grid,
                  side_y,
                  std::vector<double>(n, 0),
                  std::vector<std::int32_t>(n, -1),
                  std::vector<std::int64_t>(n, -1),
                  std::vector<char>(n, 0),
                  0};
  std::vector<double> metal(n);
  for (std::size_t c = 0; c < n; ++c) {
    metal[c] = content.solid[c] + content.powder[c];
    cells.metal[c] = metal[c] > 0;
    if (content.powder[c] > content.solid[c]) cells.body[c] = content.grain[c];
    if (metal[c] >= HeatCells::least_fill) {
      cells.host[c] = static_cast<std::int64_t>(c);
      cells.fill[c] = metal[c];
      ++cells.unknowns;
    }
  }
  if (cells.unknowns == 0) {
    throw InputError(
        "the heat grid holds no metal (nothing to heat) check heat.substrate_depth and the place of the scan");
  }
  for (std::size_t c = 0; c < n; ++c) {
    if (cells.metal[c] && cells.host[c] < 0) cells.host[c] = best_neighbour(cells, metal, static_cast<std::int64_t>(c));
  }
  spread_hosts(cells);
  for (std::size_t c = 0; c < n; ++c) {
    if (cells.host[c] != static_cast<std::int64_t>(c)) cells.fill[static_cast<std::size_t>(cells.host[c])] += metal[c];
  }
  return cells;
}

double open_area(HeatCells const& cells, std::int64_t cell) {
  auto const c = cells.grid.coordinates(cell);
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis) {
    int open = 0;
    for (int step : {-1, 1}) {
      std::int64_t const next = cells.neighbour(c, axis, step);
      bool const top = axis == 2 && step == 1;
      open += next < 0 ? top : cells.fill[next] == 0;
    }
    squares += open * open;
  }
  return std::sqrt(squares);
}

}  // namespace layerloop::thermal
