#pragma once
#include <optional>
#include <string>

#include "core/case_schema.hpp"
#include "core/toml_entries.hpp"

namespace layerloop {

/// Checks a value against its row (type, unit, range) and puts it into the case. \throws InputError
void store(CaseKey const& row, TomlValue const& value, Case& into);

/// The value that a case holds, in SI as TOML; nothing for an optional key that is not set.
std::optional<std::string> stored(CaseKey const& row, Case const& from);

/// Printable ASCII text as TOML.
std::string toml_text(std::string_view text);

}  // namespace layerloop
