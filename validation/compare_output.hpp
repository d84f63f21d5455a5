#pragma once
#include <filesystem>
#include <string>

#include "validation/comparison.hpp"

namespace layerloop::validation {

/// report.html, one page that needs no network.
std::string compare_page(Comparison const& compared);

/// Writes summary.json, residuals.csv, quantities.csv, patterns.csv and report.html; makes the folder when missing.
/// \throws FileError
void write_comparison(std::filesystem::path const& folder, Comparison const& compared);

/// The answer on one screen.
std::string comparison_in_words(Comparison const& compared);

std::string const& name_of(EffectStage stage);

}  // namespace layerloop::validation
