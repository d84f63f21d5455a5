#include "coupling/absorption_study.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "core/statistics.hpp"
#include "coupling/absorption_output.hpp"
#include "coupling/optics_of_case.hpp"
#include "coupling/stopwatch.hpp"

namespace layerloop::coupling {
namespace {

/// The case's own light and metal, then what else was asked for, one thing changed at a time.
std::vector<raytrace::OpticalSet> optical_sets(Case const& checked, AbsorbOptions const& options) {
  std::vector<raytrace::OpticalSet> sets{optical_set(checked, "the case")};
  for (std::string const& metal : options.materials) sets.push_back(optical_set(with_powder_of(checked, metal), metal));
  for (double const wavelength : options.wavelengths)
    sets.push_back(optical_set(with_wavelength(checked, wavelength), fmt::format("{:.4g} nm", wavelength * 1e9)));
  for (double const temperature : options.temperatures) {
    Case heated = checked;
    heated.optics.temperature = temperature;
    sets.push_back(optical_set(heated, fmt::format("{:.4g} K", temperature)));
  }
  return sets;
}

raytrace::AbsorptionSettings settings_of(Case const& checked, AbsorbOptions const& options, LitBed const& lit,
                                         std::uint64_t bed) {
  raytrace::AbsorptionSettings settings;
  settings.rays = checked.optics.rays;
  settings.max_rays = std::max(checked.absorb.max_rays, checked.optics.rays);
  settings.seed = checked.seed;
  settings.id = bed;
  settings.polarisation = polarisation_of(checked);
  settings.diffuse_share = diffuse_share(checked);
  settings.target_standard_error = checked.absorb.target_standard_error;
  settings.derivatives = options.derivatives;
  settings.depth_bins = checked.absorb.depth_bins;
  settings.depth_range = {lit.lower.z(), lit.upper.z()};
  settings.map_spacing = checked.absorb.map_spacing;
  return settings;
}

struct NamedBed {
  std::string name;
  LitBed lit;
};

NamedBed make_bed(Case const& checked, AbsorbOptions const& options, std::size_t k, Communicator const& comm) {
  if (checked.absorb.bed == AbsorbingBed::file)
    return {options.beds[k].bed.filename().string(), bed_of_file(checked, options.beds[k])};
  Case seeded = checked;
  seeded.seed += k;
  std::string const name = fmt::format("seed {}", seeded.seed);
  if (checked.absorb.bed == AbsorbingBed::settled) return {name, bed_that_settles(seeded, comm, !options.quiet)};
  std::filesystem::path const folder =
      options.spread.empty() ? options.folder / fmt::format("spread_seed_{}", seeded.seed) : options.spread;
  return {name, bed_that_is_spread(seeded, folder, comm, options.quiet)};
}

void make_folder(std::filesystem::path const& folder, Communicator const& comm) {
  std::error_code failure;
  if (comm.is_root()) std::filesystem::create_directories(folder, failure);
  if (comm.any(static_cast<bool>(failure)))
    throw FileError(fmt::format("cannot make the folder {} ({})", folder.string(), failure.message()));
}

}  // namespace

AbsorptionFigure figure_over_beds(std::vector<double> const& values, std::vector<double> const& errors) {
  Sample const sample = sample_of(values);
  double squares = 0;
  for (double const error : errors) squares += error * error;
  double const n = static_cast<double>(values.size());
  return {.value = sample.mean,
          .standard_error = std::sqrt(squares) / n,
          .n = sample.n,
          .u_bed = sample.half_width,
          .sd_bed = std::sqrt(std::max(sample.sd * sample.sd - squares / n, 0.0))};
}

AbsorptionFigure AbsorptionStudy::absorptivity(std::size_t set) const {
  std::vector<double> values, errors;
  for (BedAbsorption const& bed : beds) {
    values.push_back(bed.light.sets[set].absorptivity);
    errors.push_back(bed.light.sets[set].standard_error);
  }
  return figure_over_beds(values, errors);
}

AbsorptionFigure AbsorptionStudy::by_material(std::size_t set, std::size_t material) const {
  std::vector<double> values, errors;
  for (BedAbsorption const& bed : beds) {
    values.push_back(bed.light.sets[set].by_material[material]);
    errors.push_back(bed.light.sets[set].by_material_error[material]);
  }
  return figure_over_beds(values, errors);
}

AbsorptionFigure AbsorptionStudy::substrate(std::size_t set) const {
  std::vector<double> values, errors;
  for (BedAbsorption const& bed : beds) {
    values.push_back(bed.light.sets[set].substrate);
    errors.push_back(bed.light.sets[set].substrate_error);
  }
  return figure_over_beds(values, errors);
}

AbsorptionStudy run_absorption(Case const& checked, AbsorbOptions const& options, Communicator const& comm) {
  AbsorptionStudy study;
  study.sets = optical_sets(checked, options);  // refuses bad input before anything is written
  bool const writes = !options.folder.empty();
  if (writes) make_folder(options.folder, comm);
  bool const from_files = checked.absorb.bed == AbsorbingBed::file;
  std::size_t const beds = from_files ? options.beds.size() : static_cast<std::size_t>(checked.run.replicates);
  for (std::size_t k = 0; k < beds; ++k) {
    NamedBed made;
    {
      Stopwatch const timed(study.time_dem);
      made = make_bed(checked, options, k, comm);
    }
    if (writes && comm.is_root() && !from_files)
      write_lit_bed(options.folder / fmt::format("bed_{:04}.csv", k + 1), made.lit);
    Stopwatch const timed(study.time_rays);
    raytrace::BedScene const scene(made.lit.bed, made.lit.surface, made.lit.period);
    study.beam = beam_over(made.lit, checked);
    raytrace::Absorption light = raytrace::absorb(scene, study.beam, study.sets, floor_index(checked),
                                                  settings_of(checked, options, made.lit, k), &comm);
    study.beds.push_back({made.name, made.lit.origin, measure(made.lit, scene), std::move(light)});
    study.last = std::move(made.lit);
  }
  if (writes && comm.is_root()) write_absorption(options.folder, checked, study);
  return study;
}

}  // namespace layerloop::coupling
