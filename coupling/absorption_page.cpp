// The report of the verb absorb: one HTML file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/write_file.hpp"
#include "coupling/absorption_output.hpp"
#include "coupling/optics_of_case.hpp"
#include "coupling/program_version.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "coupling/report/svg_map.hpp"
#include "coupling/report/svg_plot.hpp"
#include "coupling/report/tables.hpp"

namespace layerloop::coupling {
namespace {

std::string spread_words(AbsorptionFigure const& figure) {
  if (figure.n < 2) return "one bed: its spread from bed to bed is not known";
  return fmt::format("95 % interval &plusmn; {} over {} beds; from bed to bed {} (1&sigma;)",
                     significant(figure.u_bed, 2), figure.n, significant(figure.sd_bed, 2));
}

std::string cards(Case const& checked, AbsorptionStudy const& study) {
  AbsorptionFigure const a = study.absorptivity(0), floor = study.substrate(0);
  std::int64_t rays = 0;
  double bounces = 0;
  for (BedAbsorption const& bed : study.beds)
    rays += bed.light.rays, bounces += bed.light.mean_bounces / static_cast<double>(study.beds.size());
  raytrace::Surface const& metal = study.sets[0].surface[0];
  double const flat = 1 - raytrace::reflectance(metal, checked.laser.wavelength, 1);
  return "<div class=\"cards\">\n" +
         card("Absorptivity", with_uncertainty(a.value, a.standard_error), "&plusmn; standard error of the rays") +
         card("Bed to bed", a.n < 2 ? "&ndash;" : significant(a.sd_bed, 2), spread_words(a)) +
         card("Flat metal would absorb", significant(flat), "the same surface, at normal incidence") +
         card("Share of the floor", with_uncertainty(floor.value, floor.standard_error), "of the light that fell in") +
         card("Rays", count(rays), fmt::format("{} hits each", significant(bounces))) + "</div>\n";
}

std::string headline(Case const& checked, AbsorptionStudy const& study) {
  static constexpr std::array profiles{"Gaussian", "top-hat", "ring-shaped", "tabulated"};
  LaserSettings const& laser = checked.laser;
  std::string const light = checked.optics.uniform_beam ? "even light"
                                                        : fmt::format("a {} spot of {} &micro;m",
                                                                      profiles[static_cast<std::size_t>(laser.profile)],
                                                                      chosen(2e6 * laser.spot_radius()));
  std::string const tilt =
      laser.incidence_angle == 0
          ? "straight down"
          : fmt::format("{} degrees from straight down", chosen(laser.incidence_angle * 180 / std::numbers::pi));
  return fmt::format("{}: {}, {} nm, {}, on {} powder.", escape(study.beds.back().origin), light,
                     chosen(1e9 * laser.wavelength), tilt, escape(checked.material.name));
}

std::string pictures(std::filesystem::path const& folder) {
  std::string figures;
  for (std::string const name : {"bed.png", "bed_top.png"}) {
    if (!std::filesystem::exists(folder / name)) continue;
    figures +=
        figure(fmt::format("<img src=\"data:image/png;base64,{}\" alt=\"{}\">", base64(read_file(folder / name)), name),
               "The bed that was traced, grains coloured by the light they absorb for each unit of their "
               "cross-section: dark little, yellow much.",
               "grains.csv");
  }
  return figures.empty() ? "" : "<div class=\"pictures\">" + figures + "</div>\n";
}

std::string sets_table(Case const& checked, AbsorptionStudy const& study) {
  std::string rows;
  for (std::size_t k = 0; k < study.sets.size(); ++k) {
    AbsorptionFigure const a = study.absorptivity(k);
    raytrace::Surface const& metal = study.sets[k].surface[0];
    std::string const index = metal.grey_reflectance
                                  ? fmt::format("grey, R = {}", chosen(*metal.grey_reflectance))
                                  : fmt::format("{} + {} i", significant(metal.refractive_index.real(), 4),
                                                significant(metal.refractive_index.imag(), 4));
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        escape(study.sets[k].name), index,
                        significant(1 - raytrace::reflectance(metal, study.sets[k].wavelength, 1)),
                        with_uncertainty(a.value, a.standard_error), a.n < 2 ? "&ndash;" : significant(a.u_bed, 2));
  }
  std::string sources;
  for (Material const& metal : checked.materials())
    if (!checked.optics.grey_reflectance)
      sources += fmt::format("<li>{}: {}</li>\n", escape(metal.name), escape(optical_source(metal)));
  return "<div class=\"scroll\"><table class=\"figures\"><thead><tr><th>metal, light</th><th>refractive index</th>"
         "<th>flat metal</th><th>this bed</th><th>&plusmn; 95 % over beds</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n<ul class=\"reading\">\n" + sources + "</ul>\n";
}

std::string material_table(Case const& checked, AbsorptionStudy const& study) {
  std::vector<std::string> const names = surface_names(checked);
  std::string rows;
  auto const row = [&](std::string const& name, AbsorptionFigure const& share) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>\n", escape(name),
                        with_uncertainty(share.value, share.standard_error),
                        share.n < 2 ? "&ndash;" : significant(share.u_bed, 2));
  };
  for (std::size_t m = 0; m < names.size(); ++m) row(names[m], study.by_material(0, m));
  row("of which floor or mesh", study.substrate(0));
  return "<table class=\"figures\"><thead><tr><th>absorbed by</th><th>share of the light</th><th>&plusmn; 95 % over "
         "beds</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string depth_plot(AbsorptionStudy const& study) {
  Series profile{.name = "absorbed", .x = {}, .y = {}};
  for (raytrace::DepthLayer const& layer : study.beds.back().light.depth_profile) {
    profile.x.push_back(1e6 * layer.z);
    profile.y.push_back(layer.fraction);
    profile.error.push_back(layer.error);
  }
  LinePlot const plot{.x_label = "z [\xc2\xb5m]",
                      .y_label = "fraction of the light",
                      .series = {profile},
                      .from_zero = true,
                      .width = 760};
  return figure(line_plot(plot), "Where the light stays, slice by slice from the floor to the top of the powder.",
                "depth_profile.csv");
}

