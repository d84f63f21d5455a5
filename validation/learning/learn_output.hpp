#pragma once
#include <filesystem>

#include "validation/learning/learn_results.hpp"

namespace layerloop::validation {

/// Adds what was learnt to the folder of the sweep: `learn` in summary.json, learn.csv, left_out.csv, surrogates.csv,
/// layer_models.csv, slices.csv and report.html; the page of the sweep becomes cases.html. Root rank only. \throws
/// FileError
void write_learning(LearnStudy const& study, LearnResults const& results, std::filesystem::path const& folder);

}  // namespace layerloop::validation
