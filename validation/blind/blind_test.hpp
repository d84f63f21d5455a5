#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "validation/blind/score.hpp"

namespace layerloop::validation {

// The blind test, folder by folder: what is hidden is sealed before the analysis, the analysis is hashed before the
// seal is opened, and only then is it scored.

/// Which set: thresholds may be tuned on the development set; the scored set is drawn after that and used once.
enum class BlindSet { development, scored };
std::string const& name_of(BlindSet set);

/// Writes DIR/sNNN/{study.toml, conditions.csv, measurements.csv, case.toml, answer.sealed} and DIR/manifest.json with
/// the sha256 of every sealed answer. The same for any number of threads. \param world  one of world_names()
void make_blind_test(std::filesystem::path const& folder, std::string const& world, std::size_t scenarios,
                     std::uint64_t seed, BlindSet set);

enum class Also { nothing, baselines, baselines_and_ablations };

/// Diagnoses every study into DIR/sNNN/verdict.json and their hashes, with that of the thresholds, into
/// DIR/verdicts.json. Goes on where it was stopped. \throws InputError  a sealed answer is not the one that was
/// published; there are verdicts already
void run_blind_test(std::filesystem::path const& folder, Also also);

/// Opens the answers into DIR/sNNN/answer.json, and predicts what was held out as the verdicts say.
/// \throws InputError  another seed, an answer or a verdict that was changed, no verdicts yet
std::vector<Opened> open_blind_test(std::filesystem::path const& folder, std::uint64_t seed);

/// Reads what was opened. \throws InputError  it was not
std::vector<Opened> opened_blind_test(std::filesystem::path const& folder);

/// Names of Opened::others in this test.
std::vector<std::string> other_methods(std::filesystem::path const& folder);

/// The thresholds as text, for their hash and for reports.
std::string text_of(Thresholds const& thresholds);

}  // namespace layerloop::validation
