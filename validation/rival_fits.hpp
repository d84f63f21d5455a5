#pragma once
#include <string>
#include <vector>

#include "validation/explanation.hpp"
#include "validation/next_search.hpp"
#include "validation/refit.hpp"

namespace layerloop::validation {

/// The best explanation and those that the data cannot tell from it, each refitted to them.
struct RivalFits {
  std::vector<std::string> names;  ///< the best one first
  std::vector<Fit> fits;
};
RivalFits fit_rivals(Explanation const& explained, Model& model, ResidualFrame const& frame);

/// Predictions of one quantity under some conditions, and what they rest on. Shapes: by condition.
struct RivalPredictions {
  std::vector<Eigen::VectorXd> value;       ///< by rival
  std::vector<Eigen::MatrixXd> derivative;  ///< by rival: (conditions, free numbers), for one prior scale
};

/// Every quantity under the conditions of a study. \param sensitive  also the derivatives
std::map<std::string, RivalPredictions> predict_rivals(Study const& conditions_of,
                                                       std::vector<std::string> const& quantities,
                                                       std::vector<Candidate> const& candidates,
                                                       RivalFits const& rivals, ModelOf const& model_of,
                                                       bool sensitive);

/// Squared distance that stays between two rivals when one of them is refitted to the other's predictions, with new
/// readings among the data. All in standard deviations. Shapes: (old), (old, free), (new), (new, free)
double separation(Eigen::VectorXd const& difference, Eigen::MatrixXd const& derivatives,
                  Eigen::VectorXd const& new_difference, Eigen::MatrixXd const& new_derivatives);

}  // namespace layerloop::validation
