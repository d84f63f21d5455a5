#include "validation/rival_fits.hpp"

#include <algorithm>
#include <cmath>

#include "validation/before_after.hpp"

namespace layerloop::validation {
namespace {

constexpr std::size_t most_rivals = 3;
constexpr double step = 0.25;  // of a derivative [prior scales], as in the refit: those runs are known

CandidateFinding const* grouped(Diagnosis const& found) {
  for (CandidateFinding const& effect : found.effects)
    if (effect.active && !effect.group.empty()) return &effect;
  return nullptr;
}

std::vector<std::size_t> active_of(Explanation const& explained) {
  std::vector<AddedEffect> effects;
  for (CandidateFinding const& effect : explained.found.effects)
    if (effect.active) effects.push_back({effect.name});
  return indices_of(effects, explained.candidates);
}

/// The conditions of a study with every quantity to be predicted under each.
Study with_observables(Study study, std::vector<std::string> const& quantities) {
  study.observations.clear();
  study.observables.clear();
  study.categories.clear();
  for (std::size_t c = 0; c < study.conditions.size(); ++c)
    for (std::string const& quantity : quantities) study.observables.push_back({c, quantity});
  return study;
}

ModelPoint stepped(Fit const& fit, Study const& study, std::vector<Candidate> const& candidates, std::size_t k) {
  ModelPoint point = fit.point;
  if (k < study.calibration.size()) {
    point.calibration[index(k)] += step * study.calibration[k].sd;
  } else {
    std::size_t const candidate = fit.active[k - study.calibration.size()];
    point.strengths[index(candidate)] += step * candidates[candidate].prior_scale;
  }
  return point;
}

}  // namespace

RivalFits fit_rivals(Explanation const& explained, Model& model, ResidualFrame const& frame) {
  CandidateFinding const* const first = grouped(explained.found);
  if (!first) return {};
  Refit const refit(model, explained.candidates, frame, explained.found.sigma2);
  std::vector<std::size_t> const active = active_of(explained);
  RivalFits rivals{{first->name}, {refit.settled(refit.at(explained.found.final_point, active))}};
  std::size_t const replaced = indices_of({{first->name}}, explained.candidates)[0];
  for (std::string const& name : first->group) {
    if (rivals.names.size() > most_rivals) break;
    std::size_t const rival = indices_of({{name}}, explained.candidates)[0];
    auto const finding = std::ranges::find(explained.found.effects, name, &CandidateFinding::name);
    ModelPoint point = explained.found.final_point;
    point.strengths[index(replaced)] = 0;
    point.strengths[index(rival)] = finding->strength;
    std::vector<std::size_t> with = active;
    std::ranges::replace(with, replaced, rival);
    Fit fit = refit.at(point, with);
    if (!fit.residual.allFinite()) continue;
    rivals.names.push_back(name);
    rivals.fits.push_back(refit.settled(std::move(fit)));
  }
  return rivals;
}

std::map<std::string, RivalPredictions> predict_rivals(Study const& conditions_of,
                                                       std::vector<std::string> const& quantities,
                                                       std::vector<Candidate> const& candidates,
                                                       RivalFits const& rivals, ModelOf const& model_of,
                                                       bool sensitive) {
  Study const study = with_observables(conditions_of, quantities);
  std::unique_ptr<Model> const model = model_of(study);
  std::map<std::string, RivalPredictions> all;
  auto const column = [&](Prediction const& prediction, std::size_t quantity) {
    Eigen::VectorXd values(index(study.conditions.size()));
    for (Eigen::Index c = 0; c < values.size(); ++c)
      values[c] = prediction.value[c * index(quantities.size()) + index(quantity)];
    return values;
  };
  for (Fit const& fit : rivals.fits) {
    Prediction const here = model->predict(fit.point);
    std::size_t const free = sensitive ? study.calibration.size() + fit.active.size() : 0;
    std::vector<Prediction> beside;
    for (std::size_t k = 0; k < free; ++k) beside.push_back(model->predict(stepped(fit, study, candidates, k)));
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      RivalPredictions& of = all[quantities[q]];
      of.value.push_back(column(here, q));
      Eigen::MatrixXd slopes(of.value.back().size(), index(free));
      for (std::size_t k = 0; k < free; ++k) slopes.col(index(k)) = (column(beside[k], q) - of.value.back()) / step;
      of.derivative.push_back(slopes);
    }
  }
  return all;
}

double separation(Eigen::VectorXd const& difference, Eigen::MatrixXd const& derivatives,
                  Eigen::VectorXd const& new_difference, Eigen::MatrixXd const& new_derivatives) {
  Eigen::VectorXd d(difference.size() + new_difference.size());
  d << difference, new_difference;
  Eigen::MatrixXd j(d.size(), derivatives.cols());
  j << derivatives, new_derivatives;
  return Projection(d.size(), j)(d).squaredNorm();
}

}  // namespace layerloop::validation
