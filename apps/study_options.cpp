#include <fmt/format.h>
#include <omp.h>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"

namespace layerloop::apps {

std::filesystem::path StudyOptions::home() const {
  return std::filesystem::is_directory(study) ? study : study.parent_path();
}

void add_study_options(CLI::App& verb, StudyOptions& options) {
  verb.add_option("study", options.study, "folder with study.toml")->required()->type_name("STUDY");
  verb.add_option("-o,--output", options.folder, "folder for the results (default: one in the study)")
      ->type_name("DIR");
  verb.add_option("--cache", options.cache, "folder of what was computed (default: cache in the study)")
      ->type_name("DIR");
  verb.add_option("--threads", options.threads, "threads (default: the cores of the machine)")
      ->check(CLI::Range(1, 1024));
  verb.add_option("--beds", options.beds, "beds that are averaged where powder is spread")->check(CLI::Range(1, 1000));
  verb.add_flag("--quiet", options.quiet, "no progress and no words");
}

void add_from_option(CLI::App& verb, StudyOptions& options) {
  verb.add_option("--from", options.from, "summary.json of explain (default: that in the study)")->type_name("FILE");
}

void prepare(StudyOptions& options, std::string const& name) {
  omp_set_num_threads(options.threads > 0 ? options.threads : cores_per_rank());
  if (options.folder.empty()) options.folder = options.home() / name;
  if (options.cache.empty()) options.cache = options.home() / "cache";
  if (options.from.empty()) options.from = options.home() / "explain" / "summary.json";
  std::error_code failure;
  if (Communicator{}.is_root()) {
    std::filesystem::create_directories(options.folder, failure);
    if (!failure) std::filesystem::create_directories(options.cache, failure);
  }
  if (failure)
    throw FileError(fmt::format("cannot make the folder {} ({})", options.folder.string(), failure.message()));
}

}  // namespace layerloop::apps
