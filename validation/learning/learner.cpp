#include "validation/learning/learner.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace layerloop::validation {
namespace {

Surrogate surrogate_of_rows(std::vector<LearnedRun> const& trials, double sign) {
  Eigen::MatrixXd places(static_cast<Eigen::Index>(trials.size()), trials.front().place.size());
  Eigen::VectorXd values(places.rows());
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    places.row(i) = trials[static_cast<std::size_t>(i)].place;
    values[i] = sign * trials[static_cast<std::size_t>(i)].value;
  }
  return {places, values};
}

/// Largest distance of two places in any input, in shares of the box.
double apart(Eigen::RowVectorXd const& a, Eigen::RowVectorXd const& b, InputBox const& box) {
  return (a - b).cwiseQuotient(box.high - box.low).cwiseAbs().maxCoeff();
}

Region not_yet_run(std::vector<LearnedRun> const& trials, InputBox const& box) {
  return [&](Eigen::RowVectorXd const& place) {
    return std::ranges::none_of(trials,
                                [&](LearnedRun const& trial) { return apart(trial.place, place, box) < 0.001; });
  };
}

double sign_of(Goal goal) { return goal == Goal::minimise ? -1 : 1; }

}  // namespace

Surrogate surrogate_of(std::vector<LearnedRun> const& trials, Goal goal) {
  std::vector<LearnedRun> done;
  std::ranges::copy_if(trials, std::back_inserter(done),
                       [](LearnedRun const& trial) { return std::isfinite(trial.value); });
  return surrogate_of_rows(done, sign_of(goal));
}

Region runnable(std::vector<LearnedRun> const& trials, InputBox const& box) {
  return [=](Eigen::RowVectorXd const& place) {
    double done = INFINITY, failed = INFINITY;
    for (LearnedRun const& trial : trials) {
      double& nearest = std::isfinite(trial.value) ? done : failed;
      nearest = std::min(nearest, (trial.place - place).cwiseQuotient(box.high - box.low).norm());
    }
    return done <= failed;
  };
}

Optimum optimum_of(std::vector<LearnedRun> const& trials, LearnPlan const& plan) {
  Optimum found = find_optimum(surrogate_of(trials, plan.goal), plan.box, plan.seed, runnable(trials, plan.box));
  if (sign_of(plan.goal) > 0) return found;
  found.value.mean *= -1;
  std::tie(found.value_low, found.value_high) = std::pair(-found.value_high, -found.value_low);
  return found;
}

Eigen::RowVectorXd propose(std::vector<LearnedRun> const& trials, LearnPlan const& plan) {
  double const sign = sign_of(plan.goal);
  double worst = INFINITY;
  for (LearnedRun const& trial : trials)
    if (std::isfinite(trial.value)) worst = std::min(worst, sign * trial.value);
  std::vector<LearnedRun> all = trials;
  for (LearnedRun& trial : all)
    if (!std::isfinite(trial.value)) trial.value = sign * worst;
  Acquisition const acquisition = plan.goal == Goal::know ? Acquisition::variance : plan.acquisition;
  return next_place(surrogate_of_rows(all, sign), plan.box, acquisition, plan.seed + trials.size(),
                    plan.readings == Readings::exact ? not_yet_run(trials, plan.box) : everywhere);
}

void learn(std::vector<LearnedRun>& trials, LearnPlan const& plan, std::int64_t places,
           std::function<std::vector<double>(Eigen::RowVectorXd const&)> const& simulate) {
  for (std::int64_t k = 0; k < places; ++k) {
    Eigen::RowVectorXd const place = propose(trials, plan);
    for (double const value : simulate(place)) trials.push_back({place, value});
  }
}

}  // namespace layerloop::validation
