#include "core/statistics.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "core/compensated_sum.hpp"

namespace layerloop {

double student_t_quantile(double probability, double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), probability);
}

Sample sample_of(std::span<double const> values) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  Sample sample{.n = 0, .mean = nothing, .sd = nothing, .half_width = nothing};
  CompensatedSum sum, squares;
  for (double const value : values) {
    if (!std::isfinite(value)) continue;
    sum.add(value);
    ++sample.n;
  }
  double const n = static_cast<double>(sample.n);
  if (sample.n > 0) sample.mean = sum.value() / n;
  if (sample.n < 2) return sample;
  for (double const value : values) {
    if (std::isfinite(value)) squares.add((value - sample.mean) * (value - sample.mean));
  }
  sample.sd = std::sqrt(squares.value() / (n - 1));
  sample.half_width = student_t_quantile(0.975, n - 1) * sample.sd / std::sqrt(n);
  return sample;
}

}  // namespace layerloop
