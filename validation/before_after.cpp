#include "validation/before_after.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/spelling.hpp"

namespace layerloop::validation {
namespace {

ModelPoint point_of(Study const& study, std::size_t candidates, std::map<std::string, double> const& calibration,
                    std::uint64_t seeds) {
  ModelPoint point{.calibration = Eigen::VectorXd(index(study.calibration.size())),
                   .strengths = Eigen::VectorXd::Zero(index(candidates)),
                   .seeds = seeds};
  for (std::size_t k = 0; k < study.calibration.size(); ++k) {
    auto const known = calibration.find(study.calibration[k].name);
    bool const usable = known != calibration.end() && std::isfinite(known->second);
    point.calibration[index(k)] = usable ? known->second : study.calibration[k].mean;
  }
  return point;
}

}  // namespace

std::vector<std::size_t> indices_of(std::vector<AddedEffect> const& effects, std::vector<Candidate> const& candidates) {
  std::vector<std::string> names;
  for (Candidate const& candidate : candidates) names.push_back(candidate.name);
  std::vector<std::size_t> found;
  for (AddedEffect const& effect : effects) {
    auto const at = std::ranges::find(names, effect.name);
    if (at == names.end())
      throw InputError(fmt::format("\"{}\" is not a candidate of this study (known: {}){}", effect.name,
                                   fmt::join(names, ", "), did_you_mean(effect.name, names)));
    found.push_back(static_cast<std::size_t>(at - names.begin()));
  }
  return found;
}

Study answered_by_all(Study study, std::vector<Prediction> const& predictions) {
  std::size_t const readings = study.observations.size();
  std::erase_if(study.observations, [&](Observation const& seen) {
    return std::ranges::any_of(predictions, [&](Prediction const& prediction) {
      return !std::isfinite(prediction.value[index(seen.observable)]);
    });
  });
  if (study.observations.empty())
    throw PhysicsError(
        "the model has no answer for any of these measurements (nothing melts, or every run was stopped "
        "by a guard) look at one condition by itself");
  if (study.observations.size() < readings)
    study.limits.push_back(fmt::format("{} of {} readings have no prediction and are left out",
                                       readings - study.observations.size(), readings));
  return study;
}

ObservationTable observation_table(Study const& study, Prediction const& base, Prediction const& before,
                                   Prediction const& after, double sigma2) {
  Prediction certain = after;
  certain.u_sampling.setZero();
  certain.u_numerical.setZero();
  Eigen::VectorXd const all = sigma2 * covariance(study, after).diagonal();
  Eigen::VectorXd const data = sigma2 * covariance(study, certain).diagonal();
  ObservationTable table;
  table.measured = measured_values(study);
  table.base = at_observations(study, base.value);
  table.calibrated = at_observations(study, before.value);
  table.final_model = at_observations(study, after.value);
  table.u_data = data.cwiseSqrt();
  table.u_model = (all - data).cwiseMax(0).cwiseSqrt();
  table.residual_before = (table.measured - table.calibrated).cwiseQuotient(all.cwiseSqrt());
  table.residual_after = (table.measured - table.final_model).cwiseQuotient(all.cwiseSqrt());
  table.signatures.resize(table.measured.size(), 0);
  return table;
}

BeforeAfter before_and_after(Study given, Model& model, std::vector<Candidate> const& candidates,
                             Addition const& addition, std::uint64_t seeds) {
  std::vector<std::size_t> const active = indices_of(addition.effects, candidates);
  ModelPoint const prior = point_of(given, candidates.size(), {}, seeds);
  ModelPoint const without = point_of(given, candidates.size(), addition.calibration_without, seeds);
  ModelPoint with = point_of(given, candidates.size(), addition.calibration_with, seeds);
  for (std::size_t a = 0; a < active.size(); ++a) with.strengths[index(active[a])] = addition.effects[a].strength;
  std::vector<Prediction> const first{model.predict(prior), model.predict(without), model.predict(with)};
  BeforeAfter both{.study = answered_by_all(std::move(given), first),
                   .as_it_stands = {},
                   .before = {},
                   .after = {},
                   .effects = addition.effects,
                   .table = {}};
  // Relative uncertainties rest on the model with the effects, in all three.
  ResidualFrame const frame(both.study, first[2]);
  double const sigma2 = addition.sigma2;
  Refit const refit(model, candidates, frame, sigma2);
  both.as_it_stands = {
      .point = prior, .active = {}, .prediction = first[0], .residual = frame.residual(first[0]), .jacobian = {}};
  both.before = refit.settled(refit.at(without, {}));
  both.after = refit.settled(refit.at(with, active));
  both.chi2_base = both.as_it_stands.residual.squaredNorm() / sigma2;
  both.chi2_before = both.before.residual.squaredNorm() / sigma2;
  both.chi2_after = both.after.residual.squaredNorm() / sigma2;
  both.dof = std::max(1.0, static_cast<double>(frame.size() - both.after.jacobian.cols()));
  Eigen::VectorXd const u = refit.uncertainty(both.after);
  for (std::size_t a = 0; a < active.size(); ++a) {
    both.effects[a].strength = both.after.point.strengths[index(active[a])];
    both.effects[a].u_strength = candidates[active[a]].prior_scale * u[u.size() - index(active.size()) + index(a)];
  }
  both.table = observation_table(both.study, both.as_it_stands.prediction, both.before.prediction,
                                 both.after.prediction, sigma2);
  return both;
}

}  // namespace layerloop::validation
