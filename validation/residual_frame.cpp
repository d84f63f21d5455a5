#include "validation/residual_frame.hpp"

namespace layerloop::validation {

ResidualFrame::ResidualFrame(Study const& study, Prediction const& at)
    : study_(&study),
      measured_(measured_values(study)),
      whiten_(covariance(study, at)),
      others_(measured_.size(), Eigen::MatrixXd(measured_.size(), 0)) {}

Eigen::VectorXd ResidualFrame::residual(Prediction const& prediction) const {
  return others_(whiten_(measured_ - at_observations(*study_, prediction.value)));
}

Eigen::VectorXd ResidualFrame::change(Prediction const& to, Prediction const& from) const {
  return others_(whiten_(at_observations(*study_, to.value - from.value)));
}

double ResidualFrame::sampling_variance(Prediction const& prediction) const {
  if (prediction.u_sampling.isZero(0)) return 0;
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(size(), prediction.u_sampling.size());  // replicates share theirs
  for (Eigen::Index i = 0; i < size(); ++i) {
    Eigen::Index const o = index(study_->observations[static_cast<std::size_t>(i)].observable);
    scatter(i, o) = prediction.u_sampling[o];
  }
  return 2 * others_(whiten_(scatter)).squaredNorm();
}

void ResidualFrame::spare(std::size_t observation) {
  spared_.push_back(observation);
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(size(), static_cast<Eigen::Index>(spared_.size()));
  for (std::size_t k = 0; k < spared_.size(); ++k)
    units(static_cast<Eigen::Index>(spared_[k]), static_cast<Eigen::Index>(k)) = 1;
  others_ = Projection(size(), whiten_(units));
}

}  // namespace layerloop::validation
