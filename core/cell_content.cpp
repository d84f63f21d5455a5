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
  double sampled = 0;  // volume by chords, inside the grid or not
  for (std::int64_t j = y.from; j < y.to; ++j) {
    for (std::int64_t i = x.from; i < x.to; ++i) {
      std::fill(column.begin(), column.end(), 0.0);
      for (int chord = 0; chord < chords * chords; ++chord) {
        double const dx = static_cast<double>(i) + (chord % chords + 0.5) / chords - c.x();
        double const dy = static_cast<double>(j) + (chord / chords + 0.5) / chords - c.y();
        double const half_squared = r * r - dx * dx - dy * dy;
        if (half_squared <= 0) continue;
        add_chord(c.z() - std::sqrt(half_squared), c.z() + std::sqrt(half_squared), z, column);
      }
      std::int64_t const wrapped = period > 0 ? ((j % period) + period) % period : j;
      for (std::int64_t k = z.from; k < z.to; ++k) {
        double const volume = column[static_cast<std::size_t>(k - z.from)];
        sampled += volume;
        if (volume > 0 && grid.contains({i, wrapped, k})) shares.push_back({grid.index(i, wrapped, k), volume});
      }
    }
  }
  if (sampled == 0) {  // the grain slips between the chords: it lies in one cell
    auto cell = grid.locate(bed.position(row));
    if (period > 0) cell[1] = ((cell[1] % period) + period) % period;
    if (grid.contains(cell)) shares.push_back({grid.index(cell[0], cell[1], cell[2]), bed.volume(row)});
    return shares;
  }
  double const scale = bed.volume(row) / sampled;
  for (GrainShare& share : shares) share.volume *= scale;
  merge_equal_cells(shares);
  return shares;
}

}  // namespace layerloop
