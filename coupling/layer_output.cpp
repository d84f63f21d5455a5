#include "coupling/layer_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/png_image.hpp"
#include "core/vtkhdf.hpp"
#include "core/write_file.hpp"
#include "coupling/checkpoint.hpp"
#include "coupling/program_version.hpp"
#include "coupling/report.hpp"
#include "coupling/report/csv_table.hpp"
#include "coupling/scan_path.hpp"
#include "coupling/stopwatch.hpp"
#include "dem/layer_metrics.hpp"
#include "raytrace/render.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;

std::vector<raytrace::Colour> colour_by_size(PowderBed const& bed) {
  auto const [smallest, largest] = std::minmax_element(bed.radius.begin(), bed.radius.end());
  return bed.size() == 0 ? std::vector<raytrace::Colour>{} : raytrace::colour_by(bed.radius, *smallest, *largest);
}

/// part_profile.csv: what lies between the centre lines of the outermost tracks and their ends.
void write_part_profile(fs::path const& path, SolidField const& solid, Case const& checked) {
  PathBox const patch = box_of(scan_path(checked, 1));
  CsvTable table("height [um],relative_density,columns");
  for (DensitySlice const& s : density_by_height(solid, checked.material.density, patch.lower, patch.upper))
    table.row({1e6 * s.height, s.relative_density, static_cast<double>(s.columns)});
  table.write(path);
}

std::vector<double> as_doubles(auto const& values) { return {values.begin(), values.end()}; }

}  // namespace

void write_heat_file(fs::path const& path, CellContent const& cells, MeltRecord const& melt) {
  std::vector<double> const peak = as_doubles(melt.peak_temperature), melted = as_doubles(melt.melted),
                            liquid = as_doubles(melt.time_above_liquidus);
  std::array<Field, 5> const fields{Field{"solid_fraction", "", cells.solid},
                                    Field{"powder_fraction", "", cells.powder}, Field{"peak_temperature", "K", peak},
                                    Field{"melted", "", melted}, Field{"time_above_liquidus", "s", liquid}};
  write_grid_file(path, cells.grid, fields);
}

LayerOutput::LayerOutput(Case const& checked, fs::path folder, std::vector<BedFormat> exports, Communicator const& comm)
    : checked_(checked), folder_(std::move(folder)), exports_(std::move(exports)), writes_(comm.is_root()) {
  if (!writes_) return;
  std::error_code failure;
  fs::create_directories(folder_, failure);
  if (failure) throw FileError(fmt::format("cannot make the folder {} ({})", folder_.string(), failure.message()));
  write_file(folder_ / "case_resolved.toml", resolved_toml(checked_));
}

void LayerOutput::picture(raytrace::BedScene const& scene, PowderBed const& bed, View view, LayerRecord& layer) const {
  if (!draws_pictures()) return;
  MachineSettings const& machine = checked_.machine;
  Vec3 const lower(machine.deposition_begin(), 0, -1.5 * machine.layer_thickness);
  Vec3 const upper(machine.deposition_end(), machine.width, 0.5 * machine.layer_thickness);
  bool const whole = view == View::whole_machine;
  raytrace::RenderSettings const size{.width = 960, .height = whole ? 340 : 520};
  double const aspect = static_cast<double>(size.width) / size.height;
  auto const direction = view == View::from_above ? raytrace::from_above : raytrace::oblique;
  raytrace::Camera const camera = whole ? raytrace::fit_camera(scene.lower(), scene.upper(), direction, aspect)
                                        : raytrace::fit_camera(lower, upper, direction, aspect);
  raytrace::Paint paint;
  paint.grains = colour_by_size(bed);
  auto const [name, caption] = [&]() -> std::array<std::string, 2> {
    switch (view) {
      case View::whole_machine:
        return {"machine", "Reservoir and layer after the sweep; coloured by grain size"};
      case View::oblique:
        return {"layer", checked_.has_laser()
                             ? "The layer as the laser sees it: the scene that was traced, coloured by grain size"
                             : "The layer, coloured by grain size"};
      case View::from_above:
        return {"layer_top", "The same scene from above"};
      case View::part:
        return {"part", "After the exposure: the part and the grains that stayed whole"};
    }
    return {};
  }();
  std::string const file = fmt::format("{}_{:04}.png", name, layer.layer);
  write_png(raytrace::render(scene, camera, paint, size), folder_ / file);
  layer.pictures.push_back({file, caption});
}

void LayerOutput::grid(CellContent const& cells, MeltRecord const& melt, LayerRecord const& layer) const {
  if (writes_) write_heat_file(folder_ / fmt::format("heat_{:04}.h5", layer.layer), cells, melt);
}

void LayerOutput::layer(BuildState& build) const {
  if (!writes_) return;
  Stopwatch const timed(build.record.wall_time.io);
  LayerRecord const& layer = build.record.layers.back();
  write_bed_file(folder_ / fmt::format("bed_{:04}.h5", layer.layer), build.bed, build.substrate, {});
  for (BedFormat const format : exports_) {
    double const plate = -checked_.machine.layer_thickness * layer.layer;
    std::optional<double> const density =
        checked_.admixtures.empty() ? std::optional(checked_.material.density) : std::nullopt;
    BedFile const file{build.bed, std::nullopt, checked_.machine.width, plate, density};
    write_bed(folder_ / fmt::format("bed_{:04}.{}", layer.layer, extension(format)), file, format);
  }
  write_stl(build.substrate, folder_ / fmt::format("solid_{:04}.stl", layer.layer));
  nlohmann::json const line{{"event", "layer_done"},
                            {"layer", layer.layer},
                            {"grains_fed", build.record.ledger.particles_fed},
                            {"bond_number", layer.stroke.bond_number},
                            {"steps_per_contact", layer.stroke.steps_per_contact},
                            {"largest_overlap", layer.stroke.largest_overlap},
                            {"volume_fraction_real", layer.metrics.volume_fraction_real},
                            {"absorptivity", layer.absorptivity},
                            {"grains_melted", layer.consolidation.grains_melted},
                            {"mass_relative_error", build.record.ledger.mass_relative_error},
                            {"seconds", build.record.wall_time.total}};
  std::ofstream log(folder_ / "log.jsonl", std::ios::app);
  log << line.dump() << '\n';
  log.close();
  if (!log) throw FileError(fmt::format("cannot write {}; is the disk full?", (folder_ / "log.jsonl").string()));
  if (checked_.run.checkpoint) save_checkpoint(folder_, build, resolved_toml(checked_));
}

void LayerOutput::end(BuildState const& build) const {
  if (!writes_) return;
  ReportExtras const extras{program_version(), dem::definitions()};
  write_file(folder_ / "summary.json", summary(checked_, build.record, extras).dump(2) + "\n");
  write_report(folder_, checked_, build.record, build.bed, build.substrate, extras);
  if (checked_.has_laser()) write_part_profile(folder_ / "part_profile.csv", build.solid, checked_);
}

}  // namespace layerloop::coupling
