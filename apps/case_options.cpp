#include <mpi.h>
#include <omp.h>

#include <algorithm>
#include <thread>

#include "apps/verbs.hpp"
#include "core/case_file.hpp"

namespace layerloop::apps {

std::vector<std::string> overrides_with_seed(CaseOptions const& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back("case.seed=" + std::to_string(*options.seed));
  return overrides;
}

int cores_per_rank() {
  MPI_Comm node;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  int ranks = 1;
  MPI_Comm_size(node, &ranks);
  MPI_Comm_free(&node);
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / ranks);
}

int threads_of(CaseOptions const& options) { return options.threads > 0 ? options.threads : cores_per_rank(); }

void add_case_options(CLI::App& verb, CaseOptions& options) {
  verb.add_option("case", options.case_file, "the case file (TOML)")->required()->type_name("FILE.toml");
  verb.add_option("--set", options.overrides, "override a key of the case: table.key=value")->type_name("KEY=VALUE");
  verb.add_option("--seed", options.seed, "override case.seed");
  verb.add_option("--threads", options.threads,
                  "threads of each rank (default: the cores of the machine shared by its ranks)")
      ->check(CLI::Range(1, 1024));
}

Case read_case(CaseOptions const& options, std::optional<Process> process) {
  omp_set_num_threads(threads_of(options));
  return layerloop::read_case(options.case_file, overrides_with_seed(options), process);
}

Case case_of_text(CaseOptions const& options, std::string const& text, std::optional<Process> process) {
  omp_set_num_threads(threads_of(options));
  return layerloop::case_of_text(text, "the built-in case", overrides_with_seed(options), process);
}

}  // namespace layerloop::apps
