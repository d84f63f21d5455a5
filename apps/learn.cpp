#include <fmt/format.h>
#include <omp.h>

#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "validation/learning/learn_output.hpp"

namespace layerloop::apps {

void add_learn(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("learn", "runs a start design, learns from it, and runs where it tells most");
  auto const from = std::make_shared<CaseOptions>();
  auto const to = std::make_shared<coupling::SweepOptions>();
  add_case_options(*verb, *from);
  verb->add_option("-o,--output", to->folder, "folder for the results")->required()->type_name("DIR");
  verb->add_flag("--resume", to->resume, "go on with what lies in the folder");
  verb->add_flag("--quiet", to->quiet, "no progress and no words");
  verb->callback([=, &chosen] {
    chosen = [=] {
      omp_set_num_threads(threads_of(*from));
      Communicator const comm;
      validation::LearnStudy const study =
          validation::run_learning(from->case_file, overrides_with_seed(*from), *to, comm);
      if (!comm.is_root()) return;
      validation::write_learning(study, validation::results_of(study), to->folder);
      if (!to->quiet) fmt::print("{}\n", (to->folder / "report.html").string());
    };
  });
}

}  // namespace layerloop::apps
