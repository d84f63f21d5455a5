#include "thermal/melt_pool.hpp"

#include <algorithm>
#include <limits>

namespace layerloop::thermal {
namespace {

/// The plane of cells i, unrolled so that the track lies in the middle of a periodic grid. Shapes: ny * nz, y fastest.
struct Plane {
  std::int32_t ny, nz;
  std::vector<float> temperature;  ///< below zero: no metal
  std::vector<double> surface;     ///< top of the solid in each column [cells]; shape ny

  float at(std::int32_t j, std::int32_t k) const {
    bool const inside = j >= 0 && j < ny && k >= 0 && k < nz;
    return inside ? temperature[static_cast<std::size_t>(j + ny * k)] : -1;
  }
};

Plane unroll(HeatCells const& cells, std::span<float const> temperature, std::span<double const> solid, std::int32_t i,
             double track_y) {
  VoxelGrid const& grid = cells.grid;
  Plane plane{grid.n[1], grid.n[2], {}, std::vector<double>(static_cast<std::size_t>(grid.n[1]), 0)};
  plane.temperature.resize(static_cast<std::size_t>(plane.ny) * static_cast<std::size_t>(plane.nz));
  std::int64_t first = 0;
  if (cells.side_y == SideY::periodic) {
    first = grid.locate({grid.origin.x(), track_y, grid.origin.z()})[1] - plane.ny / 2;
    first = (first % plane.ny + plane.ny) % plane.ny;
  }
  for (std::int32_t k = 0; k < plane.nz; ++k) {
    for (std::int32_t j = 0; j < plane.ny; ++j) {
      auto const c = static_cast<std::size_t>(grid.index(i, (first + j) % plane.ny, k));
      plane.temperature[static_cast<std::size_t>(j + plane.ny * k)] = cells.metal[c] ? temperature[c] : -1;
      if (solid[c] > 0) plane.surface[static_cast<std::size_t>(j)] = k + solid[c];
    }
  }
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

}  // namespace

std::optional<PoolSize> measure_section(HeatCells const& cells, std::span<float const> temperature,
                                        std::span<double const> solid, std::int32_t i, double track_y,
                                        double isotherm) {
  Plane const plane = unroll(cells, temperature, solid, i, track_y);
  Patch const patch = largest_patch(plane, isotherm);
  if (patch.empty()) return std::nullopt;
  double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left, surface = 0;
  std::vector<char> counted(plane.surface.size(), 0);
  std::int64_t columns = 0;
  for (auto const& [j, k] : patch) {
    double const T = plane.at(j, k);
    left = std::min(left, j - reach(T, plane.at(j - 1, k), isotherm));
    right = std::max(right, j + reach(T, plane.at(j + 1, k), isotherm));
    bottom = std::min(bottom, k + 0.5 - reach(T, plane.at(j, k - 1), isotherm));
    if (counted[static_cast<std::size_t>(j)]) continue;
    counted[static_cast<std::size_t>(j)] = 1;
    surface += plane.surface[static_cast<std::size_t>(j)];
    ++columns;
  }
  double const cell = cells.grid.cell;
  return PoolSize{(right - left) * cell, std::max(0.0, surface / static_cast<double>(columns) - bottom) * cell, 0};
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

TrackPool summarise(std::span<PoolSize const> sections, std::span<double const> lengths) {
  Moments const width = moments(sections, [](PoolSize const& s) { return s.width; });
  Moments const depth = moments(sections, [](PoolSize const& s) { return s.depth; });
  Moments const length = moments(lengths, [](double l) { return l; });
  return {{width.mean, depth.mean, length.mean}, {width.variance, depth.variance, length.variance}};
}

}  // namespace layerloop::thermal
