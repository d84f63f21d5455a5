#include "coupling/melt_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "coupling/consolidation.hpp"
#include "coupling/effects/heat_accumulation.hpp"
#include "coupling/ledger.hpp"
#include "coupling/material_mass.hpp"
#include "coupling/melt_bed.hpp"
#include "coupling/melt_output.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "coupling/scan_path.hpp"
#include "coupling/solid_field.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/surface_level.hpp"
#include "coupling/transfer.hpp"

namespace layerloop::coupling {
namespace {

/// What the case asks to be melted.
BuildState build_to_melt(Case& placed, MeltOptions const& options, Communicator const& comm) {
  if (placed.melt.bed == MeltedBed::plate) return bare_plate(placed);
  if (placed.melt.bed == MeltedBed::file) return plate_with_bed(placed, options.bed);
  std::filesystem::path const folder = options.spread.empty() ? options.folder / "spread" : options.spread;
  return spread_bed(placed, folder, comm, options.quiet);
}

struct Exposed {
  CellContent cells;
  MeltedLayer melted;
};

Exposed expose(BuildState& build, Case const& placed, std::int32_t layer, Communicator const& comm,
               thermal::Report report) {
  std::array<double, 2> const whole{placed.machine.deposition_begin(), placed.machine.deposition_end()};
  auto const [from, to] = placed.has_machine() ? heated_range(placed, layer) : whole;
  CellContent cells = cell_content(build.solid, build.bed, placed, from, to);
  MeltSurface surface(build.solid, build.bed, build.substrate, cells, placed);
  MeltedLayer melted =
      melt_layer(surface, cells, placed, start_temperature(placed, {}), layer, comm, report, build.record.wall_time);
  return {std::move(cells), std::move(melted)};
}

/// Error of the finer grid by Richardson's extrapolation, the order taken to be 2, in the place of half a cell; the
/// scatter between sections stays.
PoolSize error_of_two_grids(MeltRecord const& fine, SecondGrid const& coarse) {
  double const ratio = coarse.cell_size / fine.grid.cell;
  PoolSize error;
  for (auto member : {&PoolSize::width, &PoolSize::depth, &PoolSize::length}) {
    double const half_cell = 0.5 * fine.grid.cell, u = fine.pool_u_num.*member;
    double const scatter = std::sqrt(std::max(0.0, u * u - half_cell * half_cell));
    error.*member = std::hypot((coarse.pool.*member - fine.pool.*member) / (ratio * ratio - 1), scatter);
  }
  return error;
}

RegimeSigns signs_of(MeltStudy const& study) {
  MeltRecord const& melt = study.melted.heat.melt;
  RegimeSigns signs;
  signs.pool = melt.pool;
  signs.spot_radius = study.placed.laser.spot_radius();
  signs.molten = std::ranges::count(melt.melted, 1) > 0;
  signs.boils = study.melted.heat.peak_temperature >= study.placed.material.boiling_point;
  signs.depression = depression_of(study);
  for (double const height : study.bead_height) signs.height += height / static_cast<double>(study.bead_height.size());
  return signs;
}

/// Highest metal over the plate or part that the powder lay on, within the width of the pool at each section.
std::vector<double> bead_heights(MeltStudy const& study, HeightMap const& before) {
  HeightMap const after = top_of_solid(study.build.solid, study.placed);
  std::vector<double> heights;
  for (TrackSection const& section : study.melted.heat.melt.sections) {
    Track const& track = study.melted.exposure.source.tracks[static_cast<std::size_t>(section.track)];
    Vec3 const along = (track.end - track.begin).normalized(), across(-along.y(), along.x(), 0);
    double highest = 0;
    for (double s = -0.5 * section.width; s <= 0.5 * section.width; s += 0.5 * after.spacing) {
      auto const i = static_cast<std::int32_t>(std::floor((section.x + s * across.x() - after.x0) / after.spacing)),
                 j = static_cast<std::int32_t>(std::floor((section.y + s * across.y() - after.y0) / after.spacing));
      if (i < 0 || i >= after.nx || j < 0 || j >= after.ny) continue;
      highest = std::max(highest, after.at(i, j) - before.at(i, j));
    }
    heights.push_back(highest);
  }
  return heights;
}

/// What melted joins the solid, and the books are closed.
void solidify(MeltStudy& study, LayerRecord& layer, std::vector<double> const& mass_before) {
  BuildState& build = study.build;
  Ledger& ledger = build.record.ledger;
  ledger.particles_fed = static_cast<std::int64_t>(build.bed.size());
  ledger.mass_fed = sum_of(mass_before);
  build.record.mass_fed_by_material = mass_before;
  HeightMap const before = top_of_solid(build.solid, study.placed);
  {
    Stopwatch const timed(build.record.wall_time.mesh);
    layer.consolidation =
        consolidate(build.solid, build.bed, build.substrate, study.melted.heat.melt, study.cells, study.placed);
  }
  ledger.particles_melted = layer.consolidation.grains_melted;
  ledger.particles_trapped = layer.consolidation.grains_trapped;
  ledger.mass_melted = layer.consolidation.melted_mass;
  ledger.surface_height_correction = layer.consolidation.surface_height_correction;
  study.bead_height = bead_heights(study, before);
  audit(build, study.placed);
}

void refuse_what_cannot_be(Case const& checked) {
  if (checked.melt.two_grids && !second_cell(checked))
    throw InputError(
        fmt::format("melt.two_grids = true (no cells 1.2 to 2.1 times as large as heat.cell_size = {:.4g} um divide "
                    "machine.width and machine.deposition_length) choose lengths with more common divisors",
                    1e6 * checked.heat.cell_size));
}

/// The same grains on the same plate in larger cells. \pre nothing was melted yet
SecondGrid on_second_grid(MeltStudy& study, BuildState before, MeltOptions const& options, Communicator const& comm,
                          thermal::Report report) {
  Case coarse = study.placed;
  double const cell = *second_cell(coarse);
  if (coarse.has_machine()) {
    coarse.heat.cell_size = cell;
    double const sunk = before.solid.grid.origin.z();  // as the platform did
    before.solid = empty_solid(coarse);
    lower(before.solid, -sunk);
    before.substrate = mesh_solid(before.solid, coarse);
  } else {
    coarse = with_cells(coarse, cell);
    before = build_to_melt(coarse, options, comm);
  }
  before.record = {};
  MeltedLayer const melted = expose(before, coarse, study.layer, comm, report).melted;
  WallTime& wall_time = study.build.record.wall_time;
  wall_time.heat += before.record.wall_time.heat;
  wall_time.rays += before.record.wall_time.rays;
  return {cell, melted.heat.melt.pool, melted.exposure.mean.absorptivity};
}

/// What the finer grid lacks to vanishing cells if the error goes as the cell, as it does for light on a surface made
/// of them (Richardson).
double error_of_absorptivity(MeltStudy const& study) {
  double const ratio = study.second_grid->cell_size / study.placed.heat.cell_size;
  return std::abs(study.second_grid->absorptivity - study.melted.exposure.mean.absorptivity) / (ratio - 1);
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
  return signs.depression > signs.spot_radius ? Regime::keyhole : Regime::transition;
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

double depression_of(MeltStudy const& study) {
  if (study.placed.effect_strength("keyhole") > 0) return study.melted.heat.keyhole_depth;
  double deepest = 0;
  for (TrackSection const& section : study.melted.heat.melt.sections)
    deepest = std::max(deepest, section.boiling_depth);
  return deepest;
}

double absorptivity_uncertainty(MeltStudy const& study) {
  return std::hypot(study.melted.exposure.mean.standard_error, study.absorptivity_u_mesh);
}

std::optional<double> second_cell(Case const& checked) {
  constexpr double wanted = 1.5, least = 1.2, most = 2.1;
  double const cell = checked.heat.cell_size, width = checked.machine.width, length = checked.machine.deposition_length;
  if (!checked.has_machine()) return wanted * cell;
  std::optional<double> best;
  for (double across = std::floor(width / (least * cell) + 1e-6); across >= width / (most * cell); --across) {
    double const other = width / across, along = length / other;
    bool const fits = std::abs(along - std::round(along)) < 1e-6 * along;
    if (fits && (!best || std::abs(other / cell - wanted) < std::abs(*best / cell - wanted))) best = other;
  }
  return best;
}

MeltStudy run_melt(Case const& checked, MeltOptions const& options, Communicator const& comm) {
  refuse_what_cannot_be(checked);
  MeltStudy study;
  study.estimate = estimate_pool(checked);
  study.placed = with_plate(checked, study.estimate);
  scan_path(study.placed, 1);  // refuses a way that leaves the bed
  auto const report = comm.is_root() && !options.quiet ? thermal::Report::progress : thermal::Report::silent;
  std::optional<MeltOutput> output;
  if (!options.folder.empty()) output.emplace(study.placed, options.folder, comm);
  double making = 0, total = 0;
  {
    Stopwatch const timed(total);
    {
      Stopwatch const made(making);
      study.build = build_to_melt(study.placed, options, comm);
    }
    WallTime& wall_time = study.build.record.wall_time;
    (checked.has_machine() ? wall_time.dem : wall_time.mesh) += making;
    study.layer = std::max(1, study.build.layers_done);
    bool const powder = study.build.bed.size() > 0;
    auto [cells, melted] = expose(study.build, study.placed, study.layer, comm, report);
    study.cells = std::move(cells);
    study.melted = std::move(melted);
    MeltRecord const& melt = study.melted.heat.melt;
    study.u_num = melt.pool_u_num;
    if (checked.melt.two_grids) {
      study.second_grid = on_second_grid(study, study.build, options, comm, report);
      study.u_num = error_of_two_grids(melt, *study.second_grid);
      study.absorptivity_u_mesh = error_of_absorptivity(study);
    }
    LayerRecord layer;
    layer.layer = 1;  // the ledger of the melting is of this layer alone
    book_melting(layer, study.build.record.ledger, study.melted, study.cells);
    layer.layer = study.layer;
    if (powder) solidify(study, layer, mass_by_material(study.build.bed, study.placed));
    RegimeSigns signs = signs_of(study);
    signs.powder = powder;
    study.regime = regime_of(signs);
    study.cooling = cooling_rate(melt.probe, study.placed.material.solidus);
    double const isotherm = study.placed.heat.isotherm(checked.material);
    study.fusion = fusion_of(melt, study.cells, study.melted.exposure.source.tracks, isotherm);
    study.build.record.layers.push_back(layer);
  }
  study.build.record.wall_time.total = total;
  if (output) output->write(study);
  return study;
}

}  // namespace layerloop::coupling
