#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "validation/blind/score.hpp"

namespace layerloop::validation {

/// Scores opened blind tests together into OUT/score.json, score.csv, score.md, scenarios.csv and report.html. Other
/// methods are compared where all tests have the same. \return the table as text
std::string write_blind_report(std::vector<std::filesystem::path> const& folders, std::filesystem::path const& out);

/// The table for terminals: one line a score.
std::string text_of(std::vector<Score> const& scores);

}  // namespace layerloop::validation
