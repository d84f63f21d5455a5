#include "validation/blind/separation.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

namespace layerloop::validation {
Separation::Separation(Study const& study, Model& model, std::vector<Candidate> const& candidates,
                       Eigen::VectorXd const& calibration, Effort effort)
    : study_(study), model_(model), candidates_(candidates), effort_(effort) {
  base_point_ = {calibration, Eigen::VectorXd::Zero(index(candidates.size()))};
  base_ = model.predict(base_point_);
  study_ = answered(study, base_);
  whiten_.emplace(covariance(study_, base_));
  // What is known of the calibration beforehand counts as one more reading each.
  auto const rows = index(study_.observations.size()), numbers = index(study.calibration.size());
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(rows + numbers, numbers);
  for (Eigen::Index k = 0; k < numbers; ++k) {
    ModelPoint stepped = base_point_;
    double const step = 0.2 * study.calibration[static_cast<std::size_t>(k)].sd;
    stepped.calibration[k] += step;
    slopes.col(k).head(rows) = (*whiten_)(at_observations(study_, model.predict(stepped).value - base_.value)) * 5;
    slopes(rows + k, k) = 1;
  }
  project_.emplace(rows + numbers, slopes);
}

Eigen::VectorXd Separation::projected(Eigen::VectorXd const& difference) const {
  auto const rows = index(study_.observations.size());
  Eigen::VectorXd all = Eigen::VectorXd::Zero(rows + index(study_.calibration.size()));
  all.head(rows) = (*whiten_)(at_observations(study_, difference));
  return (*project_)(all);
}

double Separation::visibility(Eigen::VectorXd const& difference) const { return projected(difference).norm(); }

Eigen::VectorXd Separation::change(std::size_t candidate, double strength) const {
  ModelPoint point = base_point_;
  point.strengths[index(candidate)] = strength;
  return projected(model_.predict(point).value - base_.value);
}

Separation::Nearest Separation::nearest(Eigen::VectorXd const& difference,
                                        std::vector<std::string> const& without) const {
  Eigen::VectorXd const wanted = projected(difference);
  std::vector<double> const probes =
      effort_ == Effort::free ? std::vector{-1.0, 0.5, 1.0, 2.0} : std::vector{-1.0, 1.0};
  Nearest best;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (std::ranges::find(without, candidates_[c].name) != without.end()) continue;
    for (double const factor : probes) {
      if (factor < 0 && !candidates_[c].two_sided) continue;
      Eigen::VectorXd const other = change(c, factor * candidates_[c].prior_scale);
      if (!other.allFinite()) continue;
      double const cosine = wanted.dot(other) / (wanted.norm() * other.norm());
      if (cosine > best.cosine) best = {candidates_[c].name, cosine};
    }
  }
  return best;
}

double Separation::equivalent_strength(std::string const& candidate, Eigen::VectorXd const& difference) const {
  auto const found = std::ranges::find(candidates_, candidate, &Candidate::name);
  if (found == candidates_.end()) return 0;
  Eigen::VectorXd const wanted = projected(difference);
  auto const which = static_cast<std::size_t>(found - candidates_.begin());
  double const low = found->two_sided ? -found->largest : 0;
  if (effort_ == Effort::dear) {  // along the secant, twice
    double strength = found->prior_scale;
    for (int step = 0; step < 2; ++step) {
      Eigen::VectorXd const own = change(which, strength);
      double const factor = wanted.dot(own) / own.squaredNorm();
      if (!std::isfinite(factor) || factor == 0) return 0;
      strength = std::clamp(strength * factor, low, found->largest);
    }
    return strength;
  }
  auto const distance = [&](double strength) {
    double const apart = (wanted - change(which, strength)).squaredNorm();
    return std::isfinite(apart) ? apart : 1e30;
  };
  return boost::math::tools::brent_find_minima(distance, low, found->largest, 24).first;
}

}  // namespace layerloop::validation
