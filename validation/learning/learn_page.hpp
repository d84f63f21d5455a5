#pragma once
#include <string>

#include "validation/learning/learn_results.hpp"

namespace layerloop::validation {

/// report.html of the verb learn: the optimum with its intervals, what was found run by run, the surrogate along every
/// key, and how well it predicts what it has not seen.
std::string learn_page(LearnStudy const& study, LearnResults const& results);

}  // namespace layerloop::validation
