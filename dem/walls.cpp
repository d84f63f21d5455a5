#include "dem/walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace layerloop::dem {
namespace {
WallMotion const at_rest;

/// A point seen from the centre of a corner: both coordinates positive.
struct CornerPoint {
  double distance, nx, nz;
};

/// Distance from the convex curve |x/e|^n + |z/e|^n = 1: the largest over all directions u of p.u - h(u), where the
/// support function h is e times the dual norm, of exponent m = n/(n - 1). Bisection on the direction, whose error
/// enters squared.
CornerPoint nearest_on_super_ellipse(double e, double n, double x, double z) {
  double const m = n / (n - 1);
  auto const height = [&](double angle) {
    double const c = std::cos(angle), s = std::sin(angle);
    return x * c + z * s - e * std::pow(std::pow(c, m) + std::pow(s, m), 1 / m);
  };
  auto const slope = [&](double angle) {
    double const c = std::cos(angle), s = std::sin(angle);
    double const norm = std::pow(std::pow(c, m) + std::pow(s, m), 1 / m - 1);
    return -x * s + z * c - e * norm * (std::pow(s, m - 1) * c - std::pow(c, m - 1) * s);
  };
  double low = 0, high = std::numbers::pi / 2;
  for (int halving = 0; halving < 24; ++halving) {
    double const middle = 0.5 * (low + high);
    (slope(middle) > 0 ? low : high) = middle;
  }
  double const angle = 0.5 * (low + high);
  return {height(angle), std::cos(angle), std::sin(angle)};
}

/// A rectangle with rounded corners.
WallPoint nearest_in_section(double x0, double x1, double z0, double z1, double e, double exponent, double x,
                             double z) {
  x0 += e;
  x1 -= e;
  z0 += e;
  z1 -= e;
  double const dx = x - std::clamp(x, x0, x1), dz = z - std::clamp(z, z0, z1);
  if (dx != 0 && dz != 0 && exponent != 2) {
    CornerPoint const corner = nearest_on_super_ellipse(e, exponent, std::abs(dx), std::abs(dz));
    return {corner.distance, std::copysign(corner.nx, dx), 0, std::copysign(corner.nz, dz)};
  }
  double const d = std::sqrt(dx * dx + dz * dz);
  if (d > 0) return {d - e, dx / d, 0, dz / d};
  double const left = x - x0, right = x1 - x, down = z - z0, up = z1 - z;
  double const least = std::min({left, right, down, up});
  if (least == up) return {-least - e, 0, 0, 1};
  if (least == left) return {-least - e, -1, 0, 0};
  if (least == right) return {-least - e, 1, 0, 0};
  return {-least - e, 0, 0, -1};
}

WallPoint nearest(Roller const& roller, double x, double z) {
  double const dx = x - roller.x, dz = z - roller.z, d = std::sqrt(dx * dx + dz * dz);
  if (d > 0) return {d - roller.radius, dx / d, 0, dz / d};
  return {-roller.radius, 0, 0, 1};
}

/// The section through the axis, turned towards the point.
WallPoint nearest(RoundTable const& table, double width, Vec3 const& p) {
  double const dx = p.x() - table.x, dy = std::remainder(p.y() - table.y, width), out = std::sqrt(dx * dx + dy * dy);
  WallPoint const flat = nearest_in_section(-table.radius, table.radius, table.z_top - table.thickness, table.z_top,
                                            table.edge_radius, 2, out, p.z());
  if (!(out > 0)) return {flat.distance, 0, 0, flat.nz};
  return {flat.distance, flat.nx * dx / out, flat.nx * dy / out, flat.nz};
}
}  // namespace

std::string const& Walls::name(std::size_t wall) const {
  static std::string const substrate_name = "the substrate";
  if (wall < blocks.size()) return blocks[wall].name;
  wall -= blocks.size();
  if (wall < rollers.size()) return rollers[wall].name;
  wall -= rollers.size();
  if (wall < tables.size()) return tables[wall].name;
  wall -= tables.size();
  return wall == 0 ? substrate_name : meshes[wall - 1].name;
}

WallMotion const& Walls::motion(std::size_t wall) const {
  if (wall < blocks.size()) return blocks[wall].motion;
  wall -= blocks.size();
  if (wall < rollers.size()) return rollers[wall].motion;
  wall -= rollers.size();
  return wall <= tables.size() ? at_rest : meshes[wall - tables.size() - 1].motion;
}

std::optional<double> Walls::friction(std::size_t wall) const {
  if (wall < blocks.size()) return blocks[wall].friction;
  wall -= blocks.size();
  if (wall < rollers.size()) return rollers[wall].friction;
  wall -= rollers.size();
  return wall <= tables.size() ? std::nullopt : meshes[wall - tables.size() - 1].friction;
}

TriangleSurface const& Walls::surface(std::size_t wall) const {
  return wall == primitives() ? substrate : meshes[wall - primitives() - 1].surface;
}

WallPoint nearest(RoundedBlock const& block, double x, double z) {
  return nearest_in_section(block.x0, block.x1, block.z0, block.z1, block.edge_radius, block.edge_exponent, x, z);
}

WallPoint nearest(Walls const& walls, std::size_t wall, double width, Vec3 const& p) {
  if (wall < walls.blocks.size()) return nearest(walls.blocks[wall], p.x(), p.z());
  wall -= walls.blocks.size();
  if (wall < walls.rollers.size()) return nearest(walls.rollers[wall], p.x(), p.z());
  return nearest(walls.tables[wall - walls.rollers.size()], width, p);
}

std::int64_t key_of(Walls const& walls, std::size_t wall) {
  auto const as_key = [](std::size_t place) { return static_cast<std::int64_t>(place); };
  if (wall < walls.blocks.size()) return as_key(wall);
  wall -= walls.blocks.size();
  if (wall < walls.rollers.size()) return first_roller_key + as_key(wall);
  wall -= walls.rollers.size();
  if (wall < walls.tables.size()) return first_table_key + as_key(wall);
  return first_triangle_key + keys_a_mesh * as_key(wall - walls.tables.size());
}

}  // namespace layerloop::dem
