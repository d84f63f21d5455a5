#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/case.hpp"

namespace layerloop::coupling {

/// The verbs of the program that compute one case.
enum class Verb { spread, calibrate, absorb, melt, run };

std::string const& name_of(Verb verb);
std::vector<std::string> const& verb_names();
std::optional<Verb> verb_named(std::string const& name);

/// The process of a case for a verb.
Process process_of(Verb verb);

/// Whether the verb spreads a bed that others may use too.
bool spreads_first(Verb verb, Case const& checked);

}  // namespace layerloop::coupling
