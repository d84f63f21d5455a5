#pragma once
#include <cstdint>
#include <functional>

#include "validation/learning/surrogate.hpp"

namespace layerloop::validation {

enum class Goal { maximise, minimise, know };
enum class Acquisition { expected_improvement, upper_confidence_bound, variance };

/// Logarithm of the expected gain over `best` of a normal estimate: ln sd + ln(phi(z) + z Phi(z)), z = (mean - best) /
/// sd (Jones, Schonlau & Welch, J. Glob. Optim. 13 (1998) 455, eq. 15), by its asymptote where that underflows.
double log_expected_improvement(Estimate const& at, double best);

/// Limits of the inputs, one a column.
struct InputBox {
  Eigen::RowVectorXd low, high;
  Eigen::RowVectorXd at(Eigen::RowVectorXd const& share) const;  ///< share: 0 to 1 of each input
};

/// Whether a place may be looked at.
using Region = std::function<bool(Eigen::RowVectorXd const&)>;
inline bool everywhere(Eigen::RowVectorXd const&) { return true; }

/// `n` places in the box, independent and uniform. Shape: (n, inputs).
Eigen::MatrixXd uniform_places(InputBox const& box, Eigen::Index n, std::uint64_t seed);

/// Where the next run of a search for the largest value tells most: the largest expected improvement over the best that
/// the surrogate believes at the places so far (they may be noisy), the largest mean + 2 sd (Srinivas et al., IEEE
/// Trans. Inf. Theory 58 (2012) 3250), or the largest sd. Outside of the region only where nothing else was found.
Eigen::RowVectorXd next_place(Surrogate const& surrogate, InputBox const& box, Acquisition acquisition,
                              std::uint64_t seed, Region const& region = everywhere);

/// Where the surrogate is highest inside the box and the region.
Eigen::RowVectorXd highest_mean(Surrogate const& surrogate, InputBox const& box, std::uint64_t seed,
                                Region const& region = everywhere);

/// The largest value of a surrogate and where it lies in the region, with 95 % intervals.
struct Optimum {
  Eigen::RowVectorXd place, place_low, place_high;
  Estimate value;                ///< of the surrogate at `place`
  double value_low, value_high;  ///< of the largest value of a function drawn from the posterior
};

/// `place` has the highest mean. Intervals: the places and values of the largest value of functions drawn
/// from the posterior on those of many places that can be it (quantiles 2.5 % and 97.5 %), under kernels drawn from
/// their own; they hold `place`.
Optimum find_optimum(Surrogate const& surrogate, InputBox const& box, std::uint64_t seed,
                     Region const& region = everywhere);

}  // namespace layerloop::validation
