#include <fmt/format.h>

#include <map>
#include <memory>

#include "apps/verbs.hpp"
#include "coupling/replicates.hpp"

namespace layerloop::apps {

CLI::App* add_layer_verb(CLI::App& program, Action& chosen, std::string const& name, std::string const& description,
                         Process process) {
  CLI::App* verb = program.add_subcommand(name, description);
  auto const from = std::make_shared<CaseOptions>();
  auto const to = std::make_shared<coupling::RunOptions>();
  auto const dry_run = std::make_shared<bool>(false);
  static std::map<std::string, BedFormat> const formats{
      {"csv", BedFormat::csv}, {"dump", BedFormat::dump}, {"extxyz", BedFormat::extxyz}};
  add_case_options(*verb, *from);
  CLI::Option* const output = verb->add_option("-o,--output", to->folder, "folder for the results")->type_name("DIR");
  verb->add_flag("--resume", to->resume, "go on from the last good checkpoint in the folder");
  verb->add_flag("--quiet", to->quiet, "no progress");
  verb->add_flag("--dry-run", *dry_run, "check the case and print what it will cost");
  verb->add_option("--export", to->exports, "write every bed in this format as well (may be repeated)")
      ->transform(CLI::CheckedTransformer(formats).description("csv, dump or extxyz"))
      ->type_name("FORMAT");
  verb->callback([=, &chosen] {
    if (output->empty() && !*dry_run) throw CLI::RequiredError("--output");
    chosen = [=] {
      Case const checked = read_case(*from, process);
      if (*dry_run) return print_cost(checked, from->case_file);
      coupling::run_replicates(checked, *to, Communicator{});
    };
  });
  return verb;
}

void add_run(CLI::App& program, Action& chosen) {
  add_layer_verb(program, chosen, "run", "the layer loop: spread, trace, melt, mesh, and the next layer on it",
                 Process::melting);
}

}  // namespace layerloop::apps
