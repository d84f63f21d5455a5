#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/triangle_surface.hpp"

namespace layerloop::dem {

/// A bar with rounded edges: a rectangle in x-z with quarter circles at its corners, endless along y. Planes and
/// cylinders in one primitive: a grain has at most one contact with it, and none of the steps that a row of triangles
/// would have.
struct RoundedBlock {
  std::string name;
  double x0 = 0, x1 = 0, z0 = 0, z1 = 0;  ///< [m] at time 0
  double edge_radius = 0;                 ///< [m], at most half of either side
  double velocity = 0;                    ///< along x [m/s]
};

/// Distance of a point from a wall [m], negative inside, and the unit normal that points away from the wall.
struct WallPoint {
  double distance, nx, nz;
};

inline WallPoint nearest(RoundedBlock const& block, double shift, double x, double z) {
  double const e = block.edge_radius;
  double const x0 = block.x0 + shift + e, x1 = block.x1 + shift - e, z0 = block.z0 + e, z1 = block.z1 - e;
  double const dx = x - std::clamp(x, x0, x1), dz = z - std::clamp(z, z0, z1);
  double const d = std::sqrt(dx * dx + dz * dz);
  if (d > 0) return {d - e, dx / d, dz / d};
  double const left = x - x0, right = x1 - x, down = z - z0, up = z1 - z;
  double const least = std::min({left, right, down, up});
  if (least == up) return {-least - e, 0, 1};
  if (least == left) return {-least - e, -1, 0};
  if (least == right) return {-least - e, 1, 0};
  return {-least - e, 0, -1};
}

/// Everything that holds grains. Springs of walls carry the key -1 - wall key: blocks by their place in the list,
/// triangle t of the substrate first_triangle_key + t.
struct Walls {
  std::vector<RoundedBlock> blocks;
  TriangleSurface substrate;  ///< closed, reaching beyond the periodic width; may be empty
};

inline constexpr std::int64_t first_triangle_key = 1000;
constexpr std::int64_t wall_key_of(std::int64_t key_b) { return -1 - key_b; }

}  // namespace layerloop::dem
