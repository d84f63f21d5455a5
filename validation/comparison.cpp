#include "validation/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "validation/condition_case.hpp"
#include "validation/error_model.hpp"
#include "validation/pattern.hpp"
#include "validation/quantity.hpp"
#include "validation/stage_clamp.hpp"

namespace layerloop::validation {
namespace {

/// Change of every observation's prediction by one prior standard deviation of each calibration number. Where the model
/// has no answer one standard deviation off, the number counts nothing.
Eigen::MatrixXd responses(Study const& study, Model& model, ModelPoint const& base, Eigen::VectorXd const& at_base) {
  Eigen::MatrixXd all(index(study.observations.size()), base.calibration.size());
  for (Eigen::Index p = 0; p < base.calibration.size(); ++p) {
    ModelPoint shifted = base;
    shifted.calibration[p] += study.calibration[static_cast<std::size_t>(p)].sd;
    Eigen::VectorXd const change = at_observations(study, model.predict(shifted).value) - at_base;
    all.col(p) = change.array().isFinite().select(change, 0);
  }
  return all;
}

std::vector<ComparedPoint> points_of(Study const& all, Study const& study, Prediction const& prediction,
                                     Eigen::MatrixXd const& by_input) {
  std::vector<ComparedPoint> points;
  std::size_t place = 0;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    Observation const& seen = study.observations[i];
    while (all.observations[place].id != seen.id) ++place;
    Eigen::Index const o = index(seen.observable);
    ComparedPoint point{place, seen.value, prediction.value[o]};
    point.u_data = std::sqrt(seen.u_stat * seen.u_stat + seen.u_sys_abs * seen.u_sys_abs +
                             std::pow(seen.u_sys_rel * prediction.value[o], 2));
    point.u_num = std::hypot(prediction.u_sampling[o], prediction.u_numerical[o]);
    point.u_input = by_input.row(index(i)).norm();
    points.push_back(point);
  }
  return points;
}

double chi2_of(Eigen::VectorXd const& difference, Eigen::MatrixXd const& covariance,
               std::vector<Eigen::Index> const& rows) {
  if (rows.empty()) return 0;
  return Whitening(covariance(rows, rows))(difference(rows)).squaredNorm();
}

/// Area between the empirical distributions of simulated and measured values (Ferson and Oberkampf).
double area_between(std::vector<double> simulated, std::vector<double> measured) {
  std::ranges::sort(simulated);
  std::ranges::sort(measured);
  double area = 0;
  for (std::size_t i = 0; i < simulated.size(); ++i)
    area += std::abs(simulated[i] - measured[i]) / static_cast<double>(simulated.size());
  return area;
}

ComparedQuantity summary_of(std::string const& name, std::vector<ComparedPoint> const& points) {
  ComparedQuantity all{.name = name, .points = points.size()};
  std::vector<double> simulated, measured;
  double const n = static_cast<double>(points.size());
  for (ComparedPoint const& point : points) {
    all.bias += point.error() / n;
    all.rms += point.error() * point.error() / n;
    all.relative_rms += std::pow(point.error() / point.measured, 2) / n;
    all.inside_2u += (point.inside() ? 1 : 0) / n;
    simulated.push_back(point.simulated), measured.push_back(point.measured);
  }
  all.rms = std::sqrt(all.rms), all.relative_rms = std::sqrt(all.relative_rms);
  all.area = area_between(simulated, measured);
  return all;
}

std::vector<ComparedCategory> categories_of(Study const& study, Prediction const& prediction) {
  std::vector<ComparedCategory> all;
  for (Category const& category : study.categories) {
    double const place = prediction.value[index(category.observable)];
    std::string const simulated = std::isfinite(place) ? regime_words().at(static_cast<std::size_t>(place)) : "";
    all.push_back(
        {category.id, study.conditions[study.observables[category.observable].condition].id, category.word, simulated});
  }
  return all;
}

/// Everything that is counted quantity by quantity and stage by stage.
void summarise(Comparison& result, Study const& known, Eigen::VectorXd const& difference,
               Eigen::MatrixXd const& covariance) {
  std::map<std::string, std::vector<Eigen::Index>> rows;
  std::map<EffectStage, std::vector<Eigen::Index>> by_stage;
  for (std::size_t i = 0; i < known.observations.size(); ++i) {
    rows[known.observations[i].quantity].push_back(index(i));
    by_stage[find_quantity(known.observations[i].quantity)->stage].push_back(index(i));
  }
  for (Quantity const& quantity : quantities()) {
    auto const asked = std::ranges::count(result.study.observations, quantity.name, &Observation::quantity);
    if (asked == 0) continue;
    std::vector<ComparedPoint> points;
    for (Eigen::Index const i : rows[quantity.name]) points.push_back(result.points[static_cast<std::size_t>(i)]);
    ComparedQuantity summary = summary_of(quantity.name, points);
    summary.unanswered = static_cast<std::size_t>(asked) - points.size();
    summary.chi2 = chi2_of(difference, covariance, rows[quantity.name]);
    result.quantities.push_back(summary);
  }
  for (auto const& [stage, of_stage] : by_stage)
    result.stages.push_back(
        {.stage = stage, .points = of_stage.size(), .chi2 = chi2_of(difference, covariance, of_stage)});
}

/// The heat stage once more, with the light that was measured.
void clamp_light(Comparison& result, Study const& known, Eigen::VectorXd const& simulated, ModelMaker const& make) {
  std::optional<ClampedStudy> const clamped = with_measured_absorptivity(known);
  if (!clamped) return;
  ClampedResult const found = run_clamped(*clamped, simulated, make);
  result.passes += found.passes;
  auto const stage = std::ranges::find(result.stages, EffectStage::heat, &ComparedStage::stage);
  if (found.rows.empty() || stage == result.stages.end()) return;
  stage->clamped = "absorptivity";
  stage->clamped_points = found.rows.size();
  stage->chi2_of_clamped_points = found.chi2_simulated;
  stage->chi2_clamped = found.chi2;
  stage->sentence = words_of_clamp(found.chi2_simulated, found.chi2, found.rows.size());
}

}  // namespace

