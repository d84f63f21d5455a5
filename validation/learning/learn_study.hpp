#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "coupling/sweep/sweep_run.hpp"
#include "validation/learning/layer_models.hpp"
#include "validation/learning/learn_settings.hpp"
#include "validation/learning/learner.hpp"

namespace layerloop::validation {

/// What runs have taught: every case of the sweep and of the search after it.
struct LearnStudy {
  LearnSettings settings;
  coupling::SweepPlan plan;                    ///< start design, then the places that were proposed
  std::size_t start = 0;                       ///< points of the start design
  InputBox box = {};                           ///< by key of the plan [SI]
  std::vector<nlohmann::json> summaries = {};  ///< by case; null: failed
  std::vector<LearnedRun> trials = {};         ///< by case
  std::vector<LearnedRun> refused = {};        ///< proposed places that are no good case

  LearnPlan search() const;
  std::vector<LearnedRun> known() const;  ///< trials, and what was refused as failed ones
};

/// Cases that gave no output.
std::size_t failed_runs(LearnStudy const& study);

/// What is to be run, checked, before any run. \throws InputError with the faults of read_learn and of read_sweep;
/// FileError
LearnStudy read_learning(std::filesystem::path const& path, std::vector<std::string> const& overrides);

/// Runs the start design and then, one after the other, the places where the acquisition expects most; what lies in the
/// folder is kept, even more than the settings ask for, and since every proposal follows from the results before it, a
/// search that was stopped goes on as if it had not been. Leaves the folder of a sweep and what was looked for in
/// learn.json. Collective. \throws as read_learning and run_sweep; InputError  the folder holds another search, and
/// nothing was written; PhysicsError  fewer than two cases of the start design give the output
LearnStudy run_learning(std::filesystem::path const& path, std::vector<std::string> const& overrides,
                        coupling::SweepOptions const& options, Communicator const& comm);

/// Number of a case under the key of an output: in its last layer, or in its summary.
double output_of(nlohmann::json const& summary, std::string const& key);

}  // namespace layerloop::validation
