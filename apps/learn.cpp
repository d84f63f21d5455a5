#include <fmt/format.h>
#include <omp.h>

#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "coupling/sweep/sweep_cost.hpp"
#include "validation/learning/learn_output.hpp"

namespace layerloop::apps {
namespace {

void print_cost(validation::LearnStudy const& study, std::filesystem::path const& folder, Communicator const& comm) {
  if (!comm.is_root()) return;
  fmt::print("{}and {} further places, each as dear as one of these\n", coupling::cost_table(study.plan, folder),
             study.settings.runs);
}

}  // namespace

void add_learn(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("learn", "runs a start design, learns from it, and runs where it tells most");
  auto const from = std::make_shared<CaseOptions>();
  auto const to = std::make_shared<coupling::SweepOptions>();
  add_case_options(*verb, *from);
  auto const dry_run = std::make_shared<bool>(false);
  CLI::Option* const output = verb->add_option("-o,--output", to->folder, "folder for the results")->type_name("DIR");
  verb->add_flag("--resume", to->resume, "go on with what lies in the folder");
  verb->add_flag("--dry-run", *dry_run, "check every case of the start design and print what it will cost");
  verb->add_flag("--quiet", to->quiet, "no progress and no words");
  verb->callback([=, &chosen] {
    if (output->empty() && !*dry_run) throw CLI::RequiredError("--output");
    chosen = [=] {
      omp_set_num_threads(threads_of(*from));
      std::vector<std::string> const overrides = overrides_with_seed(*from);
      Communicator const comm;
      if (*dry_run) return print_cost(validation::read_learning(from->case_file, overrides), to->folder, comm);
      validation::LearnStudy const study = validation::run_learning(from->case_file, overrides, *to, comm);
      if (!comm.is_root()) return;
      validation::write_learning(study, validation::results_of(study), to->folder);
      if (!to->quiet) fmt::print("{}\n", (to->folder / "report.html").string());
    };
  });
}

}  // namespace layerloop::apps
