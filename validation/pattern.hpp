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
  Eigen::MatrixXd columns;         ///< (observations, patterns), whitened
};
Patterns generic_patterns(Study const& study, Eigen::VectorXd const& predicted, Whitening const& whiten);

/// What a label could do on its own: an offset of every quantity for each of its levels, whitened. Empty with one
/// level.
Eigen::MatrixXd label_columns(Study const& study, std::string const& label, Eigen::VectorXd const& predicted,
                              Whitening const& whiten);

/// Looks for patterns in what calibration cannot do.
class PatternSearch {
 public:
  PatternSearch(Patterns const& patterns, Projection const& projection, std::uint64_t seed);
  /// Strongest first, with p over the whole family.
  /// \param residual  whitened and projected, measured minus predicted \param scale  sigma: residuals are divided by it
  std::vector<PatternFinding> find(Eigen::VectorXd const& residual, double scale, std::size_t most = 20) const;
  double critical(double family_error) const { return null_.critical(family_error); }
  Eigen::MatrixXd const& unit_directions() const { return unit_; }  ///< (observations, patterns that are left)

 private:
  Eigen::MatrixXd unit_;
  std::vector<std::string> texts_;
  LargestNull null_;
};

}  // namespace layerloop::validation
