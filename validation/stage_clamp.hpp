#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "validation/comparison.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// A study in which the measured absorptivity of a condition takes the place of what the light stage would say, so that
/// what is left of the pools' misfit belongs to the heat stage.
struct ClampedStudy {
  Study study;                     ///< the pools alone
  Study shifted;                   ///< the same with every absorptivity one standard uncertainty higher
  std::vector<Eigen::Index> rows;  ///< their observations in the study that it comes from
};

/// Nothing where no condition has both absorptivity and pool.
std::optional<ClampedStudy> with_measured_absorptivity(Study const& study);

struct ClampedResult {
  std::vector<Eigen::Index> rows;  ///< of these, those that have an answer
  double chi2 = 0;
  double chi2_simulated = 0;  ///< of the values as simulated, with the same uncertainties
  double passes = 0;
};
/// What calibration numbers and the measured absorptivity are uncertain by counts as uncertainty.
/// \param simulated  by observation of the study that it comes from
ClampedResult run_clamped(ClampedStudy const& clamped, Eigen::VectorXd const& simulated, ModelMaker const& make);

/// Which stage is at fault, from chi2 as simulated and clamped.
std::string words_of_clamp(double simulated, double clamped, std::size_t points);

}  // namespace layerloop::validation
