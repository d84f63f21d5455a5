#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "validation/before_after.hpp"
#include "validation/explanation.hpp"

namespace layerloop::validation {

/// "pool.depth at laser.power = 200 W: 4 readings tell keyhole and evaporation apart"
std::string proposal_in_words(NextExperiment const& next);
/// "pool.width and pool.depth".
std::string measured_in_words(NextExperiment const& next);
/// "laser.power = 200 W and at laser.power = 90 W".
std::string places_in_words(NextExperiment const& next);

/// The answer on one screen: the verdict first, what to measure next last.
std::string answer_in_words(Explanation const& explained);

/// summary.json; `effects` are those of the verdict, `candidates` all that were tried.
nlohmann::json explain_summary(Explanation const& explained);

/// summary.json, report.html and the tables behind its pictures. \throws FileError
void write_explanation(std::filesystem::path const& folder, Explanation const& explained);

/// Why there is no proposal.
std::string nothing_to_separate(Explanation const& explained);

/// summary.json, report.html and next.csv of the verb next. \throws FileError
void write_proposals(std::filesystem::path const& folder, Explanation const& explained);

/// An explanation that was written, for the verbs that build on it.
struct ReadExplanation {
  std::string verdict, sentence;
  Addition addition;
  std::vector<std::vector<std::string>> groups;  ///< by effect: candidates that the data could not tell from it
  std::string pattern;                           ///< that is left over, in words
};
/// \param summary  summary.json, or the folder that holds it \throws InputError  it is not one of `explain`; FileError
ReadExplanation read_explanation(std::filesystem::path const& summary);

}  // namespace layerloop::validation