double ComparedPoint::u_val() const { return std::sqrt(u_data * u_data + u_num * u_num + u_input * u_input); }
bool ComparedPoint::inside() const { return std::abs(error()) <= 2 * u_val(); }

Comparison compare(Study const& study, ModelMaker const& make, std::uint64_t seed) {
  Comparison result;
  result.study = study;
  result.seed = seed;
  std::unique_ptr<Model> const model = make(study);
  ModelPoint const base{prior_means(study), {}, 0};
  Prediction const prediction = model->predict(base);
  Study const known = answered(study, prediction);
  result.dof = known.observations.size();
  result.categories = categories_of(study, prediction);
  if (!known.observations.empty()) {
    Eigen::VectorXd const simulated = at_observations(known, prediction.value);
    Eigen::MatrixXd const by_input = responses(known, *model, base, simulated);
    Eigen::MatrixXd const c = covariance(known, prediction) + by_input * by_input.transpose();
    Eigen::VectorXd const difference = measured_values(known) - simulated;
    Whitening const whiten(c);
    result.standardised = whiten(difference);
    result.chi2 = result.standardised.squaredNorm();
    result.points = points_of(study, known, prediction, by_input);
    summarise(result, known, difference, c);
    Projection const nothing_taken_out(difference.size(), Eigen::MatrixXd(difference.size(), 0));
    PatternSearch const search(generic_patterns(known, simulated, whiten), nothing_taken_out, seed);
    result.patterns = search.find(result.standardised, 1);
    result.passes = model->passes();
    clamp_light(result, known, simulated, make);
  }
  result.notes = model->notes();
  return result;
}

}  // namespace layerloop::validation
