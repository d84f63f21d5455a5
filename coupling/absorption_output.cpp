#include "coupling/absorption_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/bed_file.hpp"
#include "core/case_file.hpp"
#include "core/json_number.hpp"
#include "core/png_image.hpp"
#include "core/write_file.hpp"
#include "coupling/optics_of_case.hpp"
#include "coupling/program_version.hpp"
#include "coupling/report/csv_table.hpp"
#include "raytrace/render.hpp"

namespace layerloop::coupling {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

void put(json& to, std::string const& name, AbsorptionFigure const& figure) {
  to[name] = number(figure.value);
  to[name + "_u_num"] = number(figure.standard_error);
  to[name + "_n"] = figure.n;
  if (figure.n < 2) return;
  to[name + "_u_bed"] = number(figure.u_bed);
  to[name + "_sd_bed"] = number(figure.sd_bed);
}

json ledger(AbsorptionStudy const& study) {
  raytrace::SetAbsorption const& set = study.beds.back().light.sets[0];
  double const power = study.beam.power;
  return {{"power_incident", power},
          {"power_absorbed", power * set.absorptivity},
          {"power_escaped", power * set.escaped},
          {"power_residual", power * set.residual},
          {"power_rescaling", 0},
          {"ray_energy_relative_error", std::abs(1 - set.absorptivity - set.escaped - set.residual)}};
}

json materials(Case const& checked, AbsorptionStudy const& study) {
  json all;
  std::vector<std::string> const names = surface_names(checked);
  std::vector<Material> metals = checked.materials();
  if (names.size() > metals.size() && checked.floor_material) metals.push_back(*checked.floor_material);
  for (std::size_t m = 0; m < names.size(); ++m) {
    raytrace::Surface const& surface = study.sets[0].surface[m];
    json& entry = all[names[m]];
    if (surface.grey_reflectance) {
      entry["grey_reflectance"] = *surface.grey_reflectance;
      continue;
    }
    entry["refractive_index"] = {surface.refractive_index.real(), surface.refractive_index.imag()};
    entry["flat_absorptivity"] = 1 - raytrace::reflectance(surface, checked.laser.wavelength, 1);
    entry["source"] = optical_source(metals[m]);
    if (surface.film_thickness > 0) {
      entry["oxide_thickness"] = surface.film_thickness;
      entry["oxide_index"] = {surface.film_index.real(), surface.film_index.imag()};
    }
  }
  return all;
}

json sets(Case const& checked, AbsorptionStudy const& study) {
  std::vector<std::string> const names = surface_names(checked);
  json all = json::array();
  for (std::size_t k = 0; k < study.sets.size(); ++k) {
    json entry{{"name", study.sets[k].name}, {"wavelength", study.sets[k].wavelength}};
    raytrace::Surface const& first = study.sets[k].surface[0];
    if (!first.grey_reflectance)
      entry["refractive_index"] = {first.refractive_index.real(), first.refractive_index.imag()};
    put(entry, "absorptivity", study.absorptivity(k));
    raytrace::SetAbsorption const& last = study.beds.back().light.sets[k];
    for (std::size_t m = 0; m < last.d_n.size(); ++m)
      entry["derivatives"][names[m]] = {{"d_n", last.d_n[m]},
                                        {"d_n_u_num", last.d_n_error[m]},
                                        {"d_k", last.d_k[m]},
                                        {"d_k_u_num", last.d_k_error[m]}};
    all.push_back(entry);
  }
  return all;
}

json beds(AbsorptionStudy const& study) {
  json all = json::array();
  for (BedAbsorption const& bed : study.beds)
    all.push_back({{"name", bed.name},
                   {"origin", bed.origin},
                   {"grains", bed.measures.grains},
                   {"solid_thickness", bed.measures.solid_thickness},
                   {"mean_height", bed.measures.mean_height},
                   {"packing_density", number(bed.measures.packing_density)},
                   {"mean_diameter", bed.measures.mean_diameter},
                   {"absorptivity", bed.light.sets[0].absorptivity},
                   {"absorptivity_u_num", bed.light.sets[0].standard_error},
                   {"rays", bed.light.rays},
                   {"mean_bounces", bed.light.mean_bounces},
                   {"target_reached", bed.light.target_reached}});
  return all;
}

json definitions() {
  return {
      {"absorptivity", "share of the power that falls on the lit area which bed and floor absorb; mean over the beds"},
      {"standard_error", "of the absorptivity, from independently shifted sets of rays; says nothing of other beds"},
      {"*_u_num", "standard error from the rays alone"},
      {"*_u_bed", "half width of the 95 % t-interval of the mean over *_n beds"},
      {"*_sd_bed", "standard deviation from bed to bed, the rays' share taken out"},
      {"by_material", "share of the incident power that grains and floor of this material absorb"},
      {"substrate", "share of the incident power that the floor or mesh absorbs; part of by_material"},
      {"depth_profile",
       "fraction of the incident power absorbed in a slice whose middle is z, of the last bed; the "
       "outermost slices hold what lies beyond"},
      {"mean_bounces", "surface hits per ray"},
      {"solid_thickness", "volume of the grains in the lit area over that area [m]"},
      {"packing_density", "that volume over the volume below what is seen from above"},
      {"mean_diameter", "Sauter diameter [m]"},
      {"flat_absorptivity", "of a flat surface of the same metal at normal incidence"},
      {"derivatives", "of the absorptivity with respect to n and k of a material"},
  };
}

void write_tables(fs::path const& folder, AbsorptionMap const& map, Case const& checked, AbsorptionStudy const& study) {
  BedAbsorption const& last = study.beds.back();
  CsvTable profile("z [um],absorbed fraction,standard error");
  for (raytrace::DepthLayer const& layer : last.light.depth_profile)
    profile.row({1e6 * layer.z, layer.fraction, layer.error});
  profile.write(folder / "depth_profile.csv");

  CsvTable pixels(checked.optics.uniform_beam ? "x [um],y [um],local absorptivity,standard error"
                                              : "x [um],y [um],absorbed share per area [1/mm2],standard error [1/mm2]");
  double const unit = checked.optics.uniform_beam ? 1 : 1e-6;
  for (std::int32_t j = 0; j < map.value.ny; ++j)
    for (std::int32_t i = 0; i < map.value.nx; ++i)
      pixels.row({1e6 * (map.value.x0 + (i + 0.5) * map.value.spacing),
                  1e6 * (map.value.y0 + (j + 0.5) * map.value.spacing), unit * map.value.at(i, j),
                  unit * map.error.at(i, j)});
  pixels.write(folder / "absorptivity_map.csv");

  CsvTable grains("x [um],y [um],z [um],radius [um],material,absorbed share");
  PowderBed const& bed = study.last.bed;
  for (std::size_t i = 0; i < bed.size(); ++i)
    grains.row({1e6 * bed.x[i], 1e6 * bed.y[i], 1e6 * bed.z[i], 1e6 * bed.radius[i],
                static_cast<double>(bed.material[i]), last.light.grain_share[i]});
  grains.write(folder / "grains.csv");

  std::string sets = "set,wavelength [nm],n,k,absorptivity,standard error,u_bed,sd_bed,beds\n";
  for (std::size_t k = 0; k < study.sets.size(); ++k) {
    AbsorptionFigure const a = study.absorptivity(k);
    auto const index = study.sets[k].surface[0].refractive_index;
    auto const blank = [](double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string(); };
    sets += fmt::format("{},{:.6g},{:.5g},{:.5g},{:.6f},{:.2g},{},{},{}\n", study.sets[k].name,
                        1e9 * study.sets[k].wavelength, index.real(), index.imag(), a.value, a.standard_error,
                        blank(a.u_bed), blank(a.sd_bed), a.n);
  }
  write_file(folder / "sets.csv", sets);

  std::string table =
      "bed,grains,solid thickness [um],mean height [um],packing density,mean diameter [um],absorptivity,"
      "standard error,rays\n";
  for (BedAbsorption const& b : study.beds)
    table += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6f},{:.2g},{}\n", b.name, b.measures.grains,
                         1e6 * b.measures.solid_thickness, 1e6 * b.measures.mean_height, b.measures.packing_density,
                         1e6 * b.measures.mean_diameter, b.light.sets[0].absorptivity, b.light.sets[0].standard_error,
                         b.light.rays);
  write_file(folder / "beds.csv", table);
}

