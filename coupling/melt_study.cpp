#include "coupling/melt_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "coupling/effects/heat_accumulation.hpp"
#include "coupling/ledger.hpp"
#include "coupling/melt_output.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "coupling/solid_field.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/transfer.hpp"

namespace layerloop::coupling {
namespace {

/// A bare plate, its top at z = 0.
BuildState bare_plate(Case const& placed) {
  BuildState build;
  build.solid = empty_solid(placed);
  build.substrate = mesh_solid(build.solid, placed);
  return build;
}

struct Exposed {
  CellContent cells;
  MeltedLayer melted;
};

Exposed expose(BuildState& build, Case const& placed, Communicator const& comm, thermal::Report report) {
  CellContent cells =
      cell_content(build.solid, build.bed, placed, placed.machine.deposition_begin(), placed.machine.deposition_end());
  MeltSurface surface(build.solid, build.bed, build.substrate, cells, placed);
  MeltedLayer melted =
      melt_layer(surface, cells, placed, start_temperature(placed, {}), 1, comm, report, build.record.wall_time);
  return {std::move(cells), std::move(melted)};
}

/// Error of the finer grid by Richardson's extrapolation; the order is taken to be 2.
double extrapolated_error(double fine, double coarse) {
  return std::abs(coarse - fine) / (coarsening * coarsening - 1);
}

PoolSize error_of_two_grids(PoolSize const& fine, PoolSize const& coarse) {
  return {extrapolated_error(fine.width, coarse.width), extrapolated_error(fine.depth, coarse.depth),
          extrapolated_error(fine.length, coarse.length)};
}

RegimeSigns signs_of(MeltStudy const& study) {
  MeltRecord const& melt = study.melted.heat.melt;
  RegimeSigns signs;
  signs.pool = melt.pool;
  signs.spot_radius = study.placed.laser.spot_radius();
  signs.molten = std::ranges::count(melt.melted, 1) > 0;
  signs.boils = study.melted.heat.peak_temperature >= study.placed.material.boiling_point;
  signs.powder = study.build.bed.size() > 0;
  for (TrackSection const& section : melt.sections) {
    signs.boiling_depth = std::max(signs.boiling_depth, section.boiling_depth);
    signs.height += (section.depth_from_top - section.depth) / static_cast<double>(melt.sections.size());
  }
  return signs;
}

}  // namespace

std::string const& name_of(Regime regime) {
  static std::array<std::string, 6> const names{"none", "no_fusion", "conduction", "transition", "keyhole", "balling"};
  return names.at(static_cast<std::size_t>(regime));
}

Regime regime_of(RegimeSigns const& signs) {
  if (!signs.molten) return Regime::none;
  if (signs.powder && signs.pool.depth <= 0) return Regime::no_fusion;
  bool const free_cylinder = signs.pool.length > std::numbers::pi * signs.pool.width;
  if (signs.powder && free_cylinder && signs.height > signs.pool.depth) return Regime::balling;
  if (!signs.boils) return Regime::conduction;
  return signs.boiling_depth > signs.spot_radius ? Regime::keyhole : Regime::transition;
}

std::optional<CoolingRate> cooling_rate(ProbeHistory const& probe, double solidus) {
  constexpr double span = 100;
  std::vector<double> const &t = probe.time, &T = probe.temperature;
  // Place where the temperature last falls through a level, and the step it takes there.
  auto const falls_through = [&](double level) -> std::optional<std::array<double, 2>> {
    for (std::size_t i = T.size(); i-- > 1;) {
      if (T[i - 1] < level || T[i] >= level) continue;
      double const share = (T[i - 1] - level) / (T[i - 1] - T[i]);
      return std::array{t[i - 1] + share * (t[i] - t[i - 1]), t[i] - t[i - 1]};
    }
    return std::nullopt;
  };
  auto const from = falls_through(solidus), to = falls_through(solidus - span);
  if (!from || !to || to->at(0) <= from->at(0)) return std::nullopt;
  double const time = to->at(0) - from->at(0), rate = span / time;
  // The temperature between two samples is a straight line: wrong by a part of what one step changes.
  return CoolingRate{rate, rate * 0.5 * std::hypot(from->at(1), to->at(1)) / time};
}

MeltStudy run_melt(Case const& checked, MeltOptions const& options, Communicator const& comm) {
  MeltStudy study;
  study.estimate = estimate_pool(checked);
  study.placed = with_plate(checked, study.estimate);
  auto const report = comm.is_root() && !options.quiet ? thermal::Report::progress : thermal::Report::silent;
  WallTime& wall_time = study.build.record.wall_time;
  MeltOutput const output(study.placed, options.folder, comm);
  {
    Stopwatch const timed(wall_time.total);
    study.build = bare_plate(study.placed);
    auto [cells, melted] = expose(study.build, study.placed, comm, report);
    study.cells = std::move(cells);
    study.melted = std::move(melted);
    MeltRecord const& melt = study.melted.heat.melt;
    study.u_num = melt.pool_u_num;
    if (checked.melt.two_grids) {
      Case const coarse = with_cells(study.placed, coarsening * study.placed.heat.cell_size);
      BuildState plate = bare_plate(coarse);
      study.coarse = expose(plate, coarse, comm, report).melted.heat.melt.pool;
      study.u_num = error_of_two_grids(melt.pool, *study.coarse);
      wall_time.heat += plate.record.wall_time.heat;
      wall_time.rays += plate.record.wall_time.rays;
    }
    study.regime = regime_of(signs_of(study));
    study.cooling = cooling_rate(melt.probe, study.placed.material.solidus);
    LayerRecord layer;
    layer.layer = 1;
    book_melting(layer, study.build.record.ledger, study.melted, study.cells);
    study.build.record.layers.push_back(layer);
  }
  output.write(study);
  return study;
}

}  // namespace layerloop::coupling
