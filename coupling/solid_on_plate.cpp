#include "coupling/solid_on_plate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/ply_file.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "dem/textured_plate.hpp"

namespace layerloop::coupling {
namespace {

constexpr int points_per_edge = 3;

/// Share of a cell whose sample points the surface encloses.
double enclosed_share(SurfaceDistance const& surface, Vec3 const& corner, double cell) {
  int inside = 0;
  for (int s = 0; s < points_per_edge * points_per_edge * points_per_edge; ++s) {
    Vec3 const at(s % points_per_edge, s / points_per_edge % points_per_edge, s / (points_per_edge * points_per_edge));
    inside += surface.encloses(corner + (at + Vec3::Constant(0.5)) * (cell / points_per_edge));
  }
  return static_cast<double>(inside) / (points_per_edge * points_per_edge * points_per_edge);
}

TriangleSurface read_substrate(Case const& checked) {
  TriangleSurface const surface = read_surface(checked.machine.substrate);
  check_substrate(surface);
  for (Vec3 const& v : surface.vertices) {
    if (v.x() >= checked.machine.deposition_begin() && v.x() <= checked.machine.deposition_end() && v.y() >= 0 &&
        v.y() <= checked.machine.width && v.z() <= 0.1)
      continue;
    throw InputError(fmt::format(
        "{} reaches ({:.4g}, {:.4g}, {:.4g}) m (outside the deposition zone, or not in metres) move or scale it",
        checked.machine.substrate, v.x(), v.y(), v.z()));
  }
  return surface;
}

}  // namespace

SolidField solid_on_plate(Case const& checked) {
  SolidField solid = empty_solid(checked);
  bool const textured = checked.machine.has_textured_plate();
  if (checked.machine.substrate.empty() && !textured) return solid;
  TriangleSurface const surface = textured ? dem::textured_plate(checked) : read_substrate(checked);
  double top = 0;
  for (Vec3 const& v : surface.vertices) top = std::max(top, v.z());
  double const cell = solid.grid.cell;
  auto const levels = static_cast<std::int32_t>(std::ceil(top / cell));
  grow(solid, levels + 2);
  SurfaceDistance const distance(surface);
  double const full = checked.material.density * solid.grid.cell_volume();
  Vec3 const origin(solid.grid.origin.x(), solid.grid.origin.y(), 0);
  for (std::int32_t k = 0; k < levels; ++k) {
    for (std::int32_t j = 0; j < solid.grid.n[1]; ++j) {
      for (std::int32_t i = 0; i < solid.grid.n[0]; ++i) {
        solid.mass[static_cast<std::size_t>(solid.grid.index(i, j, k))] =
            full * enclosed_share(distance, origin + cell * Vec3(i, j, k), cell);
      }
    }
  }
  return solid;
}

}  // namespace layerloop::coupling
