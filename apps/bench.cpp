#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "apps/verbs.hpp"
#include "core/bed_file.hpp"
#include "dem/settled_bed_bench.hpp"

namespace layerloop::apps {
namespace {

struct BenchOptions {
  std::filesystem::path packing;
  std::int64_t steps = 1000;
  int threads = 1;
};

void bench_dem(BenchOptions const& options) {
  Communicator const comm;
  omp_set_num_threads(options.threads);
  dem::SettledBedBench const result = dem::bench_settled_bed(read_bed(options.packing), options.steps, comm);
  if (!comm.is_root()) return;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  nlohmann::ordered_json json{{"particles", result.particles},
                              {"contacts", result.contacts},
                              {"steps", options.steps},
                              {"ranks", comm.size()},
                              {"threads", options.threads},
                              {"seconds", result.seconds},
                              {"particle_steps_per_second", result.particle_steps_per_second()},
                              {"peak_memory", static_cast<double>(usage.ru_maxrss) * 1024},
                              {"neighbour_rebuilds", result.rebuilds},
                              {"imbalance", result.imbalance}};
  for (auto const& [phase, seconds] : result.phases) json["phases"][phase] = seconds;
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

void add_bench(CLI::App& program, Action& chosen) {
  CLI::App* bench = program.add_subcommand("bench", "how fast the kernels are on this machine");
  bench->require_subcommand(1);
  CLI::App* verb =
      bench->add_subcommand("dem", "a settled bed under the thesis' contact law, every contact every step");
  auto const options = std::make_shared<BenchOptions>();
  verb->add_option("packing", options->packing, "the bed: csv, dump, extxyz or h5")->required()->type_name("PACKING");
  verb->add_option("--steps", options->steps, "steps that are timed, after 100 that are not")
      ->check(CLI::Range(1, 1'000'000'000));
  verb->add_option("--threads", options->threads, "threads of each rank")->check(CLI::Range(1, 1024));
  verb->callback([=, &chosen] { chosen = [=] { bench_dem(*options); }; });
}

}  // namespace layerloop::apps
