#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/case.hpp"

namespace layerloop {

/// Reads and checks a case for a process: what it has no use for need not be there. Without a process, a case with a
/// table [laser] is one for melting, any other for spreading. `overrides` are "table.key=value" (the --set options),
/// applied after the file. \throws InputError with every fault of the file at once, one a line: "case.toml:12:1:
/// unknown key "powr" in [laser]; did you mean "power"?" \throws FileError  cannot be opened
Case read_case(std::filesystem::path const& path, std::vector<std::string> const& overrides,
               std::optional<Process> process = Process::melting);

/// The same of a text; `path` names it in messages, and files that it names are looked for beside it.
Case case_of_text(std::string const& text, std::filesystem::path const& path, std::vector<std::string> const& overrides,
                  std::optional<Process> process);

/// The case as TOML with every key, in SI, defaults filled in: reading it again gives the same case.
std::string resolved_toml(Case const& checked);

/// Markdown table of every key: unit, range, default, sentence (docs/case-keys.md, `check --help-case`).
std::string case_key_page();

}  // namespace layerloop
