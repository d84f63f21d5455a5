#include "coupling/layer_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "coupling/build_state.hpp"
#include "coupling/checkpoint.hpp"
#include "coupling/consolidation.hpp"
#include "coupling/cost.hpp"
#include "coupling/effects/denudation.hpp"
#include "coupling/effects/heat_accumulation.hpp"
#include "coupling/first_bed.hpp"
#include "coupling/freeze_zone.hpp"
#include "coupling/layer_output.hpp"
#include "coupling/ledger.hpp"
#include "coupling/material_mass.hpp"
#include "coupling/melt_bed.hpp"
#include "coupling/melt_layer.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "coupling/scan_path.hpp"
#include "coupling/solid_on_plate.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/surface_level.hpp"
#include "coupling/transfer.hpp"
#include "dem/dosing.hpp"
#include "dem/heap_angle.hpp"
#include "dem/layer_metrics.hpp"
#include "dem/machine_rig.hpp"
#include "dem/recoater.hpp"
#include "dem/reservoir.hpp"

namespace layerloop::coupling {
namespace {

/// What stays the same through a run.
struct Run {
  Case const& checked;
  RunOptions const& options;
  Communicator const& comm;
  LayerOutput output;
  bool show_progress() const { return comm.is_root() && !options.quiet; }
};

/// The plate goes down by one layer and takes part, mesh and the powder on it along.
void lower(Run const& run, BuildState& build) {
  double const drop = run.checked.machine.layer_thickness;
  lower(build.solid, drop);
  build.substrate.shift(Vec3(0, 0, -drop));
  dem::lower_plate(build.bed, dem::case_of_layer(run.checked, build.layers_done));
}

/// The accumulation zone gets its powder, and it settles.
void dose(Run const& run, BuildState& build) {
  Stopwatch const timed(build.record.wall_time.dem);
  Ledger& ledger = build.record.ledger;
  std::int64_t const count = build.layers_done == 1 ? run.checked.powder.particles : dose_count(run.checked);
  std::vector<double> const before = mass_by_material(build.bed, run.checked);
  dem::EnergyLedger energy;
  build.next_id = dem::dose(build.bed, dem::case_of_layer(run.checked, build.layers_done), build.substrate, count,
                            build.next_id, run.comm, run.show_progress(), &energy);
  book_motion(ledger, energy);
  ledger.particles_fed += count;
  std::vector<double> const after = mass_by_material(build.bed, run.checked);
  for (std::size_t m = 0; m < after.size(); ++m) build.record.mass_fed_by_material.at(m) += after[m] - before[m];
  ledger.mass_fed = sum_of(build.record.mass_fed_by_material);
}

double mass_of(dem::Reservoir const& reservoir, Case const& checked) {
  double mass = 0;
  for (std::size_t m = 0; m < reservoir.volume_of_material.size(); ++m)
    mass += checked.density(static_cast<std::int32_t>(m)) * reservoir.volume_of_material[m];
  return mass;
}

/// What the stroke did to feed and heap. \param feed  before it
StrokeMetrics stroke_metrics(dem::Reservoir const& feed, dem::Reservoir const& left, dem::HeapWatch const& heap,
                             dem::SpreadOutcome const& sweep, Case const& checked) {
  return {.settled_height = feed.height,
          .settled_density = feed.density,
          .reservoir_mean_diameter_before = feed.mean_diameter,
          .reservoir_mean_diameter = left.mean_diameter,
          .reservoir_mass_ratio = mass_of(left, checked) / mass_of(feed, checked),
          .heap_angle_accumulation = heap.accumulation().mean,
          .heap_angle_accumulation_u_num = heap.accumulation().standard_error,
          .heap_angle_deposition = heap.deposition().mean,
          .heap_angle_deposition_u_num = heap.deposition().standard_error,
          .blade_force = sweep.blade_force,
          .mean_blade_force = sweep.mean_blade_force,
          .bond_number = sweep.bond_number,
          .steps_per_contact = sweep.steps_per_contact,
          .largest_overlap = sweep.largest_overlap};
}

/// The blade sweeps; what it leaves is measured.
void spread(Run const& run, BuildState& build, LayerRecord& layer) {
  Stopwatch const timed(build.record.wall_time.dem);
  HeightMap const base = top_of_solid(build.solid, run.checked);
  dem::LayerBase const before = dem::layer_base(build.bed, base, run.checked);
  Case const now = dem::case_of_layer(run.checked, build.layers_done);
  MachineSettings const& machine = now.machine;
  dem::Reservoir const feed = dem::measure_reservoir(build.bed, machine);
  dem::HeapWatch heap(machine, feed.surface);
  dem::SpreadOutcome const sweep =
      dem::spread(build.bed, now, build.substrate, run.comm, run.show_progress(), std::ref(heap));
  layer.metrics = dem::measure_layer(build.bed, base, before, run.checked);
  layer.stroke = stroke_metrics(feed, dem::measure_reservoir(build.bed, machine), heap, sweep, run.checked);
  for (LayerBin const& bin : layer.metrics.bins) layer.grains_in_layer += bin.grains;
  layer.blade_note = sweep.blade_note;
  layer.grains_nipped = sweep.nipped_grains;

  Ledger& ledger = build.record.ledger;
  book_motion(ledger, sweep.energy);
  ledger.particles_overflow += sweep.overflow_grains;
  ledger.mass_overflow += sweep.overflow_mass;
  if (!run.checked.admixtures.empty())
    layer.materials = material_shares(build.bed, before.grains, build.record.mass_fed_by_material, run.checked);
}

/// The first layer as it was dosed and spread before, for another laser.
void take_first_layer(Run const& run, BuildState& build, LayerRecord& layer) {
  Case first = run.checked;
  first.run.layers = 1;
  BuildState spread = spread_layers(first, run.options.first_layer, run.comm, true);
  build.bed = std::move(spread.bed);
  build.next_id = spread.next_id;
  build.record.ledger = spread.record.ledger;
  build.record.mass_fed_by_material = spread.record.mass_fed_by_material;
  layer = spread.record.layers.back();
}

/// Pictures are drawn by the root rank from the scene that is traced.
void picture(Run const& run, BuildState& build, raytrace::BedScene const& scene, std::initializer_list<View> views,
             LayerRecord& layer) {
  Stopwatch const timed(build.record.wall_time.io);
  for (View const view : views) run.output.picture(scene, build.bed, view, layer);
}

/// Heat that the layers so far have absorbed, per area of the part [J/m^2].
std::vector<double> energy_of_layers(RunRecord const& record, Case const& checked) {
  std::vector<double> energy;
  for (LayerRecord const& layer : record.layers) {
    AreaMap const& map = layer.absorbed_energy;
    energy.push_back(std::reduce(map.values.begin(), map.values.end()) * map.spacing * map.spacing /
                     part_area(checked));
  }
  return energy;
}

/// The laser on the layer as it was spread.
MeltRecord expose(Run const& run, BuildState& build, LayerRecord& layer, CellContent const& cells) {
  MeltSurface surface(build.solid, build.bed, build.substrate, cells, run.checked);
  picture(run, build, surface.scene(), {View::whole_machine, View::oblique, View::from_above}, layer);
  auto const report = run.show_progress() ? thermal::Report::progress : thermal::Report::silent;
  double const start = start_temperature(run.checked, energy_of_layers(build.record, run.checked));
  MeltedLayer const melted =
      melt_layer(surface, cells, run.checked, start, layer.layer, run.comm, report, build.record.wall_time);
  book_melting(layer, build.record.ledger, melted, cells);
  run.output.grid(cells, melted.heat.melt, layer);
  return melted.heat.melt;
}

/// Pictures of bed and solid as they are now.
void show(Run const& run, BuildState& build, std::initializer_list<View> views, LayerRecord& layer) {
  if (!run.output.draws_pictures()) return;
  raytrace::BedScene const scene(build.bed, build.substrate, {0.0, run.checked.machine.width});
  picture(run, build, scene, views, layer);
}

/// Melted or frozen grains become part of the solid, and the solid's new surface is meshed.
void consolidate(Run const& run, BuildState& build, LayerRecord& layer) {
  Case const& checked = run.checked;
  if (checked.machine.frozen_zone) {
    Stopwatch const timed(build.record.wall_time.mesh);
    layer.consolidation = freeze_zone(build.solid, build.bed, build.substrate, checked);
  } else {
    auto const [from, to] = heated_range(checked, layer.layer);
    CellContent const cells = cell_content(build.solid, build.bed, checked, from, to);
    MeltRecord const melt = expose(run, build, layer, cells);
    Stopwatch const timed(build.record.wall_time.mesh);
    layer.consolidation = consolidate(build.solid, build.bed, build.substrate, melt, cells, checked);
    book_lost(build.record.ledger, denude(build.bed, scan_path(checked, layer.layer), checked, layer.layer));
  }
  layer.part_surface = top_of_solid(build.solid, checked);
  show(run, build, {View::part}, layer);

  Ledger& ledger = build.record.ledger;
  ledger.particles_melted += layer.consolidation.grains_melted;
  ledger.particles_trapped += layer.consolidation.grains_trapped;
  ledger.mass_melted += layer.consolidation.melted_mass;
  ledger.surface_height_correction += layer.consolidation.surface_height_correction;
}

/// One layer, as the machine makes it.
void build_layer(Run const& run, BuildState& build) {
  LayerRecord layer;
  layer.layer = ++build.layers_done;
  lower(run, build);
  if (layer.layer == 1 && !run.options.first_layer.empty()) {
    take_first_layer(run, build, layer);
  } else {
    dose(run, build);
    spread(run, build, layer);
  }
  if (!run.checked.has_laser()) show(run, build, {View::whole_machine, View::oblique, View::from_above}, layer);
  if (run.checked.has_part()) consolidate(run, build, layer);
  build.record.layers.push_back(layer);
  audit(build, run.checked);
}

BuildState first_state(Case const& checked, RunOptions const& options, Communicator const& comm) {
  if (options.resume) {
    std::string skipped;
    std::optional<BuildState> found = load_newest_checkpoint(options.folder, resolved_toml(checked), skipped);
    if (!skipped.empty() && comm.is_root()) fmt::print(stderr, "{}\n", skipped);
    if (found) return *found;
  }
  BuildState build;
  build.solid = solid_on_plate(checked);
  build.substrate = mesh_solid(build.solid, checked);
  build.bed = first_bed(checked);
  if (build.bed.size() > 0) build.next_id = build.bed.id.back() + 1;
  build.record.ledger.particles_fed = static_cast<std::int64_t>(build.bed.size());
  build.record.mass_fed_by_material = mass_by_material(build.bed, checked);
  build.record.ledger.mass_fed = sum_of(build.record.mass_fed_by_material);
  return build;
}

}  // namespace

RunRecord run_layer_loop(Case const& checked, RunOptions const& options, Communicator const& comm) {
  BuildState build = first_state(checked, options, comm);  // refuses bad input before anything is written
  Run const run{checked, options, comm, LayerOutput(checked, options.folder, options.exports, comm)};
  while (build.layers_done < checked.run.layers) {
    {
      Stopwatch const timed(build.record.wall_time.total);
      build_layer(run, build);
    }
    {
      Stopwatch const timed(build.record.wall_time.total);
      run.output.layer(build);
    }
    if (comm.any(stop_requested()) && build.layers_done < checked.run.layers)
      throw StoppedBySignal("stopped by a signal after a checkpoint (as asked) go on with --resume");
  }
  run.output.end(build);
  return build.record;
}

}  // namespace layerloop::coupling
