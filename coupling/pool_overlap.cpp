#include "coupling/pool_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace layerloop::coupling {
namespace {

/// Width of the pool over the hatch at a depth below its top.
double covered(PoolArray const& array, double depth) {
  double const u = depth / array.depth;
  return u < 1 ? array.width / array.hatch_spacing * std::sqrt(1 - u * u) : 0;
}

/// Of the strip at depth s below the top of its layer.
double unmelted_at(PoolArray const& array, HatchPattern pattern, double s) {
  double left = 1 - covered(array, s);
  if (pattern == HatchPattern::shifted) left -= covered(array, s + array.layer_thickness);
  if (pattern == HatchPattern::rotated)
    for (double z = s + array.layer_thickness; left > 0 && z < array.depth; z += array.layer_thickness)
      left *= std::max(0.0, 1 - covered(array, z));
  return std::max(0.0, left);
}

/// Integral of sqrt(1 - u^2) from 0 to u <= 1.
double circle_area(double u) { return 0.5 * (u * std::sqrt(1 - u * u) + std::asin(u)); }

/// Depths between which `unmelted_at` is smooth: where pools end or begin to touch.
std::vector<double> breaks(PoolArray const& array, HatchPattern pattern) {
  double const L = array.layer_thickness, D = array.depth;
  std::vector<double> found{0, L};
  auto const add = [&](double s) {
    if (s > 0 && s < L) found.push_back(s);
  };
  double const touching = 1 - std::pow(array.hatch_spacing / array.width, 2);  // (s / D)^2 where w(s) = hatch
  for (double above = 0; above < D; above += L) {
    add(D - above);
    if (touching > 0) add(D * std::sqrt(touching) - above);
  }
  if (pattern == HatchPattern::shifted) {  // c_0 + c_1 = 1, by halving: the sum falls with s
    double low = 0, high = L;
    for (int k = 0; k < 60; ++k) {
      double const middle = 0.5 * (low + high);
      (covered(array, middle) + covered(array, middle + L) > 1 ? low : high) = middle;
    }
    add(low);
  }
  std::ranges::sort(found);
  return found;
}

/// Gauss-Legendre quadrature of ten points after s = middle - half cos(pi t): it takes the square root out of either
/// end.
double integral(PoolArray const& array, HatchPattern pattern, double from, double to) {
  static constexpr std::array<double, 5> node{0.1488743389816312, 0.4333953941292472, 0.6794095682990244,
                                              0.8650633666889845, 0.9739065285171717},
      weight{0.2955242247147529, 0.2692667193099964, 0.2190863625159820, 0.1494513491505806, 0.0666713443086881};
  double const middle = 0.5 * (from + to), half = 0.5 * (to - from), quarter_turn = std::asin(1.0);
  double sum = 0;
  for (std::size_t k = 0; k < node.size(); ++k)
    for (double const sign : {-1.0, 1.0}) {
      double const angle = quarter_turn * (1 + sign * node[k]);
      sum += weight[k] * std::sin(angle) * unmelted_at(array, pattern, middle - half * std::cos(angle));
    }
  return half * quarter_turn * sum;
}

}  // namespace

double overlap_number(PoolArray const& array) {
  if (array.width <= 0 || array.depth <= 0) return std::numeric_limits<double>::infinity();
  return std::pow(array.hatch_spacing / array.width, 2) + std::pow(array.layer_thickness / array.depth, 2);
}

double unmelted_share(PoolArray const& array, HatchPattern pattern) {
  double const q = overlap_number(array), L = array.layer_thickness, D = array.depth;
  if (!std::isfinite(q)) return 1;
  if (q <= 1) return 0;
  if (pattern == HatchPattern::aligned) {
    double const ratio = array.width / array.hatch_spacing;
    double const first = ratio > 1 ? D * std::sqrt(1 - 1 / (ratio * ratio)) : 0;  // above it neighbours touch
    double const open = L - first, last = std::min(L, D);
    return (open - ratio * D * (circle_area(last / D) - circle_area(first / D))) / L;
  }
  double sum = 0;
  std::vector<double> const at = breaks(array, pattern);
  for (std::size_t k = 1; k < at.size(); ++k) sum += integral(array, pattern, at[k - 1], at[k]);
  return sum / L;
}

}  // namespace layerloop::coupling
