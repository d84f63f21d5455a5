#include "raytrace/camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace layerloop::raytrace {
namespace {

constexpr double margin = 1.04;
constexpr double lens = 0.22;  // tangent of half the vertical opening angle: a portrait lens

std::array<Vec3, 8> corners(Vec3 const& lower, Vec3 const& upper) {
  std::array<Vec3, 8> all;
  for (std::size_t c = 0; c < 8; ++c) {
    all[c] = {c & 1 ? upper.x() : lower.x(), c & 2 ? upper.y() : lower.y(), c & 4 ? upper.z() : lower.z()};
  }
  return all;
}

/// Extent of the corners across the view, as seen from the eye.
struct Extent {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;
};
Extent extent(Camera const& camera, std::array<Vec3, 8> const& points) {
  Extent e;
  for (Vec3 const& p : points) {
    double const depth = camera.projection == Projection::perspective ? (p - camera.eye).dot(camera.forward) : 1.0;
    double const x = (p - camera.eye).dot(camera.right) / depth, y = (p - camera.eye).dot(camera.up) / depth;
    e = {std::min(e.left, x), std::max(e.right, x), std::min(e.bottom, y), std::max(e.top, y)};
  }
  return e;
}

}  // namespace

Ray Camera::ray(double u, double v) const {
  Vec3 const across = u * half_width * right + v * half_height * up;
  if (projection == Projection::orthographic) return {eye + across, forward};
  return {eye, (forward + across).normalized()};
}

Camera fit_camera(Vec3 const& lower, Vec3 const& upper, ViewDirection direction, double aspect, Projection projection) {
  double const radian = std::numbers::pi / 180;
  double const azimuth = direction.azimuth * radian, elevation = direction.elevation * radian;
  Camera camera;
  camera.projection = projection;
  camera.forward =
      -Vec3(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  camera.right = {-std::sin(azimuth), std::cos(azimuth), 0};
  camera.up = camera.right.cross(camera.forward);
  double const diagonal = (upper - lower).norm();
  camera.eye = 0.5 * (lower + upper) - 4 * diagonal * camera.forward;

  std::array<Vec3, 8> const points = corners(lower, upper);
  // In perspective, moving the eye changes the outline a little: a few rounds settle it.
  for (int round = 0; round < 20; ++round) {
    Extent const e = extent(camera, points);
    bool const near = projection == Projection::perspective;
    double const distance = near ? (0.5 * (lower + upper) - camera.eye).dot(camera.forward) : 1.0;
    camera.eye += 0.5 * distance * ((e.left + e.right) * camera.right + (e.bottom + e.top) * camera.up);
    camera.half_height = margin * std::max(0.5 * (e.top - e.bottom), 0.5 * (e.right - e.left) / aspect);
    if (near) camera.eye += distance * (1 - camera.half_height / lens) * camera.forward;
  }
  camera.half_width = aspect * camera.half_height;
  return camera;
}

}  // namespace layerloop::raytrace
