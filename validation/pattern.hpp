#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "validation/diagnosis.hpp"
#include "validation/error_model.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// Directions in which residuals may show structure, with no physics in them: for every quantity and for all together,
/// over every input of the conditions (line, products of two), every label, place, layer, and order of acquisition.
struct Patterns {
  std::vector<std::string> texts;
  Eigen::MatrixXd columns;  ///< (observations, patterns), whitened
};
Patterns generic_patterns(Study const& study, Eigen::VectorXd const& predicted, Whitening const& whiten);

/// z of every pattern in projected residuals, strongest first, p over the family by the largest |z| of draws of the
/// null. \param scale  sigma: residuals are divided by it
std::vector<PatternFinding> find_patterns(Patterns const& patterns, Eigen::VectorXd const& residual,
                                          Projection const& projection, double scale, std::uint64_t seed,
                                          std::size_t most = 20);

}  // namespace layerloop::validation
