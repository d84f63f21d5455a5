#include "coupling/replicates.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/case_file.hpp"
#include "core/write_file.hpp"
#include "coupling/replicate_summary.hpp"
#include "coupling/report/replicate_report.hpp"

namespace layerloop::coupling {

void run_replicates(Case const& checked, RunOptions const& options, Communicator const& comm) {
  if (checked.run.replicates == 1) {
    run_layer_loop(checked, options, comm);
    return;
  }
  std::vector<std::string> folders;
  for (std::int64_t k = 0; k < checked.run.replicates; ++k) {
    Case replicate = checked;
    replicate.seed += static_cast<std::uint64_t>(k);
    replicate.run.replicates = 1;
    RunOptions own = options;
    own.folder /= folders.emplace_back(fmt::format("seed_{}", replicate.seed));
    if (comm.is_root() && !options.quiet)
      fmt::print(stderr, "replicate {} of {}: seed {}\n", k + 1, checked.run.replicates, replicate.seed);
    run_layer_loop(replicate, own, comm);
  }
  if (!comm.is_root()) return;
  std::vector<nlohmann::json> summaries;
  for (std::string const& folder : folders)
    summaries.push_back(nlohmann::json::parse(read_file(options.folder / folder / "summary.json")));
  nlohmann::json all = summary_over_replicates(summaries);
  all["replicates"] = folders;
  write_file(options.folder / "case_resolved.toml", resolved_toml(checked));
  write_file(options.folder / "summary.json", all.dump(2) + "\n");
  write_replicate_report(options.folder, checked, all, folders);
}

}  // namespace layerloop::coupling
