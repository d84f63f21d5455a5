#pragma once
#include <Eigen/Dense>

#include "validation/model.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// Prediction of every observation, from that of the observables.
Eigen::VectorXd at_observations(Study const& study, Eigen::VectorXd const& by_observable);
Eigen::VectorXd measured_values(Study const& study);
/// Of the calibration numbers: the values that were believed beforehand.
Eigen::VectorXd prior_means(Study const& study);
/// Whether the model has an answer for an observation; none where nothing melts, or a guard stopped it.
bool is_answered(Observation const& seen, Prediction const& prediction);
/// The study without the observations that it has none for.
Study answered(Study study, Prediction const& prediction);

/// Covariance of measured minus predicted [SI]: readings independent, a sys_group fully correlated (its relative part
/// on the model's value, so that multiplicative errors do not drag a fit low: d'Agostini, Nucl. Instrum. Methods A 346
/// (1994) 306), replicates sharing the sampling error of their prediction, all readings of a quantity its mesh error,
/// which has one sign.
Eigen::MatrixXd covariance(Study const& study, Prediction const& prediction);

/// Brings differences to unit, independent variance: L^-1 d with C = L L^T.
class Whitening {
 public:
  explicit Whitening(Eigen::MatrixXd const& covariance);
  Eigen::MatrixXd operator()(Eigen::MatrixXd const& differences) const;
  Eigen::MatrixXd inverse(Eigen::MatrixXd const& whitened) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// Takes out of whitened vectors what the columns of J can do: P = 1 - Q Q^T with J = Q R.
class Projection {
 public:
  Projection(Eigen::Index rows, Eigen::MatrixXd const& columns);
  Eigen::MatrixXd operator()(Eigen::MatrixXd const& vectors) const;
  Eigen::Index rank() const { return basis_.cols(); }
  Eigen::VectorXd diagonal() const;  ///< of P

 private:
  Eigen::MatrixXd basis_;
};

/// The columns of both.
Eigen::MatrixXd beside(Eigen::MatrixXd const& a, Eigen::MatrixXd const& b);

}  // namespace layerloop::validation
