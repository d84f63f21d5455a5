#pragma once
#include <filesystem>

#include "validation/study.hpp"

namespace layerloop::validation {

/// Reads and checks a study folder; holdout rows are refused to everything but a confirmation.
/// \param folder  holds study.toml, or is that file
/// \throws InputError with every fault of all its files at once, one a line: "measurements.csv:7:3: ..."; FileError
Study read_study(std::filesystem::path const& folder, Role which = Role::train);

}  // namespace layerloop::validation
