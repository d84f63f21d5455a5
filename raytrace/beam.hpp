#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <memory>

#include "core/vec3.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::raytrace {

class RadialProfile;

enum class BeamProfile {
  gaussian,   ///< I = 2P/(pi w^2) exp(-2 r^2/w^2), not truncated
  uniform,    ///< constant over a level rectangle: the whole tile of a periodic bed, for absorptivity studies
  top_hat,    ///< constant inside the radius
  tabulated,  ///< `table` over the radius: a ring, or what a camera saw
};

enum class BeamPolarisation { unpolarised, s, p, x, y, circular };

/// Light that falls on a point of the bed. Its cross-section has the axes x and y of the machine when it falls straight
/// down; an oblique beam is that one, turned about a level line through `centre`.
struct Beam {
  Vec3 centre = Vec3::Zero();  ///< where the axis meets the bed [m]; of light straight down, the height does not matter
  double power = 0;            ///< incident [W]
  double radius = 0;           ///< gaussian: 1/e2 radius w; top_hat: its edge; at the bed, before the tilt [m]
  BeamProfile profile = BeamProfile::gaussian;
  double size_x = 0, size_y = 0;                    ///< uniform: edges of the rectangle on the bed [m]
  std::shared_ptr<RadialProfile const> table = {};  ///< tabulated
  double ellipticity = 1;                           ///< extent along y over extent along x, at the same area
  double incidence_angle = 0;                       ///< between the axis and straight down [rad]
  double incidence_azimuth = 0;                     ///< direction of travel seen from above, from x towards y [rad]
  double front_curvature = 0;                       ///< 1/R of the phase front at the bed, > 0 diverges [1/m]
  BeamPolarisation polarisation = BeamPolarisation::unpolarised;
};

/// A Gaussian beam beyond its focus: radius over that of the focus, and 1/R of the phase front.
/// Source: Siegman, Lasers (1986), 17.1; embedded-Gaussian beams of any M2 follow it with their own Rayleigh length.
/// \param distance  from the focus along the beam [m]; < 0: before it
struct Defocus {
  double widening, front_curvature;
};
Defocus defocus(double distance, double rayleigh_length);

/// One of many rays of equal power, at `height` [m] on its way down. The point where it crosses the plane through the
/// centre is point `index` of a two-dimensional low-discrepancy sequence (R2: Roberts 2018, "The unreasonable
/// effectiveness of quasirandom sequences"), shifted modulo 1 by `shift` (Cranley & Patterson, SIAM J. Numer. Anal. 13
/// (1976) 904), mapped by the inverse of the profile's distribution; its direction is normal to the phase front, so
/// that the two numbers fix it.
Ray beam_ray(Beam const& beam, double height, std::int64_t index, std::array<double, 2> const& shift);

/// Field of a ray of unit power: two incoherent parts. Unpolarised light has half of its power in each of two
/// directions across the ray, polarised light all of it in the first.
std::array<Eigen::Vector3cd, 2> ray_fields(Beam const& beam, Vec3 const& direction);

/// \throws InputError  power, size, shape or direction with which no ray can start
void check_beam(Beam const& beam);

}  // namespace layerloop::raytrace
