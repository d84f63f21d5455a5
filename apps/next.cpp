#include <fmt/format.h>

#include <memory>

#include "apps/explained.hpp"
#include "core/communicator.hpp"
#include "validation/explain_output.hpp"

namespace layerloop::apps {
namespace {

void next(StudyOptions options) {
  validation::Explanation const explanation = explained(options, "next");
  if (!Communicator{}.is_root()) return;
  write_proposals(options.folder, explanation);
  if (options.quiet) return;
  for (validation::NextExperiment const& proposal : explanation.next)
    fmt::print("MEASURE: {}\n", proposal_in_words(proposal));
  if (explanation.next.empty()) fmt::print("{}\n", nothing_to_separate(explanation));
  fmt::print("{}\n", (options.folder / "report.html").string());
}

}  // namespace

void add_next(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("next", "the measurement that tells the remaining candidates apart");
  auto const options = std::make_shared<StudyOptions>();
  add_study_options(*verb, *options);
  verb->callback([=, &chosen] { chosen = [=] { next(*options); }; });
}

}  // namespace layerloop::apps
