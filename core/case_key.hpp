#pragma once
#include <string>
#include <vector>

#include "core/case_schema.hpp"

// Keys of the case file by their full names, as studies and sweeps name them: "laser.power".
namespace layerloop {

/// The row of a key; null when there is none.
CaseKey const* case_key(std::string const& name);

bool takes_number(CaseKey const& row);

/// `; did you mean "laser.power"?` for a name that no key has; also for "power" alone.
std::string likely_case_key(std::string const& name, std::vector<std::string> const& others = {});

}  // namespace layerloop
