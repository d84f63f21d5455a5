#pragma once
#include <functional>

#include "validation/learning/acquisition.hpp"

namespace layerloop::validation {

/// One simulation: where, and what came out; not a number when it failed.
struct LearnedRun {
  Eigen::RowVectorXd place;
  double value = 0;
};

/// Whether a place that is run again, with another seed, gives another reading.
enum class Readings { noisy, exact };

struct LearnPlan {
  InputBox box;
  Goal goal = Goal::maximise;
  Acquisition acquisition = Acquisition::expected_improvement;
  std::uint64_t seed = 0;
  Readings readings = Readings::noisy;
};

/// Surrogate of the trials that did not fail, of -value where the smallest is wanted. \pre two of them at least
Surrogate surrogate_of(std::vector<LearnedRun> const& trials, Goal goal);

/// Places whose nearest trial did not fail, distances in shares of the box; a place of which one trial did not fail is
/// one of them.
Region runnable(std::vector<LearnedRun> const& trials, InputBox const& box);

/// Best value and place among those that are runnable, in the sign of the values; of Goal::know the largest.
Optimum optimum_of(std::vector<LearnedRun> const& trials, LearnPlan const& plan);

/// Where to run next. A trial that failed counts as the worst value seen, so that it is not tried again. Exact
/// readings are not taken again: the place is a thousandth of the range away from every trial at least.
Eigen::RowVectorXd propose(std::vector<LearnedRun> const& trials, LearnPlan const& plan);

/// Adds what `places` further places give, each chosen by the trials before it. \param simulate  the values at a place,
/// one a seed
void learn(std::vector<LearnedRun>& trials, LearnPlan const& plan, std::int64_t places,
           std::function<std::vector<double>(Eigen::RowVectorXd const&)> const& simulate);

}  // namespace layerloop::validation
