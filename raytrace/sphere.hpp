#pragma once
#include <cmath>
#include <limits>

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
