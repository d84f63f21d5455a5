#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"
#include "core/write_file.hpp"
#include "validation/addition_output.hpp"
#include "validation/case_text.hpp"
#include "validation/study_setup.hpp"

namespace layerloop::apps {
namespace {

constexpr std::uint64_t fresh_seeds = 1;  // explain used set 0

struct AddOptions {
  StudyOptions of;
  std::vector<std::string> effects;
};

/// The explanation's effects of these names; one that it did not name starts from its prior scale.
validation::Addition chosen_addition(validation::ReadExplanation const& explained,
                                     std::vector<std::string> const& names,
                                     std::vector<validation::Candidate> const& candidates) {
  validation::Addition addition = explained.addition;
  addition.effects.clear();
  for (std::string const& name : names) {
    auto const named = std::ranges::find(explained.addition.effects, name, &validation::AddedEffect::name);
    auto const candidate = std::ranges::find(candidates, name, &validation::Candidate::name);
    addition.effects.push_back(named != explained.addition.effects.end() ? *named
                               : candidate != candidates.end()
                                   ? validation::AddedEffect{name, candidate->prior_scale, 0}
                                   : validation::AddedEffect{name, 1, 0});
  }
  return addition;
}

/// The study's case with the effects in it, ready to be run.
std::string case_with(validation::StudySetup const& at_hand, validation::BeforeAfter const& both) {
  std::string text = read_file(at_hand.study.case_file);
  Case const base = validation::first_case(at_hand.study);
  for (validation::AddedEffect const& effect : both.effects) {
    auto const candidate = std::ranges::find(at_hand.candidates, effect.name, &validation::Candidate::name);
    std::vector<std::string> const settings =
        validation::settings_of(*candidate, std::stod(fmt::format("{:.4g}", effect.strength)), base);
    if (settings.empty())
      throw InputError(
          fmt::format("{} is not part of a case (it acts on the reading) mend the measurements instead", effect.name));
    text = validation::with_settings(text, settings,
                                     fmt::format("added by layerloop add: {} {:.3g} +- {:.2g}, study {}", effect.name,
                                                 effect.strength, effect.u_strength, at_hand.study.name));
  }
  return text;
}

void add(AddOptions const& given) {
  using namespace validation;
  StudyOptions options = given.of;
  Study const study = read_study(options.study);
  prepare(options, "add");
  ReadExplanation const explained = read_explanation(options.from);
  Communicator const comm;
  StudySetup const at_hand = set_up(study, study, {options.cache, options.beds, options.quiet}, comm);
  Addition const addition = chosen_addition(explained, given.effects, at_hand.candidates);
  BeforeAfter const both = before_and_after(at_hand.study, *at_hand.model, at_hand.candidates, addition, fresh_seeds);
  if (!comm.is_root()) return;
  std::filesystem::path const case_file = options.folder / "case.toml";
  write_file(case_file, case_with(at_hand, both));
  write_addition(options.folder, both);
  if (!options.quiet)
    fmt::print("{}{}\n", addition_in_words(both, case_file), (options.folder / "report.html").string());
}

}  // namespace

void add_add(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("add", "writes the case with an effect in it, and runs it before and after");
  auto const options = std::make_shared<AddOptions>();
  add_study_options(*verb, options->of);
  add_from_option(*verb, options->of);
  verb->add_option("--effect", options->effects, "effect to add; may be given more than once")
      ->required()
      ->type_name("NAME");
  verb->callback([=, &chosen] { chosen = [=] { add(*options); }; });
}

}  // namespace layerloop::apps
