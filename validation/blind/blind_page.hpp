#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "validation/blind/score.hpp"

namespace layerloop::validation {

/// Scores an opened blind test into DIR/score.json, score.csv, score.md, scenarios.csv and report.html. \return the
/// table as text
std::string write_blind_report(std::filesystem::path const& folder);

/// The table for terminals: one line a score.
std::string text_of(std::vector<Score> const& scores);

}  // namespace layerloop::validation
