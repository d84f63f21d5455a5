#pragma once
#include <filesystem>
#include <limits>

#include "core/case.hpp"
#include "core/case_schema.hpp"
#include "core/material.hpp"
#include "core/png_image.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/run_record.hpp"

namespace layerloop::coupling {

/// A made-up run, small and complete, whose words would do harm on a page that does not escape them.
struct SampleRun {
  Case checked;
  RunRecord record;
  PowderBed bed;
  TriangleSurface part;
  ReportExtras extras{"1.2.3", {{"effective_thickness", "a <i>sentence</i> & \"quotes\""}}};
};

inline Case sample_case() {
  Case checked;
  checked.name = "<script>alert('x')</script> & {{style}}";
  checked.seed = 42;
  checked.preset = "none";
  checked.material = built_in_materials().at("IN718");
  checked.powder = {.material = "IN718",
                    .basis = SizeBasis::number,
                    .diameters = {13e-6, 28e-6},
                    .fractions = {0.25, 0.75},
                    .particles = 4};
  checked.machine.layer_thickness = 60e-6;
  checked.machine.recoating_speed = 0.1;
  checked.machine.accumulation_length = 100e-6;
  checked.machine.deposition_length = 200e-6;
  checked.machine.width = 50e-6;
  checked.laser.power = 150;
  checked.laser.spot_diameter = 80e-6;
  checked.scan = {.kind = ScanKind::hatch,
                  .scan_speed = 0.8,
                  .track_length = 100e-6,
                  .tracks = 2,
                  .hatch_spacing = 80e-6,
                  .rotation = 0,
                  .dwell = 0};
  checked.heat.ambient_temperature = 300;
  checked.heat.pool_isotherm = "liquidus";
  for (std::string const& table : case_tables())
    if (table.starts_with("effects.")) checked.effects[table.substr(8)] = {};
  return checked;
}

inline LayerRecord sample_layer(std::int32_t n) {
  LayerRecord layer;
  layer.layer = n;
  layer.grains_in_layer = 3;
  layer.grains_nipped = 1;
  layer.metrics.effective_thickness = 21e-6;
  layer.metrics.bins.resize(2);
  layer.metrics.bins[0].x = 110e-6;
  layer.metrics.bins[1].x = 190e-6;
  layer.metrics.bins[1].volume_fraction_real = std::numeric_limits<double>::quiet_NaN();
  AreaMap const map{
      .x0 = 100e-6, .y0 = 0, .spacing = 10e-6, .nx = 20, .ny = 5, .values = std::vector<double>(100, -30e-6)};
  layer.metrics.surface = layer.part_surface = layer.absorbed_energy = map;
  for (double& value : layer.absorbed_energy.values) value = 1.5e6;
  layer.blade_note = "the blade <b>touches</b>";
  layer.absorptivity = 0.61;
  layer.absorptivity_standard_error = 0.004;
  layer.pool = {118e-6, 41e-6, 300e-6};
  layer.pool_u_num = {5e-6, 3e-6, 6e-6};
  layer.sections = {{.x = 150e-6,
                     .y0 = 0,
                     .z0 = -100e-6,
                     .cell = 10e-6,
                     .ny = 5,
                     .nz = 2,
                     .peak_temperature = {400, 500, 1900, 500, 400, 300, 300, 2500, 300, 300},
                     .state = {2, 2, 6, 2, 2, 0, 1, 5, 1, 0}}};
  layer.consolidation.melted_mass = 2e-10;
  layer.consolidation.melted_cell_mass = 1.5e-10;
  layer.consolidation.part_relative_density = 0.98;
  return layer;
}

inline SampleRun sample_run() {
  SampleRun run{.checked = sample_case(), .record = {}, .bed = {}, .part = {}};
  run.record.layers = {sample_layer(1), sample_layer(2)};
  run.record.ledger.particles_fed = run.record.ledger.particles_bed = 3;
  run.record.wall_time = {.dem = 1, .rays = 2, .heat = 3, .mesh = 0.5, .io = 0.1, .total = 7};
  run.bed.add(1, Vec3(50e-6, 20e-6, -40e-6), 14e-6, 0);
  run.bed.add(2, Vec3(150e-6, 30e-6, -80e-6), 6.5e-6, 0);
  run.bed.add(3, Vec3(250e-6, 10e-6, -90e-6), 14e-6, 0);
  run.part.vertices = {Vec3(100e-6, 0, -120e-6), Vec3(300e-6, 0, -120e-6), Vec3(100e-6, 50e-6, -120e-6)};
  run.part.triangles = {{0, 1, 2}};
  return run;
}

/// Puts the pictures that the record names into the folder.
inline void add_pictures(SampleRun& run, std::filesystem::path const& folder) {
  Image const red{2, 1, {255, 0, 0, 255, 0, 0}};
  write_png(red, folder / "bed_0001.png");
  run.record.layers[0].pictures = {{"bed_0001.png", "grains \"from\" <above>"}};
}

}  // namespace layerloop::coupling
