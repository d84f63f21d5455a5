#pragma once
#include <cstdint>
#include <span>

namespace layerloop {

/// What independent repeats say about a quantity.
struct Sample {
  std::int64_t n = 0;  ///< finite values
  double mean = 0;     ///< not a number without values
  double sd = 0;       ///< of the values (n - 1 in the denominator); not a number below two values
  /// Half width of the 95 % interval of the mean, t(0.975, n - 1) sd / sqrt(n); not a number below two values.
  double half_width = 0;
};

/// Values that are not finite (nothing was there to measure) are left out.
Sample sample_of(std::span<double const> values);

/// Quantile of Student's t distribution: t(0.975, 2) = 4.3027. \pre 0 < probability < 1, degrees_of_freedom > 0
double student_t_quantile(double probability, double degrees_of_freedom);

}  // namespace layerloop
