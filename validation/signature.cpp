#include "validation/signature.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::validation {
namespace {

constexpr double least_change = 1e-3;  // of a signature, in standard uncertainties of all data together

struct Probe {
  Eigen::VectorXd column;
  bool answered = false;
};

Probe probed(Model& model, ResidualFrame const& frame, Fit const& fit, std::size_t candidate, double strength,
             double prior_scale) {
  ModelPoint beside = fit.point;
  beside.strengths[static_cast<Eigen::Index>(candidate)] += strength;
  Eigen::VectorXd const change = frame.change(model.predict(beside), fit.prediction);
  return {change * (prior_scale / strength), change.allFinite()};
}

/// Of grains whose ways part: independent of those without the candidate. Light and heat act on the same grains.
double sampling_noise(ResidualFrame const& frame, Fit const& fit, Candidate const& candidate) {
  if (candidate.stage != EffectStage::dem) return 0;
  Eigen::VectorXd const u = at_observations(frame.study(), fit.prediction.u_sampling);
  return 2 * frame.whiten()(Eigen::MatrixXd(u.asDiagonal())).squaredNorm();
}

}  // namespace

Signatures probe_candidates(Model& model, std::vector<Candidate> const& candidates, ResidualFrame const& frame,
                            Fit const& fit) {
  Signatures all{.columns = Eigen::MatrixXd::Zero(frame.size(), static_cast<Eigen::Index>(candidates.size())),
                 .noise = std::vector<double>(candidates.size()),
                 .not_testable = std::vector<std::string>(candidates.size())};
  std::size_t const calibration = frame.study().calibration.size();
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    Candidate const& candidate = candidates[k];
    auto const column = static_cast<Eigen::Index>(k);
    if (auto const place = std::ranges::find(fit.active, k); place != fit.active.end()) {
      all.columns.col(column) = fit.jacobian.col(static_cast<Eigen::Index>(calibration) + (place - fit.active.begin()));
      continue;
    }
    double const room = candidate.largest - fit.point.strengths[column];
    auto const at = [&](double scale) {
      return probed(model, frame, fit, k, std::min(scale * candidate.prior_scale, room), candidate.prior_scale);
    };
    Probe probe = at(1);
    if (!probe.answered) {
      probe = at(0.25);
    } else if (!(probe.column.norm() > least_change)) {
      probe = at(4);
    }
    if (!probe.answered) {
      all.not_testable[k] = "the model has no answer with it";
    } else if (!(probe.column.norm() > least_change)) {
      all.not_testable[k] = "it changes nothing under these conditions";
    } else {
      all.columns.col(column) = probe.column;
      all.noise[k] = sampling_noise(frame, fit, candidate);
    }
  }
  return all;
}

}  // namespace layerloop::validation
