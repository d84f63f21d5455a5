#include <fmt/format.h>

#include <memory>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "coupling/melt_study.hpp"

namespace layerloop::apps {
namespace {

struct MeltArguments {
  CaseOptions from;
  coupling::MeltOptions to;
  bool two_grids = false;
};

void melt(MeltArguments const& arguments) {
  CaseOptions from = arguments.from;
  if (arguments.two_grids) from.overrides.push_back("melt.two_grids=true");
  Case const checked = read_case(from, Process::exposing);
  Communicator const comm;
  coupling::MeltStudy const study = coupling::run_melt(checked, arguments.to, comm);
  if (!comm.is_root() || arguments.to.quiet) return;
  PoolSize const &pool = study.melted.heat.melt.pool, &u = study.u_num;
  fmt::print("{}: width {:.1f} +- {:.1f}, depth {:.1f} +- {:.1f}, length {:.0f} +- {:.0f} um; absorptivity {:.3f}\n",
             coupling::name_of(study.regime), 1e6 * pool.width, 1e6 * u.width, 1e6 * pool.depth, 1e6 * u.depth,
             1e6 * pool.length, 1e6 * u.length, study.melted.exposure.mean.absorptivity);
  fmt::print("{}\n", (arguments.to.folder / "summary.json").string());
}

}  // namespace

void add_melt(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("melt", "a track or patch on a plate: melt pool, cooling, regime");
  auto const a = std::make_shared<MeltArguments>();
  add_case_options(*verb, a->from);
  verb->add_option("-o,--output", a->to.folder, "folder for the results")->required()->type_name("DIR");
  verb->add_flag("--two-grids", a->two_grids, "also in cells 1.5 times as large, for the discretisation error");
  verb->add_flag("--quiet", a->to.quiet, "no progress and no words");
  verb->callback([=, &chosen] { chosen = [=] { melt(*a); }; });
}

}  // namespace layerloop::apps
