#include "validation/learning/learner.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace layerloop::validation {
namespace {

Surrogate surrogate_of_rows(std::vector<Trial> const& trials, double sign) {
  Eigen::MatrixXd places(static_cast<Eigen::Index>(trials.size()), trials.front().place.size());
  Eigen::VectorXd values(places.rows());
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    places.row(i) = trials[static_cast<std::size_t>(i)].place;
    values[i] = sign * trials[static_cast<std::size_t>(i)].value;
  }
  return {places, values};
}

double sign_of(Goal goal) { return goal == Goal::minimise ? -1 : 1; }

}  // namespace

Surrogate surrogate_of(std::vector<Trial> const& trials, Goal goal) {
  std::vector<Trial> done;
  std::ranges::copy_if(trials, std::back_inserter(done), [](Trial const& trial) { return std::isfinite(trial.value); });
  return surrogate_of_rows(done, sign_of(goal));
}

Optimum optimum_of(std::vector<Trial> const& trials, LearnPlan const& plan) {
  Optimum found = find_optimum(surrogate_of(trials, plan.goal), plan.box, plan.seed);
  if (sign_of(plan.goal) > 0) return found;
  found.value.mean *= -1;
  std::tie(found.value_low, found.value_high) = std::pair(-found.value_high, -found.value_low);
  return found;
}

Eigen::RowVectorXd propose(std::vector<Trial> const& trials, LearnPlan const& plan) {
  double const sign = sign_of(plan.goal);
  double worst = INFINITY;
  for (Trial const& trial : trials)
    if (std::isfinite(trial.value)) worst = std::min(worst, sign * trial.value);
  std::vector<Trial> all = trials;
  for (Trial& trial : all)
    if (!std::isfinite(trial.value)) trial.value = sign * worst;
  Acquisition const acquisition = plan.goal == Goal::know ? Acquisition::variance : plan.acquisition;
  return next_place(surrogate_of_rows(all, sign), plan.box, acquisition, plan.seed + trials.size());
}

void learn(std::vector<Trial>& trials, LearnPlan const& plan, std::int64_t places,
           std::function<std::vector<double>(Eigen::RowVectorXd const&)> const& simulate) {
  for (std::int64_t k = 0; k < places; ++k) {
    Eigen::RowVectorXd const place = propose(trials, plan);
    for (double const value : simulate(place)) trials.push_back({place, value});
  }
}

}  // namespace layerloop::validation
