#pragma once
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/vec3.hpp"

namespace layerloop::raytrace {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Coordinates about the middle of the scene [m].
struct alignas(32) Sphere {
  double x, y, z, radius;
};

/// Unit direction and origin of a ray in the coordinates of the spheres.
struct LocalRay {
  double ox, oy, oz, dx, dy, dz;
};

/// The surface that a ray meets first, in the same coordinates.
struct LocalHit {
  double distance = infinity;               ///< along the ray [m]
  std::int32_t sphere = -1, triangle = -1;  ///< at most one of them is there
  bool undecided = false;                   ///< crossed the tile too often
  Vec3 point = Vec3::Zero();                ///< seen from the tile in which it lies
  Vec3 normal = Vec3::Zero();               ///< outward, unit length
};

/// A vector of unit length up to rounding, made so to the last digit: one step of Newton's in place of a root and a
/// quotient, which the next flight would have to wait for.
inline Vec3 unit(Vec3 const& almost) { return (1.5 - 0.5 * almost.squaredNorm()) * almost; }

inline double root(double value) { return std::sqrt(value); }

/// Distance at which a ray enters a sphere from outside; infinity when it does not, also for the sphere that it has
/// just left. `Number` is double, or a vector of doubles for several spheres at once (with `root` to match).
/// \param cx, cy, cz  from the origin of the ray to the centre
template <class Number>
inline Number entry_distance(Number const& cx, Number const& cy, Number const& cz, Number const& radius,
                             LocalRay const& ray) {
  Number const ahead = cx * ray.dx + cy * ray.dy + cz * ray.dz;
  // The distance of the centre from the ray by its components, not as |c|^2 - ahead^2, which cancels.
  Number const px = cx - ahead * ray.dx, py = cy - ahead * ray.dy, pz = cz - ahead * ray.dz;
  Number const inside = radius * radius - (px * px + py * py + pz * pz);
  Number const distance = ahead - root(inside);  // not a number where the ray passes by: no comparison holds
  return (ahead > 0.0) & (distance >= 0.0) ? distance : infinity + Number{};
}

}  // namespace layerloop::raytrace
