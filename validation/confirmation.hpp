#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "validation/before_after.hpp"

namespace layerloop::validation {

/// How well measurements that nobody used are predicted.
struct HeldOutError {
  std::size_t readings = 0;
  double rms_before = 0, rms_after = 0;        ///< of (measured - model) / measured
  double inside_before = 0, inside_after = 0;  ///< share within two standard uncertainties
};

struct Confirmation {
  BeforeAfter train;
  Study study;             ///< the holdout
  ObservationTable table;  ///< of the holdout
  HeldOutError all;
  std::map<std::string, HeldOutError> quantities;
  double whitened_rms_before = 0, whitened_rms_after = 0;  ///< with what calibration leaves uncertain; 1: noise alone
  /// Mean over the conditions of what the effect takes off the squared residual of a reading, in variances, and its
  /// 95 % interval by a bootstrap of whole conditions (Efron & Tibshirani, An Introduction to the Bootstrap,
  /// 1993, 8.3).
  double gain = 0;
  std::array<double, 2> ci95{};
  std::size_t conditions = 0;
  bool confirmed = false;  ///< above 0, over at least three conditions, and the training data want the effect
};

/// Calibrates without and with the effects on the training data, then looks at the holdout with both.
/// \param train_model, holdout_model  of the two studies, with the same candidates
Confirmation confirm(Study const& train, Model& train_model, Study const& holdout, Model& holdout_model,
                     std::vector<Candidate> const& candidates, Addition const& addition, std::uint64_t seed);

/// Mean of paired gains by condition, and its 95 % interval.
struct PairedGain {
  double mean = 0;
  std::array<double, 2> ci95{};
};
PairedGain paired_gain(std::vector<double> const& by_condition, std::uint64_t seed);

}  // namespace layerloop::validation
