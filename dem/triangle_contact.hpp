#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/triangle_surface.hpp"

namespace layerloop::dem {

/// Where a triangle is nearest to a point.
struct TrianglePoint {
  Vec3 point;
  unsigned corners;  ///< bits 0..2: corners that span the feature: one (vertex), two (edge) or three (face)
};

/// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
TrianglePoint nearest_on_triangle(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec3 const& p);

/// A triangle that a sphere overlaps.
struct TriangleContact {
  std::int32_t triangle;
  unsigned corners;     ///< as in TrianglePoint
  double distance;      ///< of the sphere's centre [m]; negative behind a face
  Vec3 normal;          ///< towards the sphere's centre
  bool hidden = false;  ///< set by merge_contacts while it works
};

/// Triangle `t` as seen from a sphere's centre `p`, whether they overlap or not.
TriangleContact contact_with(TriangleSurface const& surface, std::int32_t t, Vec3 const& p);

/// Keeps, of all triangles that a sphere overlaps, one per place where the distance to the surface has a minimum:
/// - the nearest point lies on an edge or corner: only if no triangle with that edge or corner is nearer still (else
/// the
///   surface goes on towards the sphere there), and only once among those that are as near;
/// - two places with nearly the same normal (within 18 degrees) count once, the nearer one: a smooth surface cut into
///   triangles pushes once, not once a triangle.
/// \param contacts  all triangles that overlap the sphere; reduced in place, nearest first
void merge_contacts(TriangleSurface const& surface, std::vector<TriangleContact>& contacts);

/// Triangles of a surface by the cells of a grid that their boxes touch.
class TriangleGrid {
 public:
  TriangleGrid() = default;
  TriangleGrid(TriangleSurface const& surface, double cell);

  /// All triangles whose cells touch the sphere, ascending and each once (a superset of those within its radius).
  void find(Vec3 const& centre, double radius, std::vector<std::int32_t>& triangles) const;

 private:
  std::array<std::int32_t, 3> cell_of(Vec3 const& p) const;
  template <class Visit>
  void for_cells(Vec3 const& low, Vec3 const& high, Visit&& visit) const;

  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
  double cell_ = 1;
  std::array<std::int32_t, 3> n_{0, 0, 0};
  std::vector<std::int32_t> begin_, triangles_;
};

}  // namespace layerloop::dem
