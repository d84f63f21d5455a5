#pragma once
#include <cstdint>

#include "core/vec3.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::raytrace {

enum class Projection { orthographic, perspective };

/// Where a picture is taken from. right, up and forward are unit vectors at right angles.
struct Camera {
  Projection projection = Projection::orthographic;
  Vec3 eye, right, up, forward;
  double half_width, half_height;  ///< orthographic: of the picture [m]; perspective: tangent of half the opening angle

  /// Ray through a point of the picture; u and v run from -1 to 1, to the right and up.
  Ray ray(double u, double v) const;
};

/// Direction from the middle of the scene to the camera [degrees]: azimuth -90 looks along +y with x to the right,
/// elevation 90 straight down.
struct ViewDirection {
  double azimuth;
  double elevation;
};
inline constexpr ViewDirection oblique{-62, 34};
inline constexpr ViewDirection from_above{-90, 90};

/// Camera that sees the whole box, as large as it fits with a small margin.
/// \param aspect  width / height of the picture
Camera fit_camera(Vec3 const& lower, Vec3 const& upper, ViewDirection direction, double aspect,
                  Projection projection = Projection::orthographic);

}  // namespace layerloop::raytrace
