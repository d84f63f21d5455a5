#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"
#include "core/spelling.hpp"
#include "validation/effect_test.hpp"

namespace layerloop::apps {
namespace {

struct EffectArguments {
  std::string name, case_file;
  std::vector<std::string> overrides;
  int threads = 1;
};

char const* word(EffectStage stage) {
  return std::array{"dem", "laser", "heat", "solid"}.at(static_cast<std::size_t>(stage));
}
char const* word(EffectClass kind) {
  return std::array{"physics", "calibration", "numerics", "instrument"}.at(static_cast<std::size_t>(kind));
}

void list_effects() {
  if (!Communicator{}.is_root()) return;
  fmt::print("{:<22} {:<6} {:<11} {:<8} {:>7} {:>7}  {}\n", "effect", "stage", "class", "default", "prior", "largest",
             "what it is");
  for (Effect const& e : effect_catalogue())
    fmt::print("{:<22} {:<6} {:<11} {:<8} {:>7g} {:>7g}  {}\n", e.name, word(e.stage), word(e.kind),
               e.enabled == "true" ? "on" : "off", e.prior_scale, e.largest_strength, e.sentence);
}

Effect const& effect_named(std::string const& name) {
  std::vector<std::string> names;
  for (Effect const& effect : effect_catalogue()) {
    if (effect.name == name) return effect;
    names.push_back(effect.name);
  }
  throw InputError(
      fmt::format("unknown effect \"{}\" (layerloop effect list tells all){}", name, did_you_mean(name, names)));
}

void print(validation::EffectReport const& report) {
  for (validation::EffectCheck const& check : report.checks)
    fmt::print("{}  {:<10}  {}\n", !check.passed ? "info" : *check.passed ? "pass" : "FAIL", check.name, check.words);
  fmt::print("\n{:<24} {:>11}", "figure [SI]", "without");
  for (double const strength : report.strengths) fmt::print("  {:>18}", fmt::format("strength {:g}", strength));
  fmt::print("\n");
  for (validation::ProbedFigure const& f : report.figures) {
    fmt::print("{:<24} {:>11.5g}", f.name, f.base);
    for (std::size_t s = 0; s < f.change.size(); ++s)
      fmt::print("  {:>18}", fmt::format("{:+.2g} +- {:.1g}", f.change[s], f.u[s]));
    fmt::print("\n");
  }
}

void test(EffectArguments const& a) {
  Effect const& effect = effect_named(a.name);
  omp_set_num_threads(a.threads);
  validation::EffectTrial const trial = a.case_file.empty() ? validation::trial_of(effect, a.overrides)
                                                            : validation::trial_of(effect, a.case_file, a.overrides);
  Communicator const comm;
  validation::EffectReport const report = validation::test_effect(effect, trial, comm);
  if (comm.is_root()) print(report);
  if (!report.passed()) throw PhysicsError("effect " + effect.name + " does not hold what every effect must");
}

}  // namespace

void add_effect(CLI::App& program, Action& chosen) {
  CLI::App* verb =
      program.add_subcommand("effect", "the catalogue of physical effects, and does one hold its promises?");
  verb->require_subcommand(1);
  verb->add_subcommand("list", "every effect: stage, class, default, prior scale and bound of its strength")
      ->callback([&chosen] { chosen = list_effects; });
  CLI::App* one = verb->add_subcommand(
      "test", "null to the bit, probe, derivative, repeat, threads, cost; exit code 3 when one fails");
  auto const a = std::make_shared<EffectArguments>();
  one->add_option("name", a->name, "the effect")->required()->type_name("NAME");
  one->add_option("case", a->case_file, "on this case instead of the built-in one")->type_name("FILE.toml");
  one->add_option("--set", a->overrides, "override a key of the case: table.key=value")->type_name("KEY=VALUE");
  one->add_option("--threads", a->threads, "threads")->check(CLI::Range(1, 1024));
  one->callback([=, &chosen] { chosen = [=] { test(*a); }; });
}

}  // namespace layerloop::apps
