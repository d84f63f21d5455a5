#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/case.hpp"
#include "core/melt_record.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/solid_field.hpp"
#include "coupling/transfer.hpp"

namespace layerloop::coupling {

constexpr double um = 1e-6;

/// A pit of 200 x 100 um, plate 30 um below the platforms, cells of 5 um.
inline Case small_case() {
  Case checked;
  checked.powder.diameters = {13 * um, 42 * um};
  checked.machine.layer_thickness = 30 * um;
  checked.machine.accumulation_length = 100 * um;
  checked.machine.gap_length = 20 * um;
  checked.machine.deposition_length = 200 * um;
  checked.machine.width = 100 * um;
  checked.heat.cell_size = 5 * um;
  checked.heat.substrate_depth = 40 * um;
  checked.run.layers = 2;
  checked.material.density = 8190;
  return checked;
}

inline SolidField lowered_plate(Case const& checked) {
  SolidField solid = empty_solid(checked);
  lower(solid, checked.machine.layer_thickness);
  return solid;
}

/// Fills the field: fill(i, j, k) is the metal fraction of a cell.
inline void fill_field(SolidField& solid, double density, std::function<double(int, int, int)> const& fill) {
  for (std::int64_t cell = 0; cell < solid.grid.size(); ++cell) {
    auto const [i, j, k] = solid.grid.coordinates(cell);
    solid.mass[static_cast<std::size_t>(cell)] = density * solid.grid.cell_volume() * fill(i, j, k);
  }
}

/// A record in which exactly the cells melted for whose centre `melts` holds.
inline MeltRecord melt_where(VoxelGrid const& grid, std::function<bool(Vec3 const&)> const& melts,
                             double pool_width = 0) {
  MeltRecord melt;
  melt.grid = grid;
  for (std::int64_t cell = 0; cell < grid.size(); ++cell) {
    auto const [i, j, k] = grid.coordinates(cell);
    melt.melted.push_back(melts(grid.centre(i, j, k)));
  }
  melt.pool.width = pool_width;
  return melt;
}

/// Distance from a point to a triangle (Ericson, Real-Time Collision Detection, sect. 5.1.5, by projection on the plane
/// and edges).
inline double distance_to_triangle(Vec3 const& p, Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  Vec3 const n = (b - a).cross(c - a).normalized();
  Vec3 const q = p - n * n.dot(p - a);
  bool const inside =
      n.dot((b - a).cross(q - a)) >= 0 && n.dot((c - b).cross(q - b)) >= 0 && n.dot((a - c).cross(q - c)) >= 0;
  if (inside) return std::abs(n.dot(p - a));
  auto const to_edge = [&](Vec3 const& u, Vec3 const& v) {
    double const t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (p - u - t * (v - u)).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

/// Solid angle of the surface seen from p, over 4 pi: 1 inside, 0 outside (van Oosterom & Strackee 1983).
inline double winding_number(Vec3 const& p, TriangleSurface const& surface) {
  double angle = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Vec3 const a = surface.corner(t, 0) - p, b = surface.corner(t, 1) - p, c = surface.corner(t, 2) - p;
    double const la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * M_PI);
}

/// Gap between a grain and the surface [m], negative when they overlap; independent of the code under test.
inline double gap_to_surface(PowderBed const& bed, std::size_t g, TriangleSurface const& surface) {
  Vec3 const p = bed.position(g);
  double nearest = std::numeric_limits<double>::max();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    nearest =
        std::min(nearest, distance_to_triangle(p, surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2)));
  }
  return (winding_number(p, surface) > 0.5 ? -nearest : nearest) - bed.radius[g];
}

}  // namespace layerloop::coupling
