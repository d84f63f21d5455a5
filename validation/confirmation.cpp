#include "validation/confirmation.hpp"

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace layerloop::validation {
namespace {

constexpr std::size_t fewest_conditions = 3, resamples = 4000;
constexpr double least_gain = 4;          // of chi2 on the training data: two standard deviations
constexpr double prior_weight = 1.0 / 9;  // as in the refit

/// Covariance of the free numbers of a fit, in prior scales.
Eigen::MatrixXd uncertainty_of(Fit const& fit, double sigma2) {
  Eigen::MatrixXd normal = fit.jacobian.transpose() * fit.jacobian / sigma2;
  Eigen::Index const calibration = normal.rows() - index(fit.active.size());
  normal.diagonal().head(calibration).array() += prior_weight;
  normal.diagonal().array() += 1e-9;
  return normal.inverse();
}

/// Root mean square of the residuals with everything known about them taken into account: readings, shared errors,
/// mesh, grains, and what the training data leave of calibration and strengths.
double whitened_rms(Study const& study, Model& model, std::vector<Candidate> const& candidates, Fit const& trained,
                    double sigma2) {
  ResidualFrame const frame(study, model.predict(trained.point));
  Fit const here = Refit(model, candidates, frame, sigma2).at(trained.point, trained.active);
  Eigen::MatrixXd c = here.jacobian * uncertainty_of(trained, sigma2) * here.jacobian.transpose();
  c.diagonal().array() += sigma2;
  return std::sqrt(here.residual.dot(c.llt().solve(here.residual)) / static_cast<double>(frame.size()));
}

HeldOutError error_of(Study const& study, ObservationTable const& table, std::string const& quantity) {
  HeldOutError error;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    if (!quantity.empty() && study.observations[i].quantity != quantity) continue;
    Eigen::Index const k = index(i);
    ++error.readings;
    error.rms_before += std::pow(1 - table.calibrated[k] / table.measured[k], 2);
    error.rms_after += std::pow(1 - table.final_model[k] / table.measured[k], 2);
    error.inside_before += std::abs(table.residual_before[k]) <= 2;
    error.inside_after += std::abs(table.residual_after[k]) <= 2;
  }
  double const n = static_cast<double>(std::max<std::size_t>(1, error.readings));
  return {error.readings, std::sqrt(error.rms_before / n), std::sqrt(error.rms_after / n), error.inside_before / n,
          error.inside_after / n};
}

std::vector<double> gains_by_condition(Study const& study, ObservationTable const& table) {
  std::map<std::size_t, std::pair<double, int>> sums;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    auto& [sum, n] = sums[study.observations[i].condition];
    sum += std::pow(table.residual_before[index(i)], 2) - std::pow(table.residual_after[index(i)], 2);
    ++n;
  }
  std::vector<double> gains;
  for (auto const& [condition, sum] : sums) gains.push_back(sum.first / sum.second);
  return gains;
}

}  // namespace

PairedGain paired_gain(std::vector<double> const& by_condition, std::uint64_t seed) {
  std::size_t const n = by_condition.size();
  auto const mean_of = [&](auto const& draw) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += by_condition[draw(k)];
    return sum / static_cast<double>(n);
  };
  std::vector<double> means;
  for (std::size_t r = 0; r < resamples; ++r)
    means.push_back(mean_of([&](std::size_t k) {
      double const u = uniform4(seed, RandomStream::bootstrap, r, static_cast<std::uint32_t>(k))[0];
      return std::min(n - 1, static_cast<std::size_t>(u * static_cast<double>(n)));
    }));
  std::ranges::sort(means);
  return {mean_of([](std::size_t k) { return k; }), {means[resamples / 40], means[resamples - 1 - resamples / 40]}};
}

Confirmation confirm(Study const& train, Model& train_model, Study const& holdout, Model& holdout_model,
                     std::vector<Candidate> const& candidates, Addition const& addition, std::uint64_t seed) {
  Confirmation found{.train = before_and_after(train, train_model, candidates, addition, 0),
                     .study = {},
                     .table = {},
                     .all = {},
                     .quantities = {}};
  double const sigma2 = addition.sigma2;
  Prediction const base = holdout_model.predict(found.train.as_it_stands.point);
  Prediction const before = holdout_model.predict(found.train.before.point);
  Prediction const after = holdout_model.predict(found.train.after.point);
  found.study = answered_by_all(holdout, {base, before, after});
  found.table = observation_table(found.study, base, before, after, sigma2);
  found.all = error_of(found.study, found.table, "");
  for (Observation const& seen : found.study.observations)
    found.quantities[seen.quantity] = error_of(found.study, found.table, seen.quantity);
  found.whitened_rms_before = whitened_rms(found.study, holdout_model, candidates, found.train.before, sigma2);
  found.whitened_rms_after = whitened_rms(found.study, holdout_model, candidates, found.train.after, sigma2);
  std::vector<double> const gains = gains_by_condition(found.study, found.table);
  PairedGain const gain = paired_gain(gains, seed);
  found.gain = gain.mean;
  found.ci95 = gain.ci95;
  found.conditions = gains.size();
  found.confirmed = found.ci95[0] > 0 && found.conditions >= fewest_conditions &&
                    found.train.chi2_after < found.train.chi2_before - least_gain;
  return found;
}

}  // namespace layerloop::validation
