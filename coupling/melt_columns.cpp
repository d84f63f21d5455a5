#include "coupling/melt_columns.hpp"

#include <algorithm>
#include <cmath>

#include "core/compensated_sum.hpp"
#include "coupling/effects/shrinkage.hpp"

namespace layerloop::coupling {
namespace {

constexpr double blocking = 0.5;     ///< fill of a cell that melt rests on
constexpr double conductance = 0.2;  ///< of the levelling; stable below 1/4
constexpr int most_sweeps = 2000;

/// Melt on top of a column, between the last blocking cell and the open sky.
struct OpenMelt {
  std::int64_t base = 0;  ///< layer of its lowest cell
  double volume = 0;      ///< [cells]
  bool wet = false;       ///< takes part in levelling
};

struct Surface {
  double height = 0;      ///< [cells] above the plate
  double free_share = 1;  ///< of the surface cell: room / (1 - metal)
};

class Columns {
 public:
  explicit Columns(MeltColumns const& melt)
      : melt_(melt), nx_(melt.grid.n[0]), ny_(melt.grid.n[1]), layers_(melt.grid.n[2]), count_(nx_ * ny_) {}

  std::int64_t count() const { return count_; }
  std::int64_t layers() const { return layers_; }
  std::int64_t cell(std::int64_t column, std::int64_t k) const { return column + k * count_; }

  double solid(std::int64_t column, std::int64_t k) const { return k < layers_ ? melt_.solid[index(column, k)] : 0.0; }
  double liquid(std::int64_t column, std::int64_t k) const { return melt_.expansion * melt_.liquid[index(column, k)]; }
  double expansion() const { return melt_.expansion; }
  double room(std::int64_t column, std::int64_t k) const {
    return k < layers_ ? std::max(0.0, 1.0 - melt_.solid[index(column, k)] - melt_.grains[index(column, k)]) : 1.0;
  }
  bool blocks(std::int64_t column, std::int64_t k) const {
    return melt_.solid[index(column, k)] + melt_.grains[index(column, k)] >= blocking;
  }
  bool stands_on_melt(std::int64_t column) const { return melt_.molten_plate[static_cast<std::size_t>(column)] != 0; }
  /// The neighbour to the right (axis 0; -1 beyond the wall) or behind (axis 1, periodic).
  std::int64_t next(std::int64_t column, int axis) const {
    std::int64_t const i = column % nx_, j = column / nx_;
    if (axis == 0) return i + 1 < nx_ ? column + 1 : -1;
    return ny_ > 1 ? i + nx_ * ((j + 1) % ny_) : -1;
  }

 private:
  std::size_t index(std::int64_t column, std::int64_t k) const { return static_cast<std::size_t>(cell(column, k)); }

  MeltColumns const& melt_;
  std::int64_t nx_, ny_, layers_, count_;
};

/// Fills [base, end) from below, records where that freezes, and returns what found no room.
double fill_up(Columns const& columns, std::int64_t column, std::int64_t base, std::int64_t end, double volume,
               std::vector<CellVolume>& metal) {
  std::size_t const first = metal.size();
  for (std::int64_t k = base; k < end && volume > 0; ++k) {
    double const taken = std::min(volume, columns.room(column, k));
    if (taken > 0) metal.push_back({columns.cell(column, k), taken});
    volume -= taken;
  }
  shrink(std::span(metal).subspan(first), columns.expansion());
  return volume;
}

/// Lets the melt of one column sink. What lies under a blocking cell comes to rest in `metal`; the rest is returned.
OpenMelt sink(Columns const& columns, std::int64_t column, std::vector<CellVolume>& metal) {
  OpenMelt open;
  for (std::int64_t k = 0; k < columns.layers(); ++k) {
    if (columns.blocks(column, k)) {
      open.volume = fill_up(columns, column, open.base, k, open.volume, metal);
      open.base = k;
    }
    open.volume += columns.liquid(column, k);
  }
  open.wet = open.volume > 0 || (open.base == 0 && columns.stands_on_melt(column));
  return open;
}

Surface surface_of(Columns const& columns, std::int64_t column, OpenMelt const& open) {
  double left = open.volume;
  for (std::int64_t k = open.base;; ++k) {
    double const room = columns.room(column, k);
    if (left > room || room <= 0) {
      left -= room;
      continue;
    }
    double const metal = columns.solid(column, k);
    return {static_cast<double>(k) + metal + (1 - metal) * left / room, room / (1 - metal)};
  }
}

std::vector<Surface> surfaces(Columns const& columns, std::vector<OpenMelt> const& open) {
  std::vector<Surface> all(open.size());
  for (std::size_t c = 0; c < open.size(); ++c) {
    if (open[c].wet) all[c] = surface_of(columns, static_cast<std::int64_t>(c), open[c]);
  }
  return all;
}

/// One conservative sweep: every flux from the same old heights.
void level_once(Columns const& columns, std::vector<OpenMelt>& open) {
  std::vector<Surface> const surface = surfaces(columns, open);
  std::vector<double> change(open.size(), 0.0);
  for (std::size_t a = 0; a < open.size(); ++a) {
    if (!open[a].wet) continue;
    for (int axis : {0, 1}) {
      std::int64_t const next = columns.next(static_cast<std::int64_t>(a), axis);
      if (next < 0 || !open[static_cast<std::size_t>(next)].wet) continue;
      auto const b = static_cast<std::size_t>(next);
      double const free_share = std::min(surface[a].free_share, surface[b].free_share);
      double const flux = conductance * free_share * (surface[a].height - surface[b].height);
      double const limited = std::clamp(flux, -0.25 * open[b].volume, 0.25 * open[a].volume);
      change[a] -= limited;
      change[b] += limited;
    }
  }
  for (std::size_t c = 0; c < open.size(); ++c) open[c].volume = std::max(0.0, open[c].volume + change[c]);
}

/// Mean change of height [cells].
double level(Columns const& columns, std::vector<OpenMelt>& open, double length) {
  std::vector<Surface> const before = surfaces(columns, open);
  double const sweeps = std::ceil(length * length / (2 * conductance));
  for (int sweep = 0; sweep < std::min(sweeps, static_cast<double>(most_sweeps)); ++sweep) level_once(columns, open);

  CompensatedSum change;
  std::int64_t levelled = 0;
  for (std::size_t c = 0; c < open.size(); ++c) {
    if (!open[c].wet) continue;
    ++levelled;
    change.add(std::abs(surface_of(columns, static_cast<std::int64_t>(c), open[c]).height - before[c].height));
  }
  return levelled > 0 ? change.value() / static_cast<double>(levelled) : 0.0;
}

}  // namespace

SettledMelt settle_melt(MeltColumns const& melt, double length) {
  Columns const columns(melt);
  SettledMelt settled;
  std::vector<OpenMelt> open(static_cast<std::size_t>(columns.count()));
  for (std::int64_t column = 0; column < columns.count(); ++column) {
    open[static_cast<std::size_t>(column)] = sink(columns, column, settled.metal);
  }
  settled.mean_height_change = melt.grid.cell * level(columns, open, length / melt.grid.cell);
  for (std::int64_t column = 0; column < columns.count(); ++column) {
    OpenMelt const& top = open[static_cast<std::size_t>(column)];
    double const left = fill_up(columns, column, top.base, columns.layers(), top.volume, settled.metal);
    if (left > 0)
      settled.metal.push_back(
          {columns.cell(column, columns.layers()), left / melt.expansion});  // beyond the grid's last layer
  }
  return settled;
}

}  // namespace layerloop::coupling
