#pragma once
#include <string>
#include <vector>

#include "validation/study.hpp"

namespace layerloop::validation {

/// A measurement that would tell rival explanations apart.
struct NextExperiment {
  Condition condition;
  std::string quantity;
  int replicates = 1;            ///< that separate them in 95 of 100 studies
  double separation = 0;         ///< squared difference of the rivals' predictions over its variance, one reading
  double difference = 0, u = 0;  ///< the same difference, and what a reading is uncertain by [SI]
  std::vector<std::string> separates = {};  ///< candidates; of UNKNOWN: the pattern that it would sharpen
  bool simulated = false;                   ///< by true runs of the model, else by its surrogate
};

}  // namespace layerloop::validation
