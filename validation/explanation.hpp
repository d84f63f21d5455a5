#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "validation/candidates.hpp"
#include "validation/diagnosis.hpp"
#include "validation/next_experiment.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// A diagnosis with all that it rests on, for files, pages and the terminal.
struct Explanation {
  Study study;  ///< with the observations that the diagnosis speaks of, in its order
  std::vector<Candidate> candidates;
  Diagnosis found;
  Thresholds thresholds;
  std::uint64_t seed = 0;
  std::vector<NextExperiment> next = {};
  std::map<std::string, std::string> sha256 = {};  ///< file of the study -> digest
  double wall_time = 0;                            ///< [s]
};

/// Diagnoses and keeps what the diagnosis speaks of: readings that the model has no answer for are left out.
/// \param untestable  effects that this study cannot judge, with the reason
Explanation explain(Study study, Model& model, std::vector<Candidate> candidates,
                    std::vector<Untestable> const& untestable, Thresholds const& thresholds, std::uint64_t seed);

}  // namespace layerloop::validation
