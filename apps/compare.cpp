#include <fmt/format.h>

#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "validation/compare_output.hpp"
#include "validation/stage_model.hpp"
#include "validation/study_file.hpp"

namespace layerloop::apps {
namespace {

constexpr std::uint64_t seed = 1;  // of the test for patterns; the stages have that of the case

void compare(StudyOptions options) {
  validation::Study const study = validation::read_study(options.study);
  prepare(options, "compare");
  Communicator const comm;
  validation::StageModelOptions const stages{options.cache, options.beds, options.quiet};
  auto const model_of = [&](validation::Study const& of) { return validation::stage_model(of, {}, stages, comm); };
  validation::Comparison const compared = validation::compare(study, model_of, seed);
  if (!comm.is_root()) return;
  validation::write_comparison(options.folder, compared);
  if (!options.quiet)
    fmt::print("{}{}\n", validation::comparison_in_words(compared), (options.folder / "report.html").string());
}

}  // namespace

void add_compare(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("compare", "the model beside measurements: where it is off, and by how much");
  auto const options = std::make_shared<StudyOptions>();
  add_study_options(*verb, *options);
  verb->callback([=, &chosen] { chosen = [=] { compare(*options); }; });
}

}  // namespace layerloop::apps
