#include <fmt/format.h>
#include <omp.h>

#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "coupling/sweep/sweep_cost.hpp"
#include "coupling/sweep/sweep_run.hpp"

namespace layerloop::apps {

void add_sweep(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("sweep", "a table of cases: grid, list, Latin hypercube or Sobol sequence");
  auto const from = std::make_shared<CaseOptions>();
  auto const to = std::make_shared<coupling::SweepOptions>();
  auto const dry_run = std::make_shared<bool>(false);
  add_case_options(*verb, *from);
  verb->add_option("-o,--output", to->folder, "folder for the results")->type_name("DIR");
  verb->add_flag("--resume", to->resume, "go on with what lies in the folder");
  verb->add_option("--index", to->index, "this case only, from 1: for job arrays")->type_name("K");
  verb->add_option("--groups", to->groups, "groups of ranks, each with a case of its own at a time")->type_name("N");
  verb->add_flag("--report", to->only_report, "compute nothing, write tables and report of what is there");
  verb->add_flag("--dry-run", *dry_run, "check every case and print what it will cost");
  verb->add_flag("--quiet", to->quiet, "no progress and no words");
  verb->callback([=, &chosen] {
    to->resume = to->resume || to->only_report;
    if (to->folder.empty() && !*dry_run) throw CLI::RequiredError("--output");
    chosen = [=] {
      omp_set_num_threads(threads_of(*from));
      coupling::SweepPlan const plan = coupling::read_sweep(from->case_file, overrides_with_seed(*from));
      Communicator const comm;
      if (!*dry_run) return coupling::run_sweep(plan, *to, comm);
      coupling::SweepOptions options = *to;
      options.resume = true;  // nothing is lost by looking
      coupling::refuse_strangers(plan, options);
      if (comm.is_root()) fmt::print("{}", coupling::cost_table(plan, to->folder));
    };
  });
}

}  // namespace layerloop::apps
