#include "thermal/melt_pool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace layerloop::thermal {
namespace {

/// The plane across a track. Shapes: ny * nz, steps across the track fastest.
struct Plane {
  std::int32_t ny, nz;
  std::vector<float> temperature;    ///< below zero: no metal
  std::vector<double> surface, top;  ///< of the solid, and of powder and solid, in each column [cells]; shape ny

  float at(std::int32_t j, std::int32_t k) const {
    bool const inside = j >= 0 && j < ny && k >= 0 && k < nz;
    return inside ? temperature[static_cast<std::size_t>(j + ny * k)] : -1;
  }
};

/// Temperatures of one column of the plane: where at least half of the neighbours' share is metal, that metal's mean.
void sample_column(HeatCells const& cells, std::span<float const> temperature, CellContent const& content,
                   std::vector<SampleLine::Corner> const& corners, std::int32_t j, Plane& plane) {
  for (SampleLine::Corner const& corner : corners) {
    double surface = 0, top = 0;
    for (std::int32_t k = 0; k < plane.nz; ++k) {
      auto const c = static_cast<std::size_t>(cells.grid.index(corner.i, corner.j, k));
      if (content.solid[c] > 0) surface = k + content.solid[c];
      if (content.solid[c] + content.powder[c] > 0) top = k + content.solid[c] + content.powder[c];
    }
    plane.surface[static_cast<std::size_t>(j)] += corner.share * surface;
    plane.top[static_cast<std::size_t>(j)] += corner.share * top;
  }
  for (std::int32_t k = 0; k < plane.nz; ++k) {
    double metal = 0, sum = 0;
    for (SampleLine::Corner const& corner : corners) {
      auto const c = static_cast<std::size_t>(cells.grid.index(corner.i, corner.j, k));
      if (!cells.metal[c]) continue;
      metal += corner.share;
      sum += corner.share * temperature[c];
    }
    if (metal >= 0.5) plane.temperature[static_cast<std::size_t>(j + plane.ny * k)] = static_cast<float>(sum / metal);
  }
}

Plane plane_across(HeatCells const& cells, std::span<float const> temperature, CellContent const& content,
                   Vec3 const& at, Vec3 const& along) {
  SampleLine const line(cells, at, {-along.y(), along.x(), 0});
  auto const ny = static_cast<std::size_t>(line.last - line.first + 1);
  Plane plane{
      static_cast<std::int32_t>(ny), cells.grid.n[2], {}, std::vector<double>(ny, 0), std::vector<double>(ny, 0)};
  plane.temperature.assign(ny * static_cast<std::size_t>(plane.nz), -1.0F);
  for (std::int32_t j = 0; j < plane.ny; ++j)
    sample_column(cells, temperature, content, line.corners(line.first + j), j, plane);
  return plane;
}

using Patch = std::vector<std::array<std::int32_t, 2>>;  // (j, k) of its cells

/// Largest set of cells at or above the isotherm that hang together through faces; the first found among equals.
Patch largest_patch(Plane const& plane, double isotherm) {
  std::vector<char> seen(plane.temperature.size(), 0);
  Patch largest;
  for (std::int32_t k0 = 0; k0 < plane.nz; ++k0) {
    for (std::int32_t j0 = 0; j0 < plane.ny; ++j0) {
      Patch patch;
      auto const visit = [&](std::int32_t j, std::int32_t k) {
        if (plane.at(j, k) < isotherm || seen[static_cast<std::size_t>(j + plane.ny * k)]) return;
        seen[static_cast<std::size_t>(j + plane.ny * k)] = 1;
        patch.push_back({j, k});
      };
      visit(j0, k0);
      for (std::size_t next = 0; next < patch.size(); ++next) {
        auto const [j, k] = patch[next];
        visit(j - 1, k), visit(j + 1, k), visit(j, k - 1), visit(j, k + 1);
      }
      if (patch.size() > largest.size()) largest = std::move(patch);
    }
  }
  return largest;
}

/// Distance [cells] from the centre of a cell above the isotherm to its edge towards a neighbour.
double reach(double inside, double neighbour, double isotherm) {
  if (neighbour < 0) return 0.5;
  if (neighbour >= isotherm) return 1;
  return (inside - isotherm) / (inside - neighbour);
}

/// Mean of a height over the columns that hold melt.
double mean_over(std::vector<double> const& molten, std::vector<double> const& height) {
  double sum = 0, columns = 0;
  for (std::size_t j = 0; j < molten.size(); ++j) {
    if (molten[j] == 0) continue;
    sum += height[j];
    ++columns;
  }
  return sum / columns;
}

/// Area [cells^2] under the molten extents of neighbouring columns: trapezia between them, and towards the edges, where
/// a section ends like a parabola, two thirds of the rectangle.
double area_under(std::vector<double> const& molten, double left, double right) {
  double area = 0;
  auto const columns = static_cast<std::int64_t>(molten.size());
  for (std::int64_t j = 0; j < columns; ++j) {
    auto const at = [&](std::int64_t i) { return i < 0 || i >= columns ? 0.0 : molten[static_cast<std::size_t>(i)]; };
    if (at(j) == 0) continue;
    double const at_j = static_cast<double>(j);
    area += at(j - 1) > 0 ? 0.5 * at(j) : 2.0 / 3 * at(j) * std::clamp(at_j - left, 0.0, 1.0);
    area += at(j + 1) > 0 ? 0.5 * at(j) : 2.0 / 3 * at(j) * std::clamp(right - at_j, 0.0, 1.0);
  }
  return area;
}

}  // namespace

