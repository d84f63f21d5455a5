#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "validation/explanation.hpp"

namespace layerloop::validation {

/// "pool.depth at laser.power = 200 W: 4 readings tell keyhole and evaporation apart"
std::string proposal_in_words(NextExperiment const& next);

/// The answer on one screen: the verdict first, what to measure next last.
std::string answer_in_words(Explanation const& explained);

/// summary.json; `effects` are those of the verdict, `candidates` all that were tried.
nlohmann::json explain_summary(Explanation const& explained);

/// summary.json, report.html and the tables behind its pictures. \throws FileError
void write_explanation(std::filesystem::path const& folder, Explanation const& explained);

/// Verdict, effects and calibration of an explanation that was written, for the verbs that build on it.
struct FoundEffect {
  std::string name;
  double strength = 0, u_strength = 0;
};
struct ReadExplanation {
  std::string verdict, sentence;
  std::vector<FoundEffect> effects;
  std::map<std::string, double> calibration;  ///< parameter -> value with the effects in [SI]
};
/// \param summary  summary.json, or the folder that holds it \throws InputError  it is not one of `explain`; FileError
ReadExplanation read_explanation(std::filesystem::path const& summary);

}  // namespace layerloop::validation
