#pragma once
#include <Eigen/Core>
#include <vector>

#include "validation/error_model.hpp"
#include "validation/model.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// How a diagnosis looks at predictions: as whitened differences from the measurements, outliers taken out.
class ResidualFrame {
 public:
  /// \param at  prediction on whose values relative uncertainties rest
  ResidualFrame(Study const& study, Prediction const& at);

  /// Measured minus predicted. Not finite where the model has no answer.
  Eigen::VectorXd residual(Prediction const& prediction) const;
  /// Of one prediction from another: what a change of the model does.
  Eigen::VectorXd change(Prediction const& to, Prediction const& from) const;
  /// Trace of the covariance of such a change from grains and rays alone, where they are drawn anew.
  double sampling_variance(Prediction const& prediction) const;
  Whitening const& whiten() const { return whiten_; }

  /// Gives an observation a value of its own: what is left is as without it.
  void spare(std::size_t observation);
  std::vector<std::size_t> const& spared() const { return spared_; }
  /// Takes what was spared meanwhile out of vectors of this frame.
  Eigen::MatrixXd without_spared(Eigen::MatrixXd const& vectors) const { return others_(vectors); }

  Study const& study() const { return *study_; }
  Eigen::Index size() const { return measured_.size(); }

 private:
  Study const* study_;
  Eigen::VectorXd measured_;
  Whitening whiten_;
  std::vector<std::size_t> spared_;
  Projection others_;
};

}  // namespace layerloop::validation
