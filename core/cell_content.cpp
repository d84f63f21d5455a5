#include "core/cell_content.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace layerloop {
namespace {

constexpr int chords = 8;  // per cell edge

struct Range {
  std::int64_t from, to;  // [from, to)
};

/// Cells of one axis that [low, high] touches.
Range touched(double low, double high) {
  return {static_cast<std::int64_t>(std::floor(low)), static_cast<std::int64_t>(std::ceil(high))};
}

/// Adds the length of one vertical chord [low, high] (in cells) to each cell of the column.
void add_chord(double low, double high, Range cells, std::vector<double>& column) {
  for (std::int64_t k = std::max(cells.from, static_cast<std::int64_t>(std::floor(low)));
       k < cells.to && static_cast<double>(k) < high; ++k) {
    double const bottom = std::max(low, static_cast<double>(k));
    double const top = std::min(high, static_cast<double>(k + 1));
    column[static_cast<std::size_t>(k - cells.from)] += std::max(0.0, top - bottom);
  }
}

/// Fills a column of cells with the fraction of each that the sphere takes; centre and radius in cells.
void sample_column(Vec3 const& centre, double radius, std::int64_t i, std::int64_t j, Range z,
                   std::vector<double>& column) {
  std::fill(column.begin(), column.end(), 0.0);
  for (int chord = 0; chord < chords * chords; ++chord) {
    double const dx = static_cast<double>(i) + (chord % chords + 0.5) / chords - centre.x();
    double const dy = static_cast<double>(j) + (chord / chords + 0.5) / chords - centre.y();
    double const half_squared = radius * radius - dx * dx - dy * dy;
    if (half_squared <= 0) continue;
    add_chord(centre.z() - std::sqrt(half_squared), centre.z() + std::sqrt(half_squared), z, column);
  }
  for (double& f : column) f = std::min(1.0, f / (chords * chords));
}

void merge_equal_cells(std::vector<GrainShare>& shares) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](GrainShare const& a, GrainShare const& b) { return a.cell < b.cell; });
  std::size_t kept = 0;
  for (std::size_t s = 0; s < shares.size(); ++s) {
    if (kept > 0 && shares[kept - 1].cell == shares[s].cell) {
      shares[kept - 1].volume += shares[s].volume;
    } else {
      shares[kept++] = shares[s];
    }
  }
  shares.resize(kept);
}

}  // namespace

std::vector<GrainShare> grain_shares(PowderBed const& bed, std::size_t row, VoxelGrid const& grid, double period_y) {
  Vec3 const c = (bed.position(row) - grid.origin) / grid.cell;  // everything below is in cells
  double const r = bed.radius[row] / grid.cell;
  Range const x = touched(c.x() - r, c.x() + r), y = touched(c.y() - r, c.y() + r), z = touched(c.z() - r, c.z() + r);
  auto const period = static_cast<std::int64_t>(std::llround(period_y / grid.cell));

  std::vector<GrainShare> shares;
  std::vector<double> column(static_cast<std::size_t>(z.to - z.from));
  double sampled = 0, cut = 0;  // volume by chords and sum of f (1 - f), in the grid or not
  for (std::int64_t j = y.from; j < y.to; ++j) {
    for (std::int64_t i = x.from; i < x.to; ++i) {
      sample_column(c, r, i, j, z, column);
      std::int64_t const wrapped = period > 0 ? ((j % period) + period) % period : j;
      for (std::int64_t k = z.from; k < z.to; ++k) {
        double const f = column[static_cast<std::size_t>(k - z.from)];
        sampled += f;
        cut += f * (1 - f);
        if (f > 0 && grid.contains({i, wrapped, k})) shares.push_back({grid.index(i, wrapped, k), f});
      }
    }
  }
  double const volume = bed.volume(row), missing = volume / grid.cell_volume() - sampled;
  if (sampled == 0) {  // the grain slips between the chords: it lies in one cell
    auto cell = grid.locate(bed.position(row));
    if (period > 0) cell[1] = ((cell[1] % period) + period) % period;
    if (grid.contains(cell)) shares.push_back({grid.index(cell[0], cell[1], cell[2]), volume});
    return shares;
  }
  bool const fine_grid = std::abs(missing) <= cut;  // else the grain is about as small as a cell
  for (GrainShare& share : shares) {
    double const f = share.volume;
    share.volume = fine_grid ? grid.cell_volume() * (f + missing / cut * f * (1 - f)) : volume * f / sampled;
  }
  merge_equal_cells(shares);
  return shares;
}

}  // namespace layerloop
