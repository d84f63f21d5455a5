#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "apps/explained.hpp"
#include "core/communicator.hpp"
#include "validation/digest.hpp"
#include "validation/explain_output.hpp"
#include "validation/next_search.hpp"
#include "validation/study_setup.hpp"

namespace layerloop::apps {
namespace {

constexpr std::uint64_t seed = 1;  // of the null distributions; the stages have that of the case

std::map<std::string, std::string> digests(std::filesystem::path const& home, std::filesystem::path const& case_file) {
  std::map<std::string, std::string> all;
  for (std::filesystem::path const& file :
       {home / "study.toml", home / "conditions.csv", home / "measurements.csv", case_file})
    if (std::filesystem::is_regular_file(file)) all[file.filename().string()] = validation::sha256_of_file(file);
  return all;
}

void explain(StudyOptions options) {
  validation::Explanation const explanation = explained(options, "explain");
  if (!Communicator{}.is_root()) return;
  write_explanation(options.folder, explanation);
  if (!options.quiet) fmt::print("{}{}\n", answer_in_words(explanation), (options.folder / "report.html").string());
}

}  // namespace

validation::Explanation explained(StudyOptions& options, std::string const& verb) {
  using namespace validation;
  auto const begin = std::chrono::steady_clock::now();
  Study const study = read_study(options.study);
  prepare(options, verb);
  Communicator const comm;
  StageModelOptions const stages{options.cache, options.beds, options.quiet};
  StudySetup const at_hand = set_up(study, study, stages, comm);
  auto const model_of = [&](Study const& other) { return stage_model(other, at_hand.candidates, stages, comm); };
  Explanation explanation =
      validation::explain(at_hand.study, *at_hand.model, at_hand.candidates, at_hand.untestable, {}, seed);
  explanation.next = next_experiments(explanation, *at_hand.model, model_of);
  explanation.sha256 = digests(study.folder, study.case_file);
  explanation.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return explanation;
}

void add_explain(CLI::App& program, Action& chosen) {
  CLI::App* verb =
      program.add_subcommand("explain", "which physical effect a model lacks, judged by the measurements of a study");
  auto const options = std::make_shared<StudyOptions>();
  add_study_options(*verb, *options);
  verb->callback([=, &chosen] { chosen = [=] { explain(*options); }; });
}

}  // namespace layerloop::apps
