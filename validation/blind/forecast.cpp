#include "validation/blind/forecast.hpp"

#include <cmath>

#include "validation/error_model.hpp"
#include "validation/gaussian_process.hpp"
#include "validation/smooth_correction.hpp"

namespace layerloop::validation {
namespace {

double rms(Eigen::VectorXd const& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

Eigen::VectorXd vector_of(std::vector<double> const& values) {
  return Eigen::Map<Eigen::VectorXd const>(values.data(), index(values.size()));
}

Eigen::VectorXd u_stat(Study const& study) {
  Eigen::VectorXd u(index(study.observations.size()));
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = study.observations[static_cast<std::size_t>(i)].u_stat;
  return u;
}

/// Places of both studies, scaled alike.
Eigen::MatrixXd places_of(Study const& training, Study const& holdout) {
  Study both = training;
  for (Observation row : holdout.observations) {
    row.observable += training.observables.size();
    both.observations.push_back(row);
  }
  both.observables.insert(both.observables.end(), holdout.observables.begin(), holdout.observables.end());
  return smooth_inputs(both);
}

/// What a Gaussian process a quantity, fitted to training residuals, adds to the held-out rows, in units of u_stat.
Eigen::VectorXd smooth_correction(Study const& training, Study const& holdout, Eigen::VectorXd const& residual) {
  Eigen::MatrixXd const places = places_of(training, holdout);
  Eigen::VectorXd correction = Eigen::VectorXd::Zero(index(holdout.observations.size()));
  std::map<std::string, std::vector<Eigen::Index>> rows;
  for (std::size_t i = 0; i < training.observations.size(); ++i)
    rows[training.observations[i].quantity].push_back(index(i));
  for (auto const& [quantity, own] : rows) {
    GaussianProcess const process =
        fit_gaussian_process(places(own, Eigen::all), residual(own), Eigen::VectorXd::Ones(index(own.size())));
    for (Eigen::Index i = 0; i < correction.size(); ++i)
      if (holdout.observations[static_cast<std::size_t>(i)].quantity == quantity)
        correction[i] = process(places.row(residual.size() + i)).mean;
  }
  return correction;
}

}  // namespace

Forecast forecast_of(World const& world, Study const& training, Study const& holdout,
                     std::vector<std::string> const& withheld, std::map<std::string, double> const& truth,
                     Judgement const& judgement) {
  std::vector<Candidate> const candidates = known_candidates(world, training, withheld);
  auto const model = world.model(holdout, candidates), trained = world.model(training, candidates);
  ModelPoint const before{vector_of(judgement.calibrated), Eigen::VectorXd::Zero(index(candidates.size())), 1},
      after{vector_of(judgement.final_calibration), vector_of(judgement.final_strengths), 1};
  Prediction const first = model->predict(before), second = model->predict(after), fitted = trained->predict(before);
  Study const seen = answered(training, fitted), unseen = answered(answered(holdout, first), second);
  if (seen.observations.empty() || unseen.observations.empty()) return {NAN, NAN, NAN, NAN};
  Eigen::VectorXd truths(index(unseen.observations.size()));
  for (Eigen::Index i = 0; i < truths.size(); ++i)
    truths[i] = truth.at(unseen.observations[static_cast<std::size_t>(i)].id);
  Eigen::VectorXd const u = u_stat(unseen), b = at_observations(unseen, second.value);
  Eigen::VectorXd const residual =
      (measured_values(seen) - at_observations(seen, fitted.value)).cwiseQuotient(u_stat(seen));
  Eigen::VectorXd const off = (at_observations(unseen, first.value) - truths).cwiseQuotient(u);
  Whitening const whiten(covariance(unseen, second));
  return {rms(off), rms((b - truths).cwiseQuotient(u)), rms(off + smooth_correction(seen, unseen, residual)),
          rms(whiten(measured_values(unseen) - b))};
}

}  // namespace layerloop::validation
