#include <fmt/format.h>

#include <fstream>
#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"
#include "validation/addition_output.hpp"
#include "validation/study_setup.hpp"

namespace layerloop::apps {
namespace {

constexpr std::uint64_t seed = 1;  // of the bootstrap

std::size_t looks_at(std::filesystem::path const& study) {
  std::ifstream log(study / "holdout_looks.log");
  std::size_t lines = 0;
  for (std::string line; std::getline(log, line);) ++lines;
  return lines;
}

void confirm(StudyOptions options, std::string const& effect) {
  using namespace validation;
  Study const train = read_study(options.study);
  prepare(options, "confirm");
  ReadExplanation explained = read_explanation(options.from);
  if (!effect.empty()) std::erase_if(explained.addition.effects, [&](auto const& e) { return e.name != effect; });
  if (explained.addition.effects.empty())
    throw InputError(fmt::format("{} names no effect{} to confirm (its verdict is {}) there is nothing to prove",
                                 options.from.string(), effect.empty() ? "" : " " + effect, explained.verdict));
  Communicator const comm;
  StageModelOptions const stages{options.cache, options.beds, options.quiet};
  StudySetup const training = set_up(train, train, stages, comm);
  indices_of(explained.addition.effects, training.candidates);  // refuses before the holdout is opened
  StudySetup const holdout = set_up(read_study(options.study, Role::holdout), train, stages, comm);
  Confirmation const found = validation::confirm(training.study, *training.model, holdout.study, *holdout.model,
                                                 training.candidates, explained.addition, seed);
  if (!comm.is_root()) return;
  std::size_t const looks = looks_at(train.folder);
  write_confirmation(options.folder, found, explained, looks);
  downgrade(options.from, found, explained);
  if (!options.quiet)
    fmt::print("{}{}\n", confirmation_in_words(found, explained, looks), (options.folder / "report.html").string());
}

}  // namespace

void add_confirm(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("confirm", "opens the holdout of a study, once: does the effect help there?");
  auto const options = std::make_shared<StudyOptions>();
  auto const effect = std::make_shared<std::string>();
  add_study_options(*verb, *options);
  add_from_option(*verb, *options);
  verb->add_option("--effect", *effect, "this one alone of those that explain named")->type_name("NAME");
  verb->callback([=, &chosen] { chosen = [=] { confirm(*options, *effect); }; });
}

}  // namespace layerloop::apps