std::string map_figure(AreaMap const& map, double unit, std::string const& label, std::string const& caption) {
  Raster raster{1e6 * map.x0, 1e6 * map.y0, 1e6 * map.spacing, map.nx, map.ny, map.values};
  for (double& value : raster.values) value *= unit;
  std::vector<double> const range = quantiles(raster.values, {0.0, 0.99});
  ColourScale const scale{ColourMap::heat, label, 0, range[1] > 0 ? range[1] : 1};
  return figure(map_plot(raster, scale, "x [\xc2\xb5m]", "y [\xc2\xb5m]", {}, 560), caption, "absorptivity_map.csv");
}

std::string maps(Case const& checked, AbsorptionStudy const& study) {
  AbsorptionMap const map = absorption_map(study, checked);
  if (map.value.values.empty()) return "";
  bool const even = checked.optics.uniform_beam;
  double const unit = even ? 1 : 1e-6;
  std::string const label = even ? "local absorptivity" : "absorbed share per area [1/mm\xc2\xb2]";
  return "<div class=\"pairs\">" +
         map_figure(map.value, unit, label, "Absorbed light seen from above, wherever in depth it stays.") +
         map_figure(map.error, unit, "standard error of it", "How far the rays leave each pixel uncertain.") +
         "</div>\n";
}

std::string beds_table(AbsorptionStudy const& study) {
  std::string rows;
  for (BedAbsorption const& bed : study.beds)
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        escape(bed.name), count(bed.measures.grains), significant(1e6 * bed.measures.solid_thickness),
                        significant(1e6 * bed.measures.mean_height), significant(bed.measures.packing_density),
                        with_uncertainty(bed.light.sets[0].absorptivity, bed.light.sets[0].standard_error));
  return "<table class=\"figures\"><thead><tr><th>bed</th><th>grains</th><th>solid thickness [&micro;m]</th>"
         "<th>mean height [&micro;m]</th><th>packing density</th><th>absorptivity</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n<p class=\"numbers-line\"><a class=\"numbers\" href=\"beds.csv\">beds.csv</a></p>\n";
}

std::string words(nlohmann::json const& entries) {
  std::string rows;
  for (auto const& [key, entry] : entries.items())
    rows += fmt::format("<tr><th scope=\"row\"><code>{}</code></th><td>{}</td></tr>\n", escape(key),
                        escape(entry.is_string() ? entry.get<std::string>() : entry.dump()));
  return "<table class=\"words\"><tbody>\n" + rows + "</tbody></table>\n";
}

}  // namespace

std::string absorption_page(std::filesystem::path const& folder, Case const& checked, AbsorptionStudy const& study) {
  nlohmann::json const summary = absorption_summary(checked, study);
  Page page{.title = checked.name,
            .version = program_version(),
            .headline = headline(checked, study),
            .cards = cards(checked, study),
            .seed = checked.seed};
  page.add("bed", "The bed", pictures(folder));
  page.add("metals", "Metals and light", sets_table(checked, study));
  page.add("materials", "By material", material_table(checked, study));
  page.add("depth", "Into the depth", depth_plot(study));
  page.add("map", "Seen from above", maps(checked, study));
  page.add("beds", "Bed by bed", beds_table(study));
  page.add("ledger", "Ledger of the last bed, in W", words(summary.at("ledger")));
  page.add("definitions", "Definitions", words(summary.at("definitions")));
  page.add(
      "case", "The case, in SI units",
      "<details><summary>Every key of the case, defaults filled in</summary>\n" + case_table(checked) + "</details>\n");
  return page.html();
}

}  // namespace layerloop::coupling
