#include "validation/stage_clamp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "validation/condition_case.hpp"
#include "validation/error_model.hpp"
#include "validation/quantity.hpp"

namespace layerloop::validation {
namespace {

constexpr char const* key = "laser.absorptivity";

struct Mean {
  double sum = 0, u = 0;
  int n = 0;
};

/// Of the readings of every condition: what they scatter by, and what they share.
std::vector<Mean> measured_absorptivity(Study const& study) {
  std::vector<Mean> all(study.conditions.size());
  for (Observation const& o : study.observations) {
    if (o.quantity != "absorptivity" || study.observables[o.observable].x) continue;
    Mean& mean = all[o.condition];
    mean.sum += o.value;
    mean.u = std::max(mean.u,
                      std::sqrt(o.u_stat * o.u_stat + o.u_sys_abs * o.u_sys_abs + std::pow(o.u_sys_rel * o.value, 2)));
    ++mean.n;
  }
  return all;
}

void set_absorptivity(Study& study, std::size_t condition, double value) {
  study.conditions[condition].inputs[key] = std::clamp(value, 1e-3, 1.0);
}

/// What a model of the pools alone has to predict.
void keep_used_observables(Study& study) {
  std::vector<Observable> used;
  for (Observation& o : study.observations) {
    Observable const& own = study.observables[o.observable];
    auto const found = std::ranges::find(used, own) - used.begin();
    if (found == std::ssize(used)) used.push_back(own);
    o.observable = static_cast<std::size_t>(found);
  }
  study.observables = used;
}

/// Calibration numbers of the key act no more where a reading stands in.
void release(Study& study, std::vector<bool> const& measured) {
  for (CalibrationParameter& parameter : study.calibration) {
    if (parameter.key != key) continue;
    if (parameter.acts_on.empty()) parameter.acts_on.assign(study.conditions.size(), true);
    for (std::size_t c = 0; c < measured.size(); ++c)
      if (measured[c]) parameter.acts_on[c] = false;
  }
}

}  // namespace

std::optional<ClampedStudy> with_measured_absorptivity(Study const& study) {
  ClampedStudy clamped{study, {}, {}};
  std::vector<Mean> const means = measured_absorptivity(study);
  std::vector<bool> measured;
  for (Mean const& mean : means) measured.push_back(mean.n > 0);
  release(clamped.study, measured);
  clamped.study.observations.clear();
  clamped.study.categories.clear();
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    Observation const& o = study.observations[i];
    if (!measured[o.condition] || find_quantity(o.quantity)->stage != EffectStage::heat) continue;
    clamped.study.observations.push_back(o);
    clamped.rows.push_back(static_cast<Eigen::Index>(i));
  }
  if (clamped.rows.empty()) return std::nullopt;
  keep_used_observables(clamped.study);
  clamped.shifted = clamped.study;
  for (std::size_t c = 0; c < means.size(); ++c) {
    if (!measured[c]) continue;
    double const mean = means[c].sum / means[c].n;
    set_absorptivity(clamped.study, c, mean);
    set_absorptivity(clamped.shifted, c, mean + means[c].u);
  }
  return clamped;
}

ClampedResult run_clamped(ClampedStudy const& clamped, Eigen::VectorXd const& simulated, ModelMaker const& make) {
  std::unique_ptr<Model> const model = make(clamped.study), shifted = make(clamped.shifted);
  Study study = clamped.study;
  ModelPoint const base{prior_means(study), {}, 0};
  Prediction const prediction = model->predict(base);
  ClampedResult result;
  std::vector<Observation> known;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    if (!std::isfinite(prediction.value[index(study.observations[i].observable)])) continue;
    known.push_back(study.observations[i]);
    result.rows.push_back(clamped.rows[i]);
  }
  study.observations = known;
  if (known.empty()) return result;
  Eigen::VectorXd const with_light = at_observations(study, prediction.value);
  Eigen::MatrixXd c = covariance(study, prediction);
  auto const change_to = [&](Model& other, ModelPoint const& point) -> Eigen::VectorXd {
    Eigen::VectorXd const change = at_observations(study, other.predict(point).value) - with_light;
    return change.array().isFinite().select(change, 0);
  };
  for (std::size_t p = 0; p < study.calibration.size(); ++p) {
    auto const& acts_on = study.calibration[p].acts_on;
    if (!acts_on.empty() && std::ranges::none_of(acts_on, [](bool acts) { return acts; })) continue;
    ModelPoint point = base;
    point.calibration[index(p)] += study.calibration[p].sd;
    Eigen::VectorXd const change = change_to(*model, point);
    c += change * change.transpose();
  }
  Eigen::VectorXd const by_light = change_to(*shifted, base);
  for (std::size_t a = 0; a < known.size(); ++a) {
    for (std::size_t b = 0; b < known.size(); ++b)
      if (known[a].condition == known[b].condition) c(index(a), index(b)) += by_light[index(a)] * by_light[index(b)];
  }
  Whitening const whiten(c);
  result.chi2 = whiten(measured_values(study) - with_light).squaredNorm();
  result.chi2_simulated = whiten(measured_values(study) - simulated(result.rows)).squaredNorm();
  result.passes = model->passes() + shifted->passes();
  return result;
}

std::string words_of_clamp(double simulated, double clamped, std::size_t points) {
  boost::math::chi_squared const expected(static_cast<double>(points));
  double const high = quantile(complement(expected, 0.01));
  if (simulated <= high)
    return clamped <= high ? "the pools fit, with the simulated light and with the measured one"
                           : "the pools fit with the simulated light, but not with the measured one: errors of light "
                             "and heat cancel, or the absorptivity is measured wrong";
  if (clamped <= high) return "the fault lies upstream, in the light: with the measured absorptivity the pools fit";
  if (clamped < 0.5 * simulated)
    return "more than half of the misfit lies upstream, in the light; heat has one of its own";
  return "the fault lies in the heat: the measured absorptivity does not mend the pools";
}

}  // namespace layerloop::validation
