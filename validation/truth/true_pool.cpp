#include "validation/truth/true_pool.hpp"

#include <Eigen/Core>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace layerloop::validation {
namespace {

constexpr int nodes = 96;
using Nodes = Eigen::Array<double, nodes, 1>;

/// Square roots u of the time since a place was heated, u = exp(t - exp(-t)) at equal steps of t: the integrand falls
/// off at both ends faster than any power, so that the trapezoidal rule converges exponentially (Takahasi & Mori, Publ.
/// RIMS 9 (1974) 721). Lengths in 1/e2 radii, times in radius^2 / diffusivity.
struct Quadrature {
  Nodes time, spread, weight;

  Quadrature() {
    constexpr double first = -2.3, step = (2.2 - first) / (nodes - 1);
    for (int i = 0; i < nodes; ++i) {
      double const t = first + step * i, u = std::exp(t - std::exp(-t));
      time[i] = u * u;
      spread[i] = 4 * u * u + 0.5;
      weight[i] = step * u * (1 + std::exp(-t)) * 2 / (2 * u * u + 0.25) / std::sqrt(4 * std::pow(std::numbers::pi, 3));
    }
  }
};

struct Track {
  double speed, side, down;

  /// ln of the hottest temperature of this place while the beam goes by: under it, or where its heat arrives later.
  double peak() const {
    double const reach = side * side + down * down;
    return std::max(maximum(-0.1), reach > 0.2 ? maximum(-0.5 - 0.4 * speed * reach) : -INFINITY);
  }

 private:
  /// The maximum next to x, by Newton's method along the track.
  double maximum(double x) const {
    static Quadrature const rule;
    Nodes const beside = rule.weight * (-(side * side) / rule.spread - down * down / (4 * rule.time)).exp();
    double sum = 0;
    for (int iteration = 0; iteration < 60; ++iteration) {
      Nodes const ahead = x + speed * rule.time;
      Nodes const heat = beside * (-ahead.square() / rule.spread).exp();
      sum = heat.sum();
      double const slope = (heat * -2 * ahead / rule.spread).sum() / sum;
      double const bend = (heat * (4 * (ahead / rule.spread).square() - 2 / rule.spread)).sum() / sum - slope * slope;
      double const reach = 0.5 + 0.3 * std::abs(x);
      double const step = bend < 0 ? std::clamp(-slope / bend, -reach, reach) : std::copysign(reach, slope);
      x += step;
      if (std::abs(step) < 1e-5) break;
    }
    return std::log(sum);
  }
};

/// Distance beside or below the track at which the peak just melts.
double extent(double power, double speed, bool down) {
  Track track{speed, 0, 0};
  auto const excess = [&](double s) {
    (down ? track.down : track.side) = s;
    return std::log(power) + track.peak();
  };
  double low = 0, at_low = excess(0);
  if (!(at_low > 0)) return std::numeric_limits<double>::quiet_NaN();
  double high = 0.5, at_high = excess(high);
  while (at_high > 0) low = high, at_low = at_high, high *= 1.6, at_high = excess(high);
  std::uintmax_t iterations = 60;
  auto const close = [](double a, double b) { return std::abs(a - b) < 1e-6; };
  auto const [a, b] = boost::math::tools::toms748_solve(excess, low, high, at_low, at_high, close, iterations);
  return 0.5 * (a + b);
}

}  // namespace

TruePool true_pool(double power, double speed) { return {extent(power, speed, false), extent(power, speed, true)}; }

}  // namespace layerloop::validation
