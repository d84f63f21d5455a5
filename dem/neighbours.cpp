#include "dem/neighbours.hpp"

#include <algorithm>

namespace layerloop::dem {
namespace {

/// Cells along one direction, at least as large as the reach of a pair.
struct Axis {
  double low, size;
  std::int32_t cells;
  bool repeats;

  /// Fewer than three cells of a period would meet themselves: then there is one, and no neighbour of it.
  static Axis over(double period, double low, double high, double reach) {
    if (!std::isfinite(period)) return {low, reach, static_cast<std::int32_t>((high - low) / reach) + 1, false};
    auto const cells = period >= 3 * reach ? static_cast<std::int32_t>(period / reach) : 1;
    return {0, period / cells, cells, true};
  }
  std::int32_t cell(double at) const { return std::clamp(static_cast<std::int32_t>((at - low) / size), 0, cells - 1); }
  /// Calls visit(cell) for `middle` and its neighbours.
  template <class Visit>
  void around(std::int32_t middle, Visit const& visit) const {
    if (cells == 1) return visit(0);
    for (std::int32_t c = middle - 1; c <= middle + 1; ++c) {
      if (repeats)
        visit(c < 0 ? c + cells : (c >= cells ? c - cells : c));
      else if (c >= 0 && c < cells)
        visit(c);
    }
  }
};

/// Rows sorted into cells.
struct Cells {
  Axis x, y, z;
  std::vector<std::int32_t> begin, rows;

  std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>((std::int64_t{i} * z.cells + k) * y.cells + j);
  }
};

Cells sort_into_cells(Grains const& g, double reach, Period const& period) {
  double x_low = g[0].x, x_high = x_low, y_low = g[0].y, y_high = y_low, z_low = g[0].z, z_high = z_low;
  for (std::size_t i = 0; i < g.size(); ++i) {
    x_low = std::min(x_low, g[i].x), x_high = std::max(x_high, g[i].x);
    y_low = std::min(y_low, g[i].y), y_high = std::max(y_high, g[i].y);
    z_low = std::min(z_low, g[i].z), z_high = std::max(z_high, g[i].z);
  }
  Cells cells{Axis::over(period.x, x_low, x_high, reach),
              Axis::over(period.y, y_low, y_high, reach),
              Axis::over(INFINITY, z_low, z_high, reach),
              {},
              {}};
  std::vector<std::uint32_t> cell(g.size());
  cells.begin.assign(cells.index(cells.x.cells, 0, 0) + 1, 0);
  for (std::size_t i = 0; i < g.size(); ++i) {
    cell[i] = static_cast<std::uint32_t>(cells.index(cells.x.cell(g[i].x), cells.y.cell(g[i].y), cells.z.cell(g[i].z)));
    ++cells.begin[cell[i] + 1];
  }
  for (std::size_t c = 1; c < cells.begin.size(); ++c) cells.begin[c] += cells.begin[c - 1];
  std::vector<std::int32_t> next(cells.begin.begin(), cells.begin.end() - 1);
  cells.rows.resize(g.size());
  for (std::size_t i = 0; i < g.size(); ++i)
    cells.rows[static_cast<std::size_t>(next[cell[i]]++)] = static_cast<std::int32_t>(i);
  return cells;
}

/// Adds the pairs of owned row `a` with later rows.
void add_pairs_of(Neighbours& pairs, Grains const& g, Cells const& cells, std::size_t a, double skin,
                  Period const& period) {
  GrainState const here = g[a];
  std::int64_t const id = g.id[a];
  cells.x.around(cells.x.cell(here.x), [&](std::int32_t i) {
    cells.z.around(cells.z.cell(here.z), [&](std::int32_t k) {
      cells.y.around(cells.y.cell(here.y), [&](std::int32_t j) {
        std::size_t const c = cells.index(i, j, k);
        for (std::int32_t at = cells.begin[c]; at < cells.begin[c + 1]; ++at) {
          auto const b = static_cast<std::size_t>(cells.rows[static_cast<std::size_t>(at)]);
          if (b <= a) continue;
          GrainState const& there = g[b];
          double const dx = wrapped(here.x - there.x, period.x), dy = wrapped(here.y - there.y, period.y),
                       dz = here.z - there.z, reach = here.radius + there.radius + skin;
          if (dx * dx + dy * dy + dz * dz >= reach * reach) continue;
          bool const ascending = id < g.id[b];
          pairs.first.push_back(static_cast<std::int32_t>(ascending ? a : b));
          pairs.second.push_back(static_cast<std::int32_t>(ascending ? b : a));
        }
      });
    });
  });
}

void take_over_springs(Neighbours& pairs, Grains const& g, std::vector<ContactSpring> const& springs) {
  pairs.spring.assign(pairs.size(), no_spring);
  pairs.dormant.clear();
  if (springs.empty()) return;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    auto const i = static_cast<std::size_t>(pairs.first[k]), j = static_cast<std::size_t>(pairs.second[k]);
    if (ContactSpring const* old = find_spring(springs, g.id[i], g.id[j])) {
      pairs.spring[k] = dormant_spring(pairs.dormant.size());
      pairs.dormant.push_back(
          {old->spring[0], old->spring[1], old->spring[2], old->turn[0], old->turn[1], old->turn[2]});
    }
  }
}

}  // namespace

void build_neighbours(Neighbours& pairs, Grains const& g, double skin, Period const& period,
                      std::vector<ContactSpring> const& springs) {
  pairs.first.clear();
  pairs.second.clear();
  pairs.begin.assign(1, 0);
  if (g.size() > 0) {
    double largest = 0;
    for (std::size_t i = 0; i < g.size(); ++i) largest = std::max(largest, g[i].radius);
    Cells const cells = sort_into_cells(g, 2 * largest + skin, period);
    for (std::size_t a = 0; a < g.owned; ++a) {
      add_pairs_of(pairs, g, cells, a, skin, period);
      pairs.begin.push_back(static_cast<std::int32_t>(pairs.size()));
    }
  }
  take_over_springs(pairs, g, springs);
}

}  // namespace layerloop::dem
