#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "validation/blind/world.hpp"
#include "validation/candidate.hpp"
#include "validation/error_model.hpp"
#include "validation/model.hpp"

namespace layerloop::validation {

/// How visible a difference of predictions is in a study, when calibration may swallow what it can: the noncentrality
/// that a test for it has, and which candidates look the same. For drawing and sorting scenarios, not for analysing
/// them. Where predictions are dear, fewer strengths are probed.
class Separation {
 public:
  Separation(Study const& study, Model& model, std::vector<Candidate> const& candidates,
             Eigen::VectorXd const& calibration, Effort effort);
  /// lambda: length of the difference [SI, by observable] in units of its standard deviation.
  double visibility(Eigen::VectorXd const& difference) const;

  struct Nearest {
    std::string name;
    double cosine = 0;  ///< largest of all candidates but `self` and over probes of their strength
  };
  Nearest nearest(Eigen::VectorXd const& difference, std::vector<std::string> const& without) const;

  /// Strength at which a candidate comes closest to a difference: what an analysis should find.
  double equivalent_strength(std::string const& candidate, Eigen::VectorXd const& difference) const;

 private:
  Eigen::VectorXd projected(Eigen::VectorXd const& difference) const;
  Eigen::VectorXd change(std::size_t candidate, double strength) const;

  Study study_;  ///< what the model has an answer for
  Model& model_;
  std::vector<Candidate> const& candidates_;
  Effort effort_;
  ModelPoint base_point_;
  Prediction base_;
  std::optional<Whitening> whiten_;
  std::optional<Projection> project_;
};

}  // namespace layerloop::validation
