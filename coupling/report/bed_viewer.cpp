#include "coupling/report/bed_viewer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <vector>

#include "coupling/report/colour_map.hpp"
#include "coupling/report/html.hpp"

namespace layerloop::coupling {
namespace {

using Box = Eigen::AlignedBox3d;
static_assert(std::endian::native == std::endian::little, "the view's data is little-endian");

template <class T>
std::string base64_of(std::vector<T> const& values) {
  return base64({reinterpret_cast<char const*>(values.data()), values.size() * sizeof(T)});
}

std::uint16_t quantised(double share) {
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0)));
}

void append(std::vector<std::uint16_t>& to, Vec3 const& point, Box const& box) {
  for (int c = 0; c < 3; ++c) to.push_back(quantised((point[c] - box.min()[c]) / std::max(box.sizes()[c], 1e-12)));
}

/// Rows to show, ascending.
std::vector<std::size_t> shown_rows(PowderBed const& bed, double middle_x) {
  std::vector<std::size_t> rows(bed.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  if (rows.size() <= viewer_grain_limit) return rows;
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(bed.x[a] - middle_x) < std::abs(bed.x[b] - middle_x);
  });
  rows.resize(viewer_grain_limit);
  std::sort(rows.begin(), rows.end());
  return rows;
}

nlohmann::json numbers(Vec3 const& v) { return {1e6 * v.x(), 1e6 * v.y(), 1e6 * v.z()}; }

std::vector<std::uint8_t> colour_ramp() {
  std::vector<std::uint8_t> ramp;
  for (int i = 0; i < 256; ++i) {
    for (std::uint8_t c : colour(ColourMap::height, i / 255.0)) ramp.push_back(c);
    ramp.push_back(255);
  }
  return ramp;
}

}  // namespace

std::string viewer_data(PowderBed const& bed, TriangleSurface const& part, double plate_top) {
  bool const with_part = part.triangles.size() <= viewer_triangle_limit;
  Box metal;
  for (Vec3 const& v : part.vertices) metal.extend(v);
  std::vector<std::size_t> const rows = shown_rows(bed, metal.isEmpty() ? 0 : metal.center().x());
  Box box = metal;
  double smallest = rows.empty() ? 0 : bed.radius[rows[0]], largest = smallest;
  for (std::size_t row : rows) {
    box.extend(bed.position(row));
    smallest = std::min(smallest, bed.radius[row]);
    largest = std::max(largest, bed.radius[row]);
  }
  if (box.isEmpty()) box.extend(Vec3::Zero());

  std::vector<std::uint16_t> centres, radii, corners;
  for (std::size_t row : rows) {
    append(centres, bed.position(row), box);
    radii.push_back(quantised(bed.radius[row] / largest));
  }
  std::vector<std::uint32_t> triangles;
  if (with_part) {
    for (Vec3 const& v : part.vertices) append(corners, v, box);
    for (auto const& t : part.triangles)
      for (std::int32_t corner : t) triangles.push_back(static_cast<std::uint32_t>(corner));
  }
  nlohmann::json const data{{"grains", rows.size()},
                            {"all_grains", bed.size()},
                            {"triangles", triangles.size() / 3},
                            {"all_triangles", part.triangles.size()},
                            {"low", numbers(box.min())},
                            {"size", numbers(box.sizes())},
                            {"metal_low", numbers(metal.isEmpty() ? box.min() : metal.min())},
                            {"metal_high", numbers(metal.isEmpty() ? box.max() : metal.max())},
                            {"plate_top", 1e6 * plate_top},
                            {"smallest_radius", 1e6 * smallest},
                            {"largest_radius", 1e6 * largest},
                            {"centre", base64_of(centres)},
                            {"radius", base64_of(radii)},
                            {"corner", base64_of(corners)},
                            {"triangle", base64_of(triangles)},
                            {"ramp", base64_of(colour_ramp())}};
  return script_json(data);
}

}  // namespace layerloop::coupling
