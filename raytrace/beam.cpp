#include "raytrace/beam.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "raytrace/radial_profile.hpp"

namespace layerloop::raytrace {
namespace {

/// Powers of 1/g with g^3 = g + 1 (the plastic number).
constexpr double step_u = 0.7548776662466927, step_v = 0.5698402909980532;

double fraction(double value) { return value - std::floor(value); }

/// Axes of the cross-section and direction of travel: those of light straight down, turned about a level line.
struct BeamFrame {
  explicit BeamFrame(Beam const& beam) : level(-std::sin(beam.incidence_azimuth), std::cos(beam.incidence_azimuth), 0) {
    if (beam.incidence_angle == 0) return;
    for (Vec3* axis : {&across_x, &across_y, &travel}) *axis = turned(*axis, beam.incidence_angle);
  }

  /// Rodrigues' formula, about -level: a tilt sends the light towards the azimuth.
  Vec3 turned(Vec3 const& v, double angle) const {
    return std::cos(angle) * v - std::sin(angle) * level.cross(v) + (1 - std::cos(angle)) * level.dot(v) * level;
  }

  Vec3 level;  ///< across the plane of incidence
  Vec3 across_x = Vec3::UnitX(), across_y = Vec3::UnitY(), travel = -Vec3::UnitZ();
};

double radius_of(Beam const& beam, double u) {
  switch (beam.profile) {
    case BeamProfile::top_hat:
      return beam.radius * std::sqrt(u);
    case BeamProfile::tabulated:
      return beam.table->radius_holding(u);
    default:
      return beam.radius * std::sqrt(-0.5 * std::log1p(-u));
  }
}

}  // namespace

Defocus defocus(double distance, double rayleigh_length) {
  double const ratio = distance / rayleigh_length;
  return {std::sqrt(1 + ratio * ratio), ratio / (rayleigh_length * (1 + ratio * ratio))};
}

Ray beam_ray(Beam const& beam, double height, std::int64_t index, std::array<double, 2> const& shift) {
  double const u = fraction(shift[0] + step_u * static_cast<double>(index));
  double const v = fraction(shift[1] + step_v * static_cast<double>(index));
  BeamFrame const frame(beam);
  Vec3 point = beam.centre, direction = frame.travel;
  if (beam.profile == BeamProfile::uniform) {
    point.x() += beam.size_x * (u - 0.5);
    point.y() += beam.size_y * (v - 0.5);
  } else {
    double const r = radius_of(beam, u), angle = 2 * std::numbers::pi * v, stretch = std::sqrt(beam.ellipticity);
    Vec3 const aside = r * std::cos(angle) / stretch * frame.across_x + r * std::sin(angle) * stretch * frame.across_y;
    point += aside;
    if (beam.front_curvature != 0) direction = (direction + beam.front_curvature * aside).normalized();
  }
  Vec3 origin = point + (height - point.z()) / direction.z() * direction;
  origin.z() = height;
  return {origin, direction};
}

std::array<Eigen::Vector3cd, 2> ray_fields(Beam const& beam, Vec3 const& direction) {
  BeamFrame const frame(beam);
  // Rays that lean against the axis carry the field of the axis without its part along them.
  auto const across = [&](Vec3 const& v) { return Vec3((v - v.dot(direction) * direction).normalized()); };
  Vec3 const x = across(frame.across_x), y = x.cross(direction);
  auto const complex = [](Vec3 const& v) { return Eigen::Vector3cd(v.cast<std::complex<double>>()); };
  switch (beam.polarisation) {
    case BeamPolarisation::unpolarised:
      return {std::sqrt(0.5) * complex(x), std::sqrt(0.5) * complex(y)};
    case BeamPolarisation::s:
      return {complex(across(frame.level)), Eigen::Vector3cd::Zero()};
    case BeamPolarisation::p:
      return {complex(across(frame.level.cross(frame.travel))), Eigen::Vector3cd::Zero()};
    case BeamPolarisation::x:
      return {complex(x), Eigen::Vector3cd::Zero()};
    case BeamPolarisation::y:
      return {complex(across(frame.across_y)), Eigen::Vector3cd::Zero()};
    case BeamPolarisation::circular:
      return {std::sqrt(0.5) * (complex(x) + std::complex<double>(0, 1) * complex(y)), Eigen::Vector3cd::Zero()};
  }
  return {};
}

void check_beam(Beam const& beam) {
  bool const sized = beam.profile == BeamProfile::uniform     ? beam.size_x > 0 && beam.size_y > 0
                     : beam.profile == BeamProfile::tabulated ? beam.table != nullptr
                                                              : beam.radius > 0;
  if (!(beam.power > 0 && sized && beam.ellipticity > 0 && beam.centre.allFinite() &&
        std::isfinite(beam.front_curvature))) {
    throw InputError(fmt::format(
        "a beam of {:g} W and radius {:g} m at x = {:g} m, y = {:g} m cannot be traced (power and size must be "
        "positive): check [laser] and [scan]",
        beam.power, beam.radius, beam.centre.x(), beam.centre.y()));
  }
  if (!(std::abs(beam.incidence_angle) < 0.5 * std::numbers::pi && std::isfinite(beam.incidence_azimuth)))
    throw InputError(
        fmt::format("a beam at {:g} rad from straight down never reaches the bed: check "
                    "laser.incidence_angle",
                    beam.incidence_angle));
}

}  // namespace layerloop::raytrace
