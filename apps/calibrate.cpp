#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"
#include "coupling/calibration_output.hpp"

namespace layerloop::apps {
namespace {

struct CalibrateOptions {
  CaseOptions from;
  std::filesystem::path folder;
  bool quiet = false, dry_run = false;
};

void print_tests(Case const& checked, std::string const& case_file) {
  CalibrateSettings const& c = checked.calibrate;
  std::int64_t const points = c.search ? 1 + c.grid * c.grid + c.refinements + 10 : 1;
  fmt::print("{} is a good case\n  piles   {} of {} grains\n  plates  {} of {} grains\n", case_file,
             points * checked.run.replicates, c.pile_particles, points * checked.run.replicates, c.plate_particles);
}

void calibrate(CalibrateOptions const& options) {
  Case const checked = read_case(options.from, Process::calibrating);
  Communicator const comm;
  if (options.dry_run) {
    if (comm.is_root()) print_tests(checked, options.from.case_file.string());
    return;
  }
  std::error_code failure;
  if (comm.is_root()) std::filesystem::create_directories(options.folder, failure);
  if (comm.any(static_cast<bool>(failure)))
    throw FileError(fmt::format("cannot make the folder {} ({})", options.folder.string(), failure.message()));
  coupling::Calibration const found = coupling::calibrate(checked, comm, !options.quiet);
  if (!comm.is_root()) return;
  coupling::write_calibration(options.folder, checked, found);
  if (!options.quiet) fmt::print("{}\n{}\n", found.verdict, (options.folder / "report.html").string());
}

}  // namespace

void add_calibrate(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand(
      "calibrate", "angle of repose and slipping angle, and the friction and cohesion that give the measured ones");
  auto const options = std::make_shared<CalibrateOptions>();
  add_case_options(*verb, options->from);
  verb->add_option("-o,--output", options->folder, "folder for the results")->required()->type_name("DIR");
  verb->add_flag("--quiet", options->quiet, "no progress");
  verb->add_flag("--dry-run", options->dry_run, "only check the case and tell how many tests it takes");
  verb->callback([=, &chosen] { chosen = [=] { calibrate(*options); }; });
}

}  // namespace layerloop::apps
