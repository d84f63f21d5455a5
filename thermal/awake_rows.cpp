#include "thermal/awake_rows.hpp"

#include <algorithm>
#include <limits>

namespace layerloop::thermal {
namespace {

constexpr std::int32_t nowhere_begin = std::numeric_limits<std::int32_t>::max() / 2, nowhere_end = -nowhere_begin;

/// Place of a local cell along x, y and z in the grid.
std::array<std::int32_t, 3> place(LocalBox const& box, std::int64_t cell) {
  return {static_cast<std::int32_t>(cell % box.stride_y()) - 1 + box.begin[0],
          static_cast<std::int32_t>(cell % box.stride_z() / box.stride_y()) - 1 + box.begin[1],
          static_cast<std::int32_t>(cell / box.stride_z()) - 1 + box.begin[2]};
}

}  // namespace

void AwakeRows::update(Conduction const& conduction, HeatGrid const& grid, std::span<double const> enthalpy,
                       double floor, std::span<CellPower const> source, int passes) {
  if (cold == Cold::awake) {
    stepped_ = conduction.rows;
    looked_up_ = conduction.rows_with_neighbours;
    return;
  }
  if (source_has_changed(grid, source)) passes_left_ = 0;
  if (floor < floor_) forget();
  floor_ = floor;
  passes_left_ -= passes;
  if (passes_left_ >= 0) return;
  n_ = grid.cells();
  find_warm(conduction, enthalpy, floor, source);
  grid.unite(std::span(reinterpret_cast<std::int32_t*>(warm_.data()), 2 * warm_.size()));
  int const reach = std::min(std::max(passes, passes_between_looks), *std::ranges::max_element(n_));
  widen(reach, grid.periodic_y());
  cut(conduction.box, conduction.rows, stepped_);
  widen(1, grid.periodic_y());
  cut(conduction.box, conduction.rows_with_neighbours, looked_up_);
  passes_left_ = reach - passes;
  known_ = true;
}

bool AwakeRows::source_has_changed(HeatGrid const& grid, std::span<CellPower const> source) {
  bool const same = std::ranges::equal(source, heated_, {}, &CellPower::cell);
  if (!same) {
    heated_.clear();
    for (CellPower const& heated : source) heated_.push_back(heated.cell);
  }
  return grid.any(!same);
}

void AwakeRows::find_warm(Conduction const& conduction, std::span<double const> enthalpy, double floor,
                          std::span<CellPower const> source) {
  LocalBox const& box = conduction.box;
  warm_.assign(static_cast<std::size_t>(n_[1]) * static_cast<std::size_t>(n_[2]), {nowhere_begin, nowhere_end});
  auto const include = [&](std::int64_t first, std::int64_t last) {
    auto const [x, y, z] = place(box, first);
    Stretch& row = warm_[static_cast<std::size_t>(y + n_[1] * z)];
    row.begin = std::min(row.begin, x);
    row.end = std::max(row.end, x + static_cast<std::int32_t>(last - first) + 1);
  };
  for (Row row : known_ ? std::span<Row const>(stepped_) : conduction.rows) {
    while (row.begin < row.end && !(enthalpy[row.begin] > floor)) ++row.begin;
    while (row.begin < row.end && !(enthalpy[row.end - 1] > floor)) --row.end;
    if (row.begin < row.end) include(row.begin, row.end - 1);
  }
  for (CellPower const& heated : source) include(heated.cell, heated.cell);
}

/// Every row takes in what its neighbours within `reach` along y and z hold, and `reach` more cells at its ends.
void AwakeRows::widen(std::int32_t reach, bool periodic_y) {
  auto const pass = [&](std::int32_t axis, std::int32_t beyond) {
    scratch_ = warm_;
    std::int32_t const along = n_[static_cast<std::size_t>(axis)], stride = axis == 1 ? 1 : n_[1];
    for (std::int32_t r = 0; r < n_[1] * n_[2]; ++r) {
      Stretch const from = scratch_[static_cast<std::size_t>(r)];
      if (from.begin >= from.end) continue;
      std::int32_t const at = axis == 1 ? r % n_[1] : r / n_[1];
      for (std::int32_t step = -reach; step <= reach; ++step) {
        std::int32_t to = at + step;
        if (axis == 1 && periodic_y) to = (to % along + along) % along;
        if (to < 0 || to >= along) continue;
        Stretch& row = warm_[static_cast<std::size_t>(r + (to - at) * stride)];
        row.begin = std::min(row.begin, from.begin - beyond);
        row.end = std::max(row.end, from.end + beyond);
      }
    }
  };
  pass(1, reach);
  pass(2, 0);
}

void AwakeRows::cut(LocalBox const& box, std::span<Row const> rows, std::vector<Row>& parts) const {
  parts.clear();
  for (Row const& row : rows) {
    auto const [x, y, z] = place(box, row.begin);
    // the neighbours' layer of a periodic side shows the other side; edges of the box are nobody's neighbours
    std::int32_t const j = (y + n_[1]) % n_[1], k = std::clamp(z, 0, n_[2] - 1);
    Stretch const& awake = warm_[static_cast<std::size_t>(j + n_[1] * k)];
    std::int64_t const begin = std::clamp<std::int64_t>(row.begin + awake.begin - x, row.begin, row.end);
    parts.push_back({begin, std::clamp<std::int64_t>(row.begin + awake.end - x, begin, row.end)});
  }
}

}  // namespace layerloop::thermal
