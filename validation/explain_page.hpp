#pragma once
#include <string>

#include "validation/explanation.hpp"

namespace layerloop::validation {

/// report.html of the verb explain: the verdict, what it rests on, and what to measure next.
std::string explain_page(Explanation const& explained);

/// report.html of the verb next.
std::string next_page(Explanation const& explained);

}  // namespace layerloop::validation
