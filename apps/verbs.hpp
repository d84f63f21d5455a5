#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/case.hpp"

namespace layerloop::apps {

/// What every verb that reads a case takes.
struct CaseOptions {
  std::filesystem::path case_file;
  std::vector<std::string> overrides;  ///< --set table.key=value
  std::optional<std::uint64_t> seed;
  int threads = 0;  ///< 0: the cores of this machine shared by the ranks on it
};

/// A verb registers its subcommand and, when the user chose it, leaves what is to be done in `chosen`.
using Action = std::function<void()>;
void add_run(CLI::App& program, Action& chosen);
void add_spread(CLI::App& program, Action& chosen);
void add_absorb(CLI::App& program, Action& chosen);
void add_learn(CLI::App& program, Action& chosen);
void add_melt(CLI::App& program, Action& chosen);
void add_bench(CLI::App& program, Action& chosen);
void add_check(CLI::App& program, Action& chosen);
void add_calibrate(CLI::App& program, Action& chosen);
void add_blind(CLI::App& program, Action& chosen);
void add_doctor(CLI::App& program, Action& chosen);
void add_effect(CLI::App& program, Action& chosen);
void add_compare(CLI::App& program, Action& chosen);
void add_explain(CLI::App& program, Action& chosen);
void add_add(CLI::App& program, Action& chosen);
void add_confirm(CLI::App& program, Action& chosen);
void add_next(CLI::App& program, Action& chosen);
void add_sweep(CLI::App& program, Action& chosen);

/// Cores of this machine for each of the ranks that run on it.
int cores_per_rank();
/// Of each rank.
int threads_of(CaseOptions const& options);
/// The --set options, with the one that --seed stands for.
std::vector<std::string> overrides_with_seed(CaseOptions const& options);
void add_case_options(CLI::App& verb, CaseOptions& options);
/// Also sets the number of threads. Without a process, the case tells by itself (core/case_file.hpp).
Case read_case(CaseOptions const& options, std::optional<Process> process);
/// The same of a text in the place of the file.
Case case_of_text(CaseOptions const& options, std::string const& text, std::optional<Process> process);

/// What every verb on a study takes.
struct StudyOptions {
  std::filesystem::path study, folder, cache;
  std::filesystem::path from;  ///< summary of explain
  int threads = 0;             ///< 0: the cores of this machine shared by the ranks on it
  std::int64_t beds = 1;
  bool quiet = false;

  std::filesystem::path home() const;  ///< folder of the study
};
/// Results go to `folder` in the study unless -o says otherwise, what was computed to its cache.
void add_study_options(CLI::App& verb, StudyOptions& options);
/// The same with --from for a verb that builds on an explanation.
void add_from_option(CLI::App& verb, StudyOptions& options);
/// Sets the threads, fills in what was not given, and makes the folder. \param name  of the folder in the study
void prepare(StudyOptions& options, std::string const& name);

/// "FILE is a good case" and what it will cost.
void print_cost(Case const& checked, std::filesystem::path const& case_file);

/// A verb that goes through the layer loop.
CLI::App* add_layer_verb(CLI::App& program, Action& chosen, std::string const& name, std::string const& description,
                         Process process);

}  // namespace layerloop::apps
