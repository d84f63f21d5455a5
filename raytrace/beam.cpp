#include "raytrace/beam.hpp"

#include <cmath>
#include <numbers>

namespace layerloop::raytrace {
namespace {

/// Powers of 1/g with g^3 = g + 1 (the plastic number).
constexpr double step_u = 0.7548776662466927, step_v = 0.5698402909980532;

double fraction(double value) { return value - std::floor(value); }

}  // namespace

std::array<double, 2> ray_start(Beam const& beam, std::int64_t index, std::array<double, 2> const& shift) {
  double const u = fraction(shift[0] + step_u * static_cast<double>(index));
  double const v = fraction(shift[1] + step_v * static_cast<double>(index));
  if (beam.profile == BeamProfile::uniform)
    return {beam.centre.x() + beam.size_x * (u - 0.5), beam.centre.y() + beam.size_y * (v - 0.5)};

  double const r = beam.radius * std::sqrt(-0.5 * std::log1p(-u));
  double const angle = 2 * std::numbers::pi * v;
  return {beam.centre.x() + r * std::cos(angle), beam.centre.y() + r * std::sin(angle)};
}

}  // namespace layerloop::raytrace
