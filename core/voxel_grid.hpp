#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "core/vec3.hpp"

namespace layerloop {

/// A regular grid of cubic cells; cell (i, j, k) spans origin + cell * [i, i+1] x [j, j+1] x [k, k+1]. x runs fastest.
struct VoxelGrid {
  Vec3 origin = Vec3::Zero();  ///< lower corner [m]
  double cell = 0;             ///< edge of a cell [m]
  std::array<std::int32_t, 3> n{0, 0, 0};

  std::int64_t size() const { return std::int64_t{n[0]} * n[1] * n[2]; }
  double cell_volume() const { return cell * cell * cell; }
  std::int64_t index(std::int64_t i, std::int64_t j, std::int64_t k) const { return i + n[0] * (j + n[1] * k); }
  std::array<std::int32_t, 3> coordinates(std::int64_t index) const {
    return {static_cast<std::int32_t>(index % n[0]), static_cast<std::int32_t>(index / n[0] % n[1]),
            static_cast<std::int32_t>(index / (std::int64_t{n[0]} * n[1]))};
  }
  Vec3 centre(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return origin +
           cell * Vec3(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5, static_cast<double>(k) + 0.5);
  }
  Vec3 upper() const { return origin + cell * Vec3(n[0], n[1], n[2]); }
  /// Cell that holds the point; may lie outside the grid (see contains).
  std::array<std::int64_t, 3> locate(Vec3 const& p) const {
    return {static_cast<std::int64_t>(std::floor((p.x() - origin.x()) / cell)),
            static_cast<std::int64_t>(std::floor((p.y() - origin.y()) / cell)),
            static_cast<std::int64_t>(std::floor((p.z() - origin.z()) / cell))};
  }
  bool contains(std::array<std::int64_t, 3> const& c) const {
    return c[0] >= 0 && c[0] < n[0] && c[1] >= 0 && c[1] < n[1] && c[2] >= 0 && c[2] < n[2];
  }
};

}  // namespace layerloop
