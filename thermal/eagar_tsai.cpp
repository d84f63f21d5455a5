#include "thermal/eagar_tsai.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "thermal/enthalpy_table.hpp"

namespace layerloop::thermal {
namespace {

/// Where a falling function passes a level, between `from`, where it is above, and beyond.
double falls_below(std::function<double(double)> const& f, double level, double from, double step, double tolerance) {
  double low = from, high = from + step;
  while (f(high) > level) low = high, step *= 2, high += step;
  auto const close = [&](double a, double b) { return std::abs(a - b) < tolerance; };
  auto const [a, b] = boost::math::tools::bisect([&](double s) { return f(s) - level; }, low, high, close);
  return 0.5 * (a + b);
}

/// Largest value of a function with one maximum.
double largest(std::function<double(double)> const& f, double low, double high) {
  std::uintmax_t iterations = 60;
  auto const found = boost::math::tools::brent_find_minima([&](double x) { return -f(x); }, low, high, 20, iterations);
  return -found.second;
}

}  // namespace

ConstantMetal constant_metal_of(Material const& material, double ambient_temperature) {
  EnthalpyTable const table(material, ambient_temperature, material.boiling_point);
  return {.conductivity = material.conductivity(material.solidus),
          .heat_capacity = table.liquidus() / (material.liquidus - ambient_temperature),
          .melting_point = material.liquidus};
}

double eagar_tsai_temperature(MovingBeam const& beam, ConstantMetal const& metal, Vec3 const& place) {
  double const a = metal.conductivity / metal.heat_capacity, variance = 0.25 * beam.spot_radius * beam.spot_radius;
  // In u = sqrt(t) the integrand has no singularity; after `last` the beam is too far away to be felt.
  auto const integrand = [&](double u) {
    double const t = u * u, x = place.x() + beam.speed * t;
    double const level = (x * x + place.y() * place.y()) / (4 * a * t + 2 * variance);
    double const down = place.z() == 0 ? 0 : place.z() * place.z() / (4 * a * t);
    return 2 / (2 * a * t + variance) * std::exp(-level - down);
  };
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  double const start = std::sqrt(variance / (2 * a));  // the time in which heat spreads as wide as the beam
  double sum = 0, from = 0, to = start;
  for (int doubling = 0; doubling < 60; ++doubling) {
    double const part = Rule::integrate(integrand, from, to, 3, 1e-8);
    sum += part;
    if (doubling > 8 && part < 1e-7 * sum) break;
    from = to, to *= 1.5;
  }
  double const pi = std::numbers::pi;
  return beam.ambient_temperature + beam.absorbed_power / (metal.heat_capacity * std::sqrt(4 * pi * pi * pi * a)) * sum;
}

PoolSize eagar_tsai_pool(MovingBeam const& beam, ConstantMetal const& metal) {
  double const w = beam.spot_radius, tolerance = 1e-5 * w;
  auto const at = [&](double x, double y, double z) { return eagar_tsai_temperature(beam, metal, {x, y, z}); };
  std::uintmax_t iterations = 60;
  auto const [x_peak, coldest] =
      boost::math::tools::brent_find_minima([&](double x) { return -at(x, 0, 0); }, -3 * w, w, 30, iterations);
  if (-coldest <= metal.melting_point) return {};
  double const x0 = x_peak;
  double const front = falls_below([&](double s) { return at(x0 + s, 0, 0); }, metal.melting_point, 0, w, tolerance),
               tail = falls_below([&](double s) { return at(x0 - s, 0, 0); }, metal.melting_point, 0, w, tolerance);
  auto const extent = [&](double x, Vec3 const& direction) {
    auto const along = [&](double s) { return at(x, s * direction.y(), s * direction.z()); };
    return along(0) <= metal.melting_point ? 0.0 : falls_below(along, metal.melting_point, 0, 0.5 * w, tolerance);
  };
  double const half_width = largest([&](double x) { return extent(x, Vec3::UnitY()); }, x0 - tail, x0 + front),
               depth = largest([&](double x) { return extent(x, Vec3::UnitZ()); }, x0 - tail, x0 + front);
  return {.width = 2 * half_width, .depth = depth, .length = front + tail};
}

}  // namespace layerloop::thermal
