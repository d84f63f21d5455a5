#include "coupling/melt_bed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bed_file.hpp"
#include "core/case_file.hpp"
#include "core/effect_catalogue.hpp"
#include "core/error.hpp"
#include "coupling/checkpoint.hpp"
#include "coupling/layer_loop.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {
namespace {

/// Copies of a tile along one axis that reach from one end of the plate to the other.
struct Copies {
  std::int64_t first = 0, last = 0;
};

Copies copies_over(double period, double shift, double plate) {
  if (period == 0) return {};
  // The tile [0, period) goes to [shift, shift + period).
  return {static_cast<std::int64_t>(std::floor(-shift / period)),
          static_cast<std::int64_t>(std::ceil((plate - shift) / period)) - 1};
}

/// What moves the middle of the bed to the middle of the plate.
double shift_of(std::vector<double> const& coordinate, double period, double plate) {
  auto const [low, high] = std::ranges::minmax(coordinate);
  return 0.5 * plate - (period > 0 ? 0.5 * period : 0.5 * (low + high));
}

/// Grains that lie on the plate, renumbered.
PowderBed laid_out(BedFile const& file, double floor, double size_x, double size_y) {
  PowderBed const& from = file.bed;
  std::array<double, 2> const period{*file.periodic_x, *file.periodic_y};
  double const shift_x = shift_of(from.x, period[0], size_x), shift_y = shift_of(from.y, period[1], size_y);
  Copies const along = copies_over(period[0], shift_x, size_x), across = copies_over(period[1], shift_y, size_y);
  PowderBed bed;
  for (std::int64_t b = across.first; b <= across.last; ++b) {
    for (std::int64_t a = along.first; a <= along.last; ++a) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        double const x = from.x[i] + shift_x + static_cast<double>(a) * period[0],
                     y = from.y[i] + shift_y + static_cast<double>(b) * period[1];
        if (x < 0 || x >= size_x || y < 0 || y >= size_y) continue;
        bed.add(static_cast<std::int64_t>(bed.size()), {x, y, from.z[i] - floor}, from.radius[i], from.material[i]);
      }
    }
  }
  return bed;
}

/// What grains have of their metal.
Material grain_metal(Material const& metal) {
  Material grains;
  grains.name = metal.name;
  grains.density = metal.density;
  return grains;
}

}  // namespace

BuildState bare_plate(Case const& placed) {
  BuildState build;
  build.solid = empty_solid(placed);
  build.substrate = mesh_solid(build.solid, placed);
  return build;
}

BuildState plate_with_bed(Case& placed, BedSource const& source) {
  BedFile const file = read_source(source, placed);
  if (file.bed.size() == 0)
    throw InputError(fmt::format("{} holds no grain (there is nothing to melt on the plate) use melt.bed = \"plate\"",
                                 source.bed.string()));
  double const floor = file.floor_z.value_or(0);
  for (std::size_t i = 0; i < file.bed.size(); ++i) {
    if (file.bed.z[i] - floor < 0.9 * file.bed.radius[i])
      throw InputError(
          fmt::format("{}: grain {} is in the floor (z = {:.4g} m, radius {:.4g} m, floor at {:.4g} m) give its level "
                      "by --floor-z; of a whole machine "
                      "keep the deposition zone alone, or melt the case that spreads it",
                      source.bed.string(), file.bed.id[i], file.bed.z[i], file.bed.radius[i], floor));
  }
  placed.powder.diameters = {2 * std::ranges::max(file.bed.radius)};
  BuildState build = bare_plate(placed);
  build.bed = laid_out(file, floor, placed.machine.deposition_length, placed.machine.width);
  if (build.bed.size() == 0)
    throw InputError(fmt::format("no grain of {} lies on the plate (the bed has a hole in its middle) use another bed",
                                 source.bed.string()));
  build.next_id = static_cast<std::int64_t>(build.bed.size());
  return build;
}

Case what_spreading_reads(Case const& checked) {
  Case spreading = checked;
  spreading.process = Process::spreading;
  spreading.laser = {};
  spreading.optics = {};
  spreading.scan = {};
  spreading.heat = {.cell_size = checked.heat.cell_size};  // of the lattice in which the part lies
  spreading.calibrate = {};
  spreading.absorb = {};
  spreading.melt = {};
  for (Effect const& effect : effect_catalogue()) {
    if (effect.stage != EffectStage::dem) spreading.effects[effect.name] = {};
  }
  spreading.material = grain_metal(checked.material);
  if (checked.floor_material) spreading.floor_material = grain_metal(*checked.floor_material);
  std::ranges::transform(checked.admixtures, spreading.admixtures.begin(), grain_metal);
  spreading.run.replicates = 1;
  spreading.run.checkpoint = true;
  return spreading;
}

BuildState spread_layers(Case const& checked, std::filesystem::path const& folder, Communicator const& comm,
                         bool quiet) {
  Case const spreading = what_spreading_reads(checked);
  std::string const text = resolved_toml(spreading);
  std::string skipped;
  std::optional<BuildState> build = load_newest_checkpoint(folder, text, skipped);
  if (build && build->layers_done == checked.run.layers) return *build;
  RunOptions options;
  options.folder = folder;
  options.resume = true;
  options.quiet = quiet;
  run_layer_loop(spreading, options, comm);
  build = load_newest_checkpoint(folder, text, skipped);
  if (!build) throw FileError(fmt::format("the bed that was spread in {} cannot be read again", folder.string()));
  return *build;
}

BuildState spread_bed(Case const& checked, std::filesystem::path const& folder, Communicator const& comm, bool quiet) {
  BuildState build = spread_layers(checked, folder, comm, quiet);
  build.record = {};
  return build;
}

}  // namespace layerloop::coupling