SampleLine::SampleLine(HeatCells const& cells, Vec3 const& through, Vec3 const& direction)
    : first(0), last(0), cells_(cells), dx_(direction.x()), dy_(direction.y()) {
  VoxelGrid const& grid = cells.grid;
  auto const cell = grid.locate(through);
  x_ = static_cast<double>(cell[0]), y_ = static_cast<double>(cell[1]);
  bool const wraps = cells.side_y == SideY::periodic;
  // A periodic grid is gone through once across, as far to one side as to the other.
  std::int64_t const most = wraps ? static_cast<std::int64_t>(grid.n[1] / 2 / std::max(std::abs(dy_), 1e-9))
                                  : std::int64_t{grid.n[0]} + grid.n[1];
  std::int64_t const widest = std::min(most, std::int64_t{grid.n[0]} + grid.n[1]);
  bool const even = wraps && grid.n[1] % 2 == 0 && dx_ == 0;
  while (-first < widest && !corners(first - 1).empty()) --first;
  while (last < widest - even && !corners(last + 1).empty()) ++last;
}

std::vector<SampleLine::Corner> SampleLine::corners(std::int64_t step, std::int64_t aside) const {
  constexpr double slack = 1e-6;  // a line along an axis meets cell centres
  VoxelGrid const& grid = cells_.grid;
  auto const s = static_cast<double>(step), a = static_cast<double>(aside);
  double const x = x_ + s * dx_ - a * dy_, y = y_ + s * dy_ + a * dx_;
  auto const i0 = static_cast<std::int64_t>(std::floor(x + slack)),
             j0 = static_cast<std::int64_t>(std::floor(y + slack));
  double const wx = std::max(0.0, x - static_cast<double>(i0)), wy = std::max(0.0, y - static_cast<double>(j0));
  std::vector<Corner> found;
  for (int at = 0; at < 4; ++at) {
    double const share = (at % 2 == 0 ? 1 - wx : wx) * (at / 2 == 0 ? 1 - wy : wy);
    if (share < slack) continue;
    std::int64_t const i = i0 + at % 2;
    std::int64_t j = j0 + at / 2;
    if (cells_.side_y == SideY::periodic) j = (j % grid.n[1] + grid.n[1]) % grid.n[1];
    if (i < 0 || i >= grid.n[0] || j < 0 || j >= grid.n[1]) return {};
    found.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), share});
  }
  return found;
}

std::optional<TrackSection> measure_section(HeatCells const& cells, std::span<float const> temperature,
                                            CellContent const& content, Vec3 const& at, Vec3 const& along,
                                            double isotherm) {
  Plane const plane = plane_across(cells, temperature, content, at, along);
  Patch const patch = largest_patch(plane, isotherm);
  if (patch.empty()) return std::nullopt;
  double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left;
  std::vector<double> molten(plane.surface.size(), 0), molten_below(plane.surface.size(), 0);  // of each column [cells]
  auto const half = [](double edge) { return edge == 1 ? 0.5 : edge; };  // of the way to a neighbour that is molten too
  for (auto const& [j, k] : patch) {
    double const T = plane.at(j, k), down = reach(T, plane.at(j, k - 1), isotherm);
    left = std::min(left, j - reach(T, plane.at(j - 1, k), isotherm));
    right = std::max(right, j + reach(T, plane.at(j + 1, k), isotherm));
    bottom = std::min(bottom, k + 0.5 - down);
    auto const column = static_cast<std::size_t>(j);
    double const extent = half(down) + half(reach(T, plane.at(j, k + 1), isotherm));
    molten[column] += extent;
    if (k + 0.5 < plane.surface[column]) molten_below[column] += extent;
  }
  double const cell = cells.grid.cell, surface = mean_over(molten, plane.surface), top = mean_over(molten, plane.top);
  return TrackSection{.width = (right - left) * cell,
                      .depth = std::max(0.0, surface - bottom) * cell,
                      .depth_from_top = std::max(0.0, top - bottom) * cell,
                      .area = area_under(molten, left, right) * cell * cell,
                      .area_below = area_under(molten_below, left, right) * cell * cell};
}

double measure_length(std::span<float const> profile, double cell, double isotherm) {
  if (profile.empty()) return 0;
  auto const peak = std::max_element(profile.begin(), profile.end()) - profile.begin();
  if (profile[static_cast<std::size_t>(peak)] < isotherm) return 0;
  auto const at = [&](std::ptrdiff_t i) {
    return i >= 0 && i < std::ssize(profile) ? static_cast<double>(profile[static_cast<std::size_t>(i)]) : -1.0;
  };
  std::ptrdiff_t first = peak, last = peak;
  while (at(first - 1) >= isotherm) --first;
  while (at(last + 1) >= isotherm) ++last;
  return cell * (static_cast<double>(last - first) + reach(at(first), at(first - 1), isotherm) +
                 reach(at(last), at(last + 1), isotherm));
}

namespace {

struct Moments {
  double mean = 0, variance = 0;
};

template <class Values, class Get>
Moments moments(Values const& values, Get get) {
  Moments m;
  if (values.empty()) return m;
  auto const n = static_cast<double>(values.size());
  for (auto const& v : values) m.mean += get(v) / n;
  for (auto const& v : values) m.variance += (get(v) - m.mean) * (get(v) - m.mean) / std::max(1.0, n - 1);
  return m;
}

}  // namespace

TrackPool summarise(std::span<TrackSection const> sections, std::span<double const> lengths) {
  Moments const width = moments(sections, [](TrackSection const& s) { return s.width; });
  Moments const depth = moments(sections, [](TrackSection const& s) { return s.depth; });
  Moments const length = moments(lengths, [](double l) { return l; });
  return {{width.mean, depth.mean, length.mean}, {width.variance, depth.variance, length.variance}};
}

}  // namespace layerloop::thermal
