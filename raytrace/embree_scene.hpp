#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/triangle_surface.hpp"
#include "core/vec3.hpp"
#include "raytrace/sphere.hpp"

struct RTCSceneTy;  // Embree's own types: its header stays in the source
struct RTCDeviceTy;

namespace layerloop::raytrace {

/// Spheres and triangles in Embree's hierarchy. It finds candidates in single precision, in coordinates about the
/// middle of the scene; spheres are then intersected in double precision inside the traversal, triangles once their
/// plane is known. Both are seen from outside only. Queries are const and safe from many threads.
class EmbreeScene {
 public:
  /// \param spheres    not copied: they must outlive the scene
  /// \param triangles  in machine coordinates
  /// \param middle     of the scene, in machine coordinates
  EmbreeScene(std::span<Sphere const> spheres, TriangleSurface const& triangles, Vec3 const& middle);

  LocalHit first_hit(LocalRay const& ray, double limit) const;
  bool is_blocked(LocalRay const& ray, double limit) const;

 private:
  struct Release {
    void operator()(RTCSceneTy* scene) const;
  };
  void attach_spheres(RTCDeviceTy* device);
  void attach_triangles(RTCDeviceTy* device, TriangleSurface const& triangles, Vec3 const& middle);

  std::span<Sphere const> spheres_;
  std::vector<Vec3> normals_, corners_;  ///< of each triangle; one corner of it, about the middle
  std::unique_ptr<RTCSceneTy, Release> scene_;
  unsigned sphere_geometry_;
};

}  // namespace layerloop::raytrace
