#include "dem/heap_angle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/layer_metrics.hpp"

namespace layerloop::dem {
namespace {
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double wanted_pixel = 5e-6;  // [m]
constexpr std::int32_t pixels_a_slice = 5;
constexpr std::size_t slices_with_crest = 12, points_on_line = 5;
constexpr double toe_share = 0.12;  // of the crest's height

struct SurfacePoint {
  double x, z;
};

constexpr double bare = -1;  // height where there is no grain: deeper than any machine [m]

/// Free surface ahead of the blade, slice by slice.
std::vector<SurfacePoint> profile(PowderBed const& bed, MachineSettings const& machine, double blade_front) {
  AreaMap map{blade_front, 0, 0, 0, 0, {}};
  map.ny = std::max(1, static_cast<std::int32_t>(std::lround(machine.width / wanted_pixel)));
  map.spacing = machine.width / map.ny;
  double const slice = pixels_a_slice * map.spacing;
  map.nx = pixels_a_slice * static_cast<std::int32_t>(std::max(0.0, (machine.deposition_end() - blade_front) / slice));
  map.values.assign(static_cast<std::size_t>(map.nx) * static_cast<std::size_t>(map.ny), bare);
  map = height_map(bed, map);

  std::vector<SurfacePoint> points;
  for (std::int32_t first = 0; first < map.nx; first += pixels_a_slice) {
    double sum = 0;
    int covered = 0;
    for (std::int32_t i = first; i < first + pixels_a_slice; ++i) {
      for (std::int32_t j = 0; j < map.ny; ++j) {
        if (map.at(i, j) == bare) continue;
        sum += map.at(i, j);
        ++covered;
      }
    }
    points.push_back({blade_front + (first + 0.5 * pixels_a_slice) * map.spacing, covered > 0 ? sum / covered : bare});
  }
  return points;
}

double slope(std::vector<SurfacePoint> const& points) {
  double const n = static_cast<double>(points.size());
  double x = 0, z = 0, xx = 0, xz = 0;
  for (SurfacePoint const& p : points) {
    x += p.x / n;
    z += p.z / n;
  }
  for (SurfacePoint const& p : points) {
    xx += (p.x - x) * (p.x - x);
    xz += (p.x - x) * (p.z - z);
  }
  return xz / xx;
}
}  // namespace

double heap_angle(PowderBed const& bed, MachineSettings const& machine, double blade_front, double ground) {
  std::vector<SurfacePoint> const surface = profile(bed, machine, blade_front);
  if (surface.size() < points_on_line) return nothing;
  auto const crest = std::ranges::max_element(
      surface.begin(), surface.begin() + static_cast<std::ptrdiff_t>(std::min(slices_with_crest, surface.size())), {},
      &SurfacePoint::z);
  double const toe_height = toe_share * crest->z + std::max(0.0, ground);
  auto const toe = std::find_if(crest, surface.end(), [&](SurfacePoint const& p) { return !(p.z > toe_height); });
  if (toe - crest < static_cast<std::ptrdiff_t>(points_on_line)) return nothing;
  std::vector<SurfacePoint> line;
  for (std::size_t k = 0; k < points_on_line; ++k) {
    double const step = static_cast<double>(toe - crest - 1) / (points_on_line - 1);
    line.push_back(crest[std::lround(static_cast<double>(k) * step)]);
  }
  return std::atan(-slope(line)) * 180 / std::numbers::pi;
}

void HeapWatch::operator()(PowderBed const& bed, double blade_front) {
  double const zone = machine_.accumulation_length, along = blade_front - machine_.deposition_begin();
  bool const accumulates = blade_front > 0.4 * zone && blade_front < 0.96 * zone;
  bool const deposits = along > 0.1 * machine_.deposition_length && along < 0.7 * machine_.deposition_length;
  if (!accumulates && !deposits) return;
  double const angle = heap_angle(bed, machine_, blade_front, accumulates ? settled_surface_ : 0.0);
  if (std::isfinite(angle)) (accumulates ? accumulation_ : deposition_).push_back(angle);
}

HeapWatch::Angle HeapWatch::mean_of(std::vector<double> const& angles) {
  double const n = static_cast<double>(angles.size());
  if (angles.empty()) return {nothing, nothing};
  double mean = 0, square = 0;
  for (double const a : angles) mean += a / n;
  for (double const a : angles) square += (a - mean) * (a - mean);
  return {mean, angles.size() > 1 ? std::sqrt(square / (n - 1) / n) : nothing};
}

}  // namespace layerloop::dem
