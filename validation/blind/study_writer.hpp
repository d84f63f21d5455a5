#pragma once
#include <filesystem>
#include <string>

#include "validation/study.hpp"

namespace layerloop::validation {

/// Writes a study as a folder that read_study reads back to the last bit, in SI. Numbers that are calibrated with a
/// relative error become u() columns.
/// \param case_text  the case file that belongs to it
void write_study(Study const& study, std::string const& case_text, std::filesystem::path const& folder);

}  // namespace layerloop::validation