/// Grains by what a unit of their cross-section takes of the light that falls on a unit of the lit area.
void write_pictures(fs::path const& folder, AbsorptionStudy const& study) {
  LitBed const& lit = study.last;
  raytrace::BedScene const scene(lit.bed, lit.surface, lit.period);
  Vec3 const size = lit.upper - lit.lower;
  std::vector<double> share;
  for (std::size_t i = 0; i < lit.bed.size(); ++i) {
    double const radius = lit.bed.radius[i];
    share.push_back(study.beds.back().light.grain_share[i] * size.x() * size.y() /
                    (3.14159265358979 * radius * radius));
  }
  std::vector<double> sorted = share;
  std::ranges::sort(sorted);
  double const bright =
      sorted.empty() ? 1 : sorted[static_cast<std::size_t>(0.98 * static_cast<double>(sorted.size() - 1))];
  raytrace::Paint paint;
  paint.grains = raytrace::colour_by(share, 0, bright);
  raytrace::RenderSettings const picture{.width = 960, .height = 600};
  Vec3 const low = lit.lower, high = lit.upper;
  for (auto const& [name, direction] :
       {std::pair{"bed", raytrace::oblique}, std::pair{"bed_top", raytrace::from_above}})
    write_png(raytrace::render(scene, raytrace::fit_camera(low, high, direction, 1.6), paint, picture),
              folder / fmt::format("{}.png", name));
}

}  // namespace

