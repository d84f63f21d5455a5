#pragma once
#include <string>
#include <vector>

#include "validation/study.hpp"

namespace layerloop::validation {

/// A measurement that would tell rival explanations apart.
struct NextExperiment {
  Condition condition;
  std::string quantity;                    ///< the one in which the rivals differ most
  std::vector<Condition> also_at = {};     ///< conditions under which the same is read as well
  std::vector<std::string> together = {};  ///< quantities that are read beside it
  int replicates = 1;                      ///< of each, with which the right one leads in 95 of 100 studies
  double separation = 0;                   ///< squared distance that stays between the rivals with one reading of each
  double difference = 0, u = 0;  ///< of the rivals in `quantity`, and what a reading of it is uncertain by [SI]
  std::vector<std::string> separates = {};  ///< candidates; of UNKNOWN: the pattern that it would sharpen
  bool simulated = false;                   ///< by true runs of the model, else by its surrogate
};

}  // namespace layerloop::validation
