#include <fmt/format.h>

#include <memory>

#include "apps/verbs.hpp"
#include "coupling/layer_loop.hpp"

namespace layerloop::apps {

void add_run(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("run", "the layer loop: spread, trace, melt, mesh, and the next layer on it");
  auto const from = std::make_shared<CaseOptions>();
  auto const to = std::make_shared<coupling::RunOptions>();
  add_case_options(*verb, *from);
  verb->add_option("-o,--output", to->folder, "folder for the results")->required()->type_name("DIR");
  verb->add_flag("--resume", to->resume, "go on from the last good checkpoint in the folder");
  verb->add_flag("--quiet", to->quiet, "no progress");
  verb->callback([=, &chosen] { chosen = [=] { coupling::run_layer_loop(read_case(*from), *to, Communicator{}); }; });
}

}  // namespace layerloop::apps
