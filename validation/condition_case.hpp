#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "validation/quantity.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// The case of a study under each of its conditions.
class ConditionCases {
 public:
  explicit ConditionCases(Study const& study);

  /// What a condition and the calibration numbers set, as --set options. \param calibration  by Study::calibration
  std::vector<std::string> settings(std::size_t condition, Eigen::VectorXd const& calibration) const;

  /// \throws InputError
  Case make(std::vector<std::string> const& settings, Verb verb) const;

  /// Whether the case has a scan: its light is then traced along it.
  bool scans() const { return scans_; }

 private:
  Study const& study_;
  std::string text_;
  bool scans_;
};

/// `key=value` with every digit of the value [SI].
std::string setting(std::string const& key, double value);

/// Cells and plate of a bare-plate condition, chosen once, so that every point of the model has the same mesh: where
/// the case leaves them open, cells of an eighth of the spot, at most a third of the estimated depth, and a plate
/// three times as deep as the deepest of these pools. \param others  cases that must fit on the same plate
std::vector<std::string> mesh_settings(Case const& base, std::vector<Case> const& others);

}  // namespace layerloop::validation
