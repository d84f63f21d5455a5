#pragma once
#include <filesystem>
#include <string>

#include "validation/confirmation.hpp"
#include "validation/explain_output.hpp"

namespace layerloop::validation {

/// The answer of `add` on one screen.
std::string addition_in_words(BeforeAfter const& both, std::filesystem::path const& case_file);

/// summary.json, report.html and the tables behind it: the model before and after on the data it was calibrated on.
/// \throws FileError
void write_addition(std::filesystem::path const& folder, BeforeAfter const& both);

/// What is left of a verdict after the look at the holdout.
std::string verdict_after(std::string const& verdict, Confirmation const& found);

/// The answer of `confirm` on one screen. \param looks  at this holdout, with this one
std::string confirmation_in_words(Confirmation const& found, ReadExplanation const& explained, std::size_t looks);

/// summary.json, report.html and the tables behind it. \throws FileError
void write_confirmation(std::filesystem::path const& folder, Confirmation const& found,
                        ReadExplanation const& explained, std::size_t looks);

/// Writes the verdict that is left into the summary of the explanation. \throws FileError
void downgrade(std::filesystem::path const& explain_summary, Confirmation const& found,
               ReadExplanation const& explained);

}  // namespace layerloop::validation
