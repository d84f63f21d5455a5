#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "validation/study.hpp"
#include "validation/truth/hidden_cause.hpp"

namespace layerloop::validation {

std::vector<ForeignCause> const& foreign_causes();

/// Values of a study's observables as the world has them [SI]. The base is that of the analytic chain, with the pool by
/// direct quadrature; every cause has another functional form than the catalogue's: other exponents, other saturation,
/// other thresholds.
/// \param calibration  true values by Study::calibration
/// \throws std::invalid_argument  a cause or key that the world does not know: a bug
Eigen::VectorXd true_values(Study const& study, Eigen::VectorXd const& calibration,
                            std::vector<HiddenCause> const& causes);

}  // namespace layerloop::validation
