#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "validation/study.hpp"

namespace layerloop::validation {

/// What the world does and the model may lack.
struct HiddenCause {
  std::string name;
  double strength = 0;
  double from = 0;         ///< of a jump: share of the conditions that come before it
  std::string label = {};  ///< of a biased input: the machine that it is of; empty: all
};

/// A cause that no catalogue holds, and what a diagnosis may rightly say of it.
struct ForeignCause {
  std::string name;
  double largest;                       ///< strength
  std::vector<std::string> variables;   ///< one of which the pattern must run over
  std::vector<std::string> quantities;  ///< one of which it must be seen in
};
std::vector<ForeignCause> const& foreign_causes();

/// Values of a study's observables as the world has them [SI]. The base is that of the analytic chain, with the pool by
/// direct quadrature; every cause has another functional form than the catalogue's: other exponents, other saturation,
/// other thresholds.
/// \param calibration  true values by Study::calibration
/// \throws std::invalid_argument  a cause or key that the world does not know: a bug
Eigen::VectorXd true_values(Study const& study, Eigen::VectorXd const& calibration,
                            std::vector<HiddenCause> const& causes);

}  // namespace layerloop::validation
