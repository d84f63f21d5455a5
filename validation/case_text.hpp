#pragma once
#include <string>
#include <vector>

namespace layerloop::validation {

/// A case file with keys set, everything else left as its author wrote it: a key that stands there gets its new value
/// in its line, a new one goes to the end of its table, a new table to the end of the file. \param settings
/// "effects.keyhole.strength=0.31" \param comment  behind every line that changes; empty: none \throws InputError  a
/// key shares its line with others, or its value goes over several
std::string with_settings(std::string text, std::vector<std::string> const& settings, std::string const& comment);

}  // namespace layerloop::validation
