#pragma once
#include <Eigen/Core>
#include <vector>

#include "validation/candidate.hpp"
#include "validation/model.hpp"
#include "validation/residual_frame.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// The model at a point, seen through a frame. Free numbers are the calibration parameters, then the strengths of the
/// active candidates, each counted in its prior scale from its prior mean.
struct Fit {
  ModelPoint point;
  std::vector<std::size_t> active;  ///< candidates whose strength is free
  Prediction prediction;
  Eigen::VectorXd residual;  ///< whitened
  Eigen::MatrixXd jacobian;  ///< (observations, free numbers) whitened change of the prediction for one prior scale
  double objective = 0;      ///< |residual|^2 / sigma^2 + |distance from the prior means|^2 / 9 of calibration
  bool converged = false;    ///< no step is left that would gain anything
};

/// Whether a calibration number stands as far from what was believed of it as it may.
bool stands_at_bound(CalibrationParameter const& number, double value);

/// Columns of a fit's Jacobian without calibration numbers that stand as far from what was believed as they may: these
/// can explain nothing more.
std::vector<Eigen::Index> movable_columns(Study const& study, Fit const& fit);

/// Least squares on true runs of the model: Levenberg-Marquardt with Broyden's update of the Jacobian, so that an
/// iteration costs one pass over the data (More, in: Numerical Analysis, LNM 630 (1978); Broyden, Math. Comp. 19 (1965)
/// 577). Calibration is held by thrice its prior scale only: claims rest on what it cannot do at all, and a prior that
/// is too narrow must not look like physics.
class Refit {
 public:
  Refit(Model& model, std::vector<Candidate> const& candidates, ResidualFrame const& frame, double sigma2)
      : model_(model), candidates_(candidates), frame_(frame), sigma2_(sigma2) {}

  /// The model where it stands, with its Jacobian by differences.
  Fit at(ModelPoint point, std::vector<std::size_t> active) const;
  /// The same without active candidates, where its prediction is known already.
  Fit from(ModelPoint point, Prediction prediction) const;
  /// From a fit with a candidate more, whose change for one prior scale is known.
  Fit with(Fit const& fit, std::size_t candidate, Eigen::VectorXd const& change) const;
  /// The same without an active candidate, not refitted. \param active  index into Fit::active
  Fit without(Fit fit, std::size_t active) const;
  /// To the least objective.
  Fit improved(Fit fit) const;
  /// The same with a Jacobian by differences at the end, and on from there while that still gains.
  Fit settled(Fit fit) const;
  /// Standard uncertainties of the free numbers from the data alone, in prior scales.
  Eigen::VectorXd uncertainty(Fit const& fit) const;

 private:
  double scale(Fit const& fit, Eigen::Index k) const;
  Eigen::VectorXd distance(Fit const& fit) const;  ///< of the free numbers from their prior means
  Fit moved(Fit const& fit, Eigen::VectorXd const& step) const;
  void evaluate(Fit& fit) const;
  void weigh(Fit& fit) const;  ///< its prediction
  Eigen::VectorXd within_bounds(Fit const& fit, Eigen::VectorXd step) const;
  Eigen::MatrixXd differences(Fit const& fit) const;

  Model& model_;
  std::vector<Candidate> const& candidates_;
  ResidualFrame const& frame_;
  double sigma2_;
};

}  // namespace layerloop::validation
