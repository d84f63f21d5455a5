#include "validation/error_model.hpp"

#include <cmath>
#include <map>

#include "core/error.hpp"

namespace layerloop::validation {
Eigen::VectorXd at_observations(Study const& study, Eigen::VectorXd const& by_observable) {
  Eigen::VectorXd all(index(study.observations.size()));
  for (Eigen::Index i = 0; i < all.size(); ++i)
    all[i] = by_observable[index(study.observations[static_cast<std::size_t>(i)].observable)];
  return all;
}

Eigen::VectorXd measured_values(Study const& study) {
  Eigen::VectorXd all(index(study.observations.size()));
  for (Eigen::Index i = 0; i < all.size(); ++i) all[i] = study.observations[static_cast<std::size_t>(i)].value;
  return all;
}

Eigen::VectorXd prior_means(Study const& study) {
  Eigen::VectorXd means(static_cast<Eigen::Index>(study.calibration.size()));
  for (Eigen::Index p = 0; p < means.size(); ++p) means[p] = study.calibration[static_cast<std::size_t>(p)].mean;
  return means;
}

bool is_answered(Observation const& seen, Prediction const& prediction) {
  return std::isfinite(prediction.value[index(seen.observable)]);
}

Study answered(Study study, Prediction const& prediction) {
  std::erase_if(study.observations, [&](Observation const& seen) { return !is_answered(seen, prediction); });
  return study;
}

Eigen::MatrixXd covariance(Study const& study, Prediction const& prediction) {
  Eigen::Index const n = index(study.observations.size());
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  std::map<std::size_t, std::vector<Eigen::Index>> sharing;  // by observable
  std::map<std::string, Eigen::VectorXd> systematic;         // by sys_group
  std::map<std::string, std::vector<Eigen::Index>> of_quantity;
  Eigen::VectorXd const mesh = at_observations(study, prediction.u_numerical);
  for (Eigen::Index i = 0; i < n; ++i) {
    Observation const& seen = study.observations[static_cast<std::size_t>(i)];
    c(i, i) += seen.u_stat * seen.u_stat;
    sharing[seen.observable].push_back(i);
    of_quantity[seen.quantity].push_back(i);
    double const model = prediction.value[index(seen.observable)];
    double const shift = std::hypot(seen.u_sys_rel * model, seen.u_sys_abs);
    if (shift == 0) continue;
    if (seen.sys_group.empty()) {
      c(i, i) += shift * shift;
      continue;
    }
    auto const group = systematic.try_emplace(seen.sys_group, Eigen::VectorXd::Zero(n)).first;
    group->second[i] = shift;
  }
  for (auto const& [observable, rows] : sharing) {
    double const variance = std::pow(prediction.u_sampling[index(observable)], 2);
    for (Eigen::Index const a : rows)
      for (Eigen::Index const b : rows) c(a, b) += variance;
  }
  for (auto const& [quantity, rows] : of_quantity) {
    for (Eigen::Index const a : rows)
      for (Eigen::Index const b : rows) c(a, b) += mesh[a] * mesh[b];
  }
  for (auto const& [name, shift] : systematic) c += shift * shift.transpose();
  return c;
}

Whitening::Whitening(Eigen::MatrixXd const& covariance) : factor_(covariance) {
  if (factor_.info() != Eigen::Success)
    throw InputError(
        "the uncertainties of the measurements leave no scatter (their covariance is singular) give every row a u_stat "
        "above zero");
}

Eigen::MatrixXd Whitening::operator()(Eigen::MatrixXd const& differences) const {
  return factor_.matrixL().solve(differences);
}

Eigen::MatrixXd Whitening::inverse(Eigen::MatrixXd const& whitened) const { return factor_.matrixL() * whitened; }

Projection::Projection(Eigen::Index rows, Eigen::MatrixXd const& columns) : basis_(rows, 0) {
  if (columns.cols() == 0) return;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(1e-9);
  basis_ = Eigen::MatrixXd(qr.householderQ() * Eigen::MatrixXd::Identity(rows, qr.rank()));
}

Eigen::MatrixXd Projection::operator()(Eigen::MatrixXd const& vectors) const {
  return vectors - basis_ * (basis_.transpose() * vectors);
}

Eigen::VectorXd Projection::diagonal() const {
  return Eigen::VectorXd::Ones(basis_.rows()) - basis_.rowwise().squaredNorm();
}

Eigen::MatrixXd beside(Eigen::MatrixXd const& a, Eigen::MatrixXd const& b) {
  Eigen::MatrixXd both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

}  // namespace layerloop::validation
