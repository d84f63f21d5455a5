#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "validation/diagnosis.hpp"
#include "validation/error_model.hpp"
#include "validation/largest_null.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// Directions in which residuals may show structure, with no physics in them: for every quantity and for all together,
/// throughout, over every input of the conditions (line, square, products), every label, place, layer, and order of
/// acquisition (drift, jumps), each as a share of the predicted value.
struct Patterns {
  std::vector<std::string> texts;  ///< "pool.depth: over laser.power"
  std::vector<bool> smooth;        ///< of one quantity over inputs and places: what physics may look like
  Eigen::MatrixXd columns;         ///< (observations, patterns), whitened
};
Patterns generic_patterns(Study const& study, Eigen::VectorXd const& predicted, Whitening const& whiten);

/// A change that has no physics in it: an offset of each quantity from a condition on, or for one level of a label.
struct Jump {
  std::string words;        ///< "lot B", "condition 17 on"
  std::string label;        ///< "lot"; "order of acquisition"
  Eigen::MatrixXd columns;  ///< (observations, quantities), whitened
};
/// For every level of every label, and for every place in the order of acquisition.
std::vector<Jump> jumps_of(Study const& study, Eigen::VectorXd const& predicted, Whitening const& whiten);
inline constexpr char const* order_of_acquisition = "order of acquisition";

/// Looks for patterns in what calibration cannot do.
class PatternSearch {
 public:
  PatternSearch(Patterns const& patterns, Projection const& projection, std::uint64_t seed);
  /// With the levels of another projection of the same patterns: a few columns more change them little.
  PatternSearch(Patterns const& patterns, Projection const& projection, LargestNull null);
  /// Strongest first, with p over the whole family.
  /// \param residual  whitened and projected, measured minus predicted \param scale  sigma: residuals are divided by it
  std::vector<PatternFinding> find(Eigen::VectorXd const& residual, double scale, std::size_t most = 20) const;
  /// The sum of squares is taken for a gamma variable (Satterthwaite, Biometrics Bull. 2 (1946) 110).
  Structure structure(Eigen::VectorXd const& residual, double scale) const;
  double critical(double family_error) const { return null_.critical(family_error); }
  LargestNull const& null() const { return null_; }

 private:
  Eigen::MatrixXd unit_;
  std::vector<std::string> texts_;
  std::vector<Eigen::Index> smooth_;  ///< columns
  LargestNull null_;
};

}  // namespace layerloop::validation
