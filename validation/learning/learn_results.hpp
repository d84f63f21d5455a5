#pragma once
#include <string>
#include <vector>

#include "validation/learning/learn_study.hpp"

namespace layerloop::validation {

/// A surrogate of one output over the keys, each place predicted from the others.
struct OutputSkill {
  coupling::ShownQuantity output;
  Skill skill;          ///< SI
  double noise_sd = 0;  ///< of one run [SI]
};

/// What was known after so many cases.
struct Believed {
  std::size_t cases = 0, points = 0;
  double best = 0;   ///< best value of a run so far
  Estimate optimum;  ///< best value of the surrogate
};

/// The surrogate along one key through the optimum.
struct Slice {
  std::vector<double> x, mean, sd;
};

/// What the runs of a study say. All in SI.
struct LearnResults {
  Optimum optimum;
  std::vector<std::size_t> used;  ///< cases that gave the output
  Eigen::VectorXd values;         ///< of these
  LeftOut left_out;
  std::vector<OutputSkill> surrogates;   ///< the output that was looked for is the first
  std::vector<LayerSkill> layer_models;  ///< of runs with several layers
  std::vector<Believed> history;         ///< from the end of the start design on
  std::vector<Slice> slices;             ///< by key
};

LearnResults results_of(LearnStudy const& study);

}  // namespace layerloop::validation
