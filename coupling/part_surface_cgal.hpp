#pragma once
#include <memory>

#include "core/case.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// Outer surface of plate and part: closed, oriented, manifold, free of self-intersection. The plate is a slab of
/// heat.substrate_depth. The mesh goes on beyond the deposition zone by six cells into the pit's walls (plate only)
/// and, as the periodic continuation of the part, by more than the largest grain radius beyond y = 0 and y = width:
/// whoever uses it needs no periodic copies. Meshed by restricted Delaunay refinement (CGAL Mesh_3; Boissonnat & Oudot,
/// Graphical Models 67 (2005) 405): triangles lie within a tenth of a cell of the level surface (surface_level.hpp),
/// exactly on the plate, and are large where it is flat. The same bits for the same field wherever it lies. \throws
/// PhysicsError no valid mesh, neither so nor by alpha wrapping
TriangleSurface mesh_solid(SolidField const& solid, Case const& checked);

/// What the mesh should enclose [m^3]: slab, metal and ignored voids, the periodic continuation of the part included.
double volume_to_mesh(SolidField const& solid, Case const& checked);

/// Refuses a substrate that a user brings: \throws InputError it has a hole or edge that is not manifold, is
/// inside-out, or intersects itself; says where.
void check_substrate(TriangleSurface const& surface);

/// Distance queries against a closed surface.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(TriangleSurface const& surface);
  ~SurfaceDistance();
  SurfaceDistance(SurfaceDistance const&) = delete;
  SurfaceDistance& operator=(SurfaceDistance const&) = delete;

  Vec3 closest_point(Vec3 const& p) const;
  bool encloses(Vec3 const& p) const;  ///< inside or on the surface

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace layerloop::coupling
