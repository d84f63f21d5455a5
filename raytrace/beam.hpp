#pragma once
#include <array>
#include <cstdint>

#include "core/vec3.hpp"

namespace layerloop::raytrace {

enum class BeamProfile {
  gaussian,  ///< I = 2P/(pi w^2) exp(-2 r^2/w^2), not truncated
  uniform    ///< constant over a rectangle: the whole tile of a periodic bed, for absorptivity studies
};

/// Light that falls straight down.
struct Beam {
  Vec3 centre = Vec3::Zero();  ///< a point of the axis [m]; its height does not matter
  double power = 0;            ///< incident [W]
  double radius = 0;           ///< gaussian: 1/e2 radius w [m]
  BeamProfile profile = BeamProfile::gaussian;
  double size_x = 0, size_y = 0;  ///< uniform: edges of the rectangle [m]
};

/// Where rays of equal power cross the plane across the beam [m]: point `index` of a two-dimensional low-discrepancy
/// sequence (R2: Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"), shifted modulo 1 by `shift`
/// (Cranley & Patterson, SIAM J. Numer. Anal. 13 (1976) 904), mapped by the inverse of the profile's distribution.
std::array<double, 2> ray_start(Beam const& beam, std::int64_t index, std::array<double, 2> const& shift);

}  // namespace layerloop::raytrace
