#include <fmt/format.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <map>

#include "apps/verbs.hpp"
#include "validation/blind/blind_page.hpp"
#include "validation/blind/blind_test.hpp"

namespace layerloop::apps {
namespace {

namespace fs = std::filesystem;
using validation::Also;
using validation::BlindSet;

struct BlindOptions {
  fs::path folder, out;
  std::vector<fs::path> folders;
  std::string world = "analytic";
  std::size_t scenarios = 300;
  std::uint64_t seed = 1;
  BlindSet set = BlindSet::development;
  Also also = Also::nothing;
  int threads = 0;
};

CLI::App* step(CLI::App& verb, BlindOptions& options, std::string const& name, std::string const& description) {
  CLI::App* const added = verb.add_subcommand(name, description);
  added->add_option("DIR", options.folder, "folder of the blind test")->required();
  added->add_option("--threads", options.threads, "threads (0: all cores)")->check(CLI::NonNegativeNumber);
  return added;
}

/// The step, after its threads are set.
template <class Do>
void on_call(CLI::App* verb, BlindOptions const& options, Action& chosen, Do action) {
  verb->callback([&options, &chosen, action] {
    chosen = [&options, action] {
      if (options.threads > 0) omp_set_num_threads(options.threads);
      action();
    };
  });
}

}  // namespace

void add_blind(CLI::App& program, Action& chosen) {
  static BlindOptions options;
  CLI::App* const verb = program.add_subcommand(
      "blind", "Hide known causes in studies, diagnose them, open the sealed answers, and score the diagnoses.");
  verb->require_subcommand(1);

  CLI::App* const make = step(*verb, options, "make", "Draw studies with hidden causes and seal the answers.");
  make->add_option("--scenarios", options.scenarios, "how many")->capture_default_str()->check(CLI::Range(1, 100000));
  make->add_option(
          "--world", options.world,
          "what stands for the process: a chain of formulas (analytic), or the stages of this program on "
          "spread beds (powder), piles and tilted plates (piles), absorptivity of beds (light), tracks on a plate "
          "(tracks) or on powder (layer)")
      ->capture_default_str()
      ->check(CLI::IsMember(validation::world_names()));
  make->add_option("--seed", options.seed, "the secret that opens the seals")->required();
  make->add_option("--set", options.set, "development (thresholds may be tuned on it) or scored (used once)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, BlindSet>{{"development", BlindSet::development}, {"scored", BlindSet::scored}}));
  on_call(make, options, chosen, [] {
    validation::make_blind_test(options.folder, options.world, options.scenarios, options.seed, options.set);
  });

  CLI::App* const run = step(*verb, options, "run", "Diagnose every study; the verdicts are hashed.");
  run->add_option("--also", options.also, "baselines, or ablations (which includes them)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Also>{{"baselines", Also::baselines}, {"ablations", Also::baselines_and_ablations}}));
  on_call(run, options, chosen, [] { validation::run_blind_test(options.folder, options.also); });

  CLI::App* const open = step(*verb, options, "open", "Open the sealed answers and check all hashes.");
  open->add_option("--seed", options.seed, "the secret that they were sealed with")->required();
  on_call(open, options, chosen,
          [] { fmt::print("{} answers opened\n", validation::open_blind_test(options.folder, options.seed).size()); });

  CLI::App* const score = verb->add_subcommand("score", "Count how often the diagnoses were right.");
  score->add_option("DIR", options.folders, "folders of blind tests, scored together")->required();
  score->add_option("-o,--output", options.out, "folder for the report (default: the first DIR)");
  on_call(score, options, chosen, [] {
    fmt::print("{}", validation::write_blind_report(options.folders,
                                                    options.out.empty() ? options.folders.front() : options.out));
  });
}

}  // namespace layerloop::apps
