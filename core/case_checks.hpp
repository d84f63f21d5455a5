#pragma once
#include <functional>
#include <string>

#include "core/case.hpp"

namespace layerloop {

/// What the check of a whole case needs to know about the text it came from.
struct CaseOrigin {
  std::function<bool(std::string const& key)> sound;  ///< "scan.dwell" has a value that passed its own row
  std::function<void(std::string const& key, std::string const& message)> report;
};

/// Holds values against one another: does the beam stay on the bed, does the powder reach the blade, is the time step
/// stable, ... A check is left out when a value it needs is already known to be wrong.
void check_case(Case const& c, CaseOrigin const& origin);

}  // namespace layerloop