AbsorptionMap absorption_map(AbsorptionStudy const& study, Case const& checked) {
  raytrace::Absorption const& light = study.beds.back().light;
  AbsorptionMap map{light.map, light.map_error};
  if (!checked.optics.uniform_beam) return map;
  double const area = study.beam.size_x * study.beam.size_y;
  for (double& value : map.value.values) value *= area;
  for (double& value : map.error.values) value *= area;
  return map;
}

json absorption_summary(Case const& checked, AbsorptionStudy const& study) {
  json all{{"verb", "absorb"}, {"case", checked.name}, {"seed", checked.seed}, {"version", program_version()}};
  put(all, "absorptivity", study.absorptivity(0));
  all["standard_error"] = study.absorptivity(0).standard_error;
  double rays = 0, bounces = 0;
  bool reached = true;
  for (BedAbsorption const& bed : study.beds) {
    rays += static_cast<double>(bed.light.rays);
    bounces += bed.light.mean_bounces / static_cast<double>(study.beds.size());
    reached = reached && bed.light.target_reached;
  }
  all["rays"] = static_cast<std::int64_t>(rays);
  all["mean_bounces"] = bounces;
  all["target_reached"] = reached;
  std::vector<std::string> const names = surface_names(checked);
  for (std::size_t m = 0; m < names.size(); ++m) {
    AbsorptionFigure const share = study.by_material(0, m);
    all["by_material"][names[m]] = share.value;
    put(all["by_material_figures"], names[m], share);
  }
  put(all, "substrate", study.substrate(0));
  all["depth_profile"] = json::array();
  for (raytrace::DepthLayer const& layer : study.beds.back().light.depth_profile)
    all["depth_profile"].push_back({{"z", layer.z}, {"fraction", layer.fraction}, {"fraction_u_num", layer.error}});
  all["sets"] = sets(checked, study);
  all["materials"] = materials(checked, study);
  all["beds"] = beds(study);
  all["ledger"] = ledger(study);
  all["wall_time"] = {{"dem", study.time_dem}, {"rays", study.time_rays}, {"total", study.time_dem + study.time_rays}};
  all["definitions"] = definitions();
  return all;
}

void write_lit_bed(fs::path const& path, LitBed const& lit) {
  auto const period = [](double edge) { return edge > 0 ? std::optional(edge) : std::nullopt; };
  write_bed(path, {lit.bed, period(lit.period[0]), period(lit.period[1]), lit.lower.z(), std::nullopt}, BedFormat::csv);
}

void write_absorption(fs::path const& folder, Case const& checked, AbsorptionStudy const& study) {
  write_file(folder / "case_resolved.toml", resolved_toml(checked));
  write_tables(folder, absorption_map(study, checked), checked, study);
  if (checked.run.pictures) write_pictures(folder, study);
  write_file(folder / "report.html", absorption_page(folder, checked, study));
  write_file(folder / "summary.json", absorption_summary(checked, study).dump(2) + "\n");
}

}  // namespace layerloop::coupling
