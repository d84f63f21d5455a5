#include <fmt/format.h>

#include <memory>
#include <optional>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "coupling/melt_study.hpp"

namespace layerloop::apps {
namespace {

struct MeltArguments {
  CaseOptions from;
  coupling::MeltOptions to;
  bool two_grids = false;
  std::string scan, periodic_x, periodic_y, floor_z;
};

std::optional<double> length_of(std::string const& text) {
  return text.empty() ? std::nullopt : std::optional(parse_quantity(text, Dimension::length));
}

void melt(MeltArguments const& arguments) {
  CaseOptions from = arguments.from;
  coupling::MeltOptions options = arguments.to;
  std::vector<std::string> own;
  if (!options.bed.bed.empty()) own.push_back("melt.bed=file");
  if (!arguments.scan.empty())
    own.insert(own.end(), {"scan.kind=file", "scan.path=" + std::filesystem::absolute(arguments.scan).string()});
  if (arguments.two_grids) own.push_back("melt.two_grids=true");
  from.overrides.insert(from.overrides.begin(), own.begin(), own.end());
  Case const checked = read_case(from, Process::exposing);
  if (checked.melt.bed == MeltedBed::file && options.bed.bed.empty())
    throw InputError("melt.bed = \"file\" (no file is named) add --bed FILE");
  options.bed.periodic_x = length_of(arguments.periodic_x);
  options.bed.periodic_y = length_of(arguments.periodic_y);
  options.bed.floor_z = length_of(arguments.floor_z);
  Communicator const comm;
  coupling::MeltStudy const study = coupling::run_melt(checked, options, comm);
  if (!comm.is_root() || options.quiet) return;
  PoolSize const &pool = study.melted.heat.melt.pool, &u = study.u_num;
  fmt::print("{}: width {:.1f} +- {:.1f}, depth {:.1f} +- {:.1f}, length {:.0f} +- {:.0f} um; absorptivity {:.3f}\n",
             coupling::name_of(study.regime), 1e6 * pool.width, 1e6 * u.width, 1e6 * pool.depth, 1e6 * u.depth,
             1e6 * pool.length, 1e6 * u.length, study.melted.exposure.mean.absorptivity);
  fmt::print("{}\n", (options.folder / "report.html").string());
}

}  // namespace

void add_melt(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand(
      "melt", "a track or patch on a plate or on powder: melt pool, regime, cooling, lack of fusion");
  auto const a = std::make_shared<MeltArguments>();
  add_case_options(*verb, a->from);
  verb->add_option("-o,--output", a->to.folder, "folder for the results")->required()->type_name("DIR");
  verb->add_option("--bed", a->to.bed.bed, "powder on the plate: csv, dump, extxyz or h5")->type_name("FILE");
  verb->add_option("--periodic-x", a->periodic_x, "period of the bed along x, if not that of the file")
      ->type_name("LENGTH");
  verb->add_option("--periodic-y", a->periodic_y, "period of the bed along y, if not that of the file")
      ->type_name("LENGTH");
  verb->add_option("--floor-z", a->floor_z, "level of the plate's top in the file")->type_name("LENGTH");
  verb->add_option("--scan", a->scan, "way of the beam: csv, see scan.path")->type_name("FILE");
  verb->add_flag("--two-grids", a->two_grids, "also in cells 1.5 times as large, for the discretisation error");
  verb->add_flag("--quiet", a->to.quiet, "no progress and no words");
  verb->callback([=, &chosen] { chosen = [=] { melt(*a); }; });
}

}  // namespace layerloop::apps
