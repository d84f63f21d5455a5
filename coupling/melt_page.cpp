// The report of the verb melt: one HTML file.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "coupling/melt_output.hpp"
#include "coupling/program_version.hpp"
#include "coupling/report/figures.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "coupling/report/svg_map.hpp"
#include "coupling/report/svg_plot.hpp"
#include "coupling/report/tables.hpp"
#include "coupling/scan_path.hpp"

namespace layerloop::coupling {
namespace {

std::string micrometres(double value, double uncertainty) {
  return with_uncertainty(1e6 * value, 1e6 * uncertainty) + " &micro;m";
}

std::string words_of(Regime regime) {
  std::string words = name_of(regime);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string cards(MeltStudy const& study) {
  PoolSize const &pool = study.melted.heat.melt.pool, &u = study.u_num;
  AbsorbedPower const& light = study.melted.exposure.mean;
  std::string const isotherm = study.placed.heat.pool_isotherm;
  bool const given = study.placed.laser.absorptivity.has_value();
  return "<div class=\"cards\">\n" + card("Regime", words_of(study.regime), "what each word means stands below") +
         card("Width", micrometres(pool.width, u.width), fmt::format("at the {}, across the track", isotherm)) +
         card("Depth", micrometres(pool.depth, u.depth), "below the original surface") +
         card("Length", micrometres(pool.length, u.length), "along the track, at one instant") +
         card("Absorptivity", with_uncertainty(light.absorptivity, absorptivity_uncertainty(study)),
              given               ? "given in the case"
              : study.second_grid ? "&plusmn; error of rays and cells"
                                  : "&plusmn; standard error of the rays") +
         card("Cooling rate",
              study.cooling ? with_uncertainty(1e-6 * study.cooling->value, 1e-6 * study.cooling->u_num) + " K/&micro;s"
                            : "&ndash;",
              study.cooling ? "solidus to 100 K below it, at mid-track" : "the exposure ended before it was cold") +
         "</div>\n";
}

std::string headline(MeltStudy const& study) {
  Case const& c = study.placed;
  auto const& tracks = study.melted.exposure.source.tracks;
  Track const& track = tracks.front();
  double const length = (track.end - track.begin).norm();
  std::string const on = c.melt.bed == MeltedBed::plate  ? "a bare plate"
                         : c.melt.bed == MeltedBed::file ? "a plate with powder from a file"
                                                         : "a layer that was spread";
  return fmt::format("{} track{} of {} &micro;m on {} of {}: {} W at {} m/s, 1/e&sup2; diameter {} &micro;m.",
                     tracks.size(), tracks.size() == 1 ? "" : "s", chosen(1e6 * length), on, escape(c.material.name),
                     chosen(track.power), significant(length / (track.end_time - track.begin_time)),
                     significant(2e6 * c.laser.spot_radius()));
}

/// Hottest peak of every column, seen from above.
std::string top_view(MeltStudy const& study) {
  MeltRecord const& melt = study.melted.heat.melt;
  VoxelGrid const& grid = melt.grid;
  Raster raster{1e6 * grid.origin.x(), 1e6 * grid.origin.y(), 1e6 * grid.cell, grid.n[0], grid.n[1], {}};
  for (std::int32_t j = 0; j < grid.n[1]; ++j) {
    for (std::int32_t i = 0; i < grid.n[0]; ++i) {
      float hottest = 0;
      for (std::int32_t k = 0; k < grid.n[2]; ++k)
        hottest = std::max(hottest, melt.peak_temperature[static_cast<std::size_t>(grid.index(i, j, k))]);
      raster.values.push_back(hottest);
    }
  }
  Material const& metal = study.placed.material;
  ColourScale const scale{ColourMap::heat,
                          "peak T [K]",
                          study.placed.heat.ambient_temperature,
                          std::clamp(study.melted.heat.peak_temperature, metal.liquidus, metal.boiling_point),
                          metal.liquidus,
                          "liquidus"};
  Raster const values = raster;
  Outline const molten{[values, liquidus = metal.liquidus](int i, int j) { return values.at(i, j) >= liquidus; },
                       "outline-melted"};
  return figure(map_plot(raster, scale, "x [\xc2\xb5m]", "y [\xc2\xb5m]", {molten}, 1000),
                "Highest temperature that each place reached, seen from above; the line encloses what melted.");
}

std::string probe_plot(MeltStudy const& study) {
  ProbeHistory const& probe = study.melted.heat.melt.probe;
  if (probe.time.size() < 2) return "";
  Series history{.name = "surface at mid-track", .x = {}, .y = {}};
  std::size_t const stride = std::max<std::size_t>(1, probe.time.size() / 400);
  for (std::size_t i = 0; i < probe.time.size(); i += stride)
    history.x.push_back(1e6 * probe.time[i]), history.y.push_back(probe.temperature[i]);
  Material const& metal = study.placed.material;
  Series solidus{.name = "solidus", .x = {history.x.front(), history.x.back()}, .y = {metal.solidus, metal.solidus}};
  LinePlot const plot{
      .x_label = "time [\xc2\xb5s]", .y_label = "T [K]", .series = {history, solidus}, .width = 1000, .height = 340};
  return figure(line_plot(plot),
                fmt::format("Temperature of the surface at x = {} &micro;m, y = {} &micro;m.", chosen(1e6 * probe.x),
                            chosen(1e6 * probe.y)),
                "probe.csv");
}

std::string track_table(MeltStudy const& study) {
  auto const& path = study.melted.exposure.source.tracks;
  auto const back = return_times(path);
  std::string rows;
  for (std::size_t t = 0; t < path.size(); ++t) {
    PoolSize const& size = study.melted.heat.melt.track_pools[t];
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", t + 1,
                        significant(1e6 * size.width), significant(1e6 * size.depth), significant(1e6 * size.length),
                        back[t] ? significant(1e6 * *back[t]) : "&ndash;");
  }
  return "<div class=\"scroll\"><table class=\"figures\"><thead><tr><th>track</th><th>width [&micro;m]</th>"
         "<th>depth [&micro;m]</th><th>length [&micro;m]</th><th>return time [&micro;s]</th></tr></thead><tbody>\n" +
         rows +
         "</tbody></table></div>\n<p class=\"numbers-line\"><a class=\"numbers\" href=\"tracks.csv\">tracks.csv</a> "
         "<a class=\"numbers\" href=\"sections.csv\">sections.csv</a></p>\n";
}

/// Two columns of words; structures are written out as key.member.
std::string words(nlohmann::json const& entries, std::string const& prefix = "") {
  std::string rows;
  for (auto const& [key, entry] : entries.items()) {
    if (entry.is_object()) {
      rows += words(entry, prefix + key + ".");
      continue;
    }
    std::string const value = entry.is_string()         ? escape(entry.get<std::string>())
                              : entry.is_number_float() ? significant(entry.get<double>(), 4)
                                                        : escape(entry.dump());
    rows += fmt::format("<tr><th scope=\"row\"><code>{}{}</code></th><td>{}</td></tr>\n", prefix, escape(key), value);
  }
  return prefix.empty() ? "<table class=\"words\"><tbody>\n" + rows + "</tbody></table>\n" : rows;
}

}  // namespace

std::string melt_page(std::filesystem::path const& folder, MeltStudy const& study) {
  nlohmann::json const summary = melt_summary(study);
  RunRecord const& record = study.build.record;
  ReportExtras const extras{program_version(), {}};
  ReportInput const input{folder, study.placed,           record, study.build.bed, study.build.substrate,
                          extras, {&record.layers.back()}};
  Page page{.title = study.placed.name,
            .version = program_version(),
            .headline = headline(study),
            .cards = cards(study),
            .seed = study.placed.seed};
  page.add("sections", "Across the track", melt_section_figures(input));
  page.add("top", "Seen from above", top_view(study));
  page.add("probe", "Temperature over time", probe_plot(study));
  page.add("tracks", "Track by track", track_table(study));
  page.add("pool", "Pool, in SI units", words(summary.at("pool")));
  if (summary.contains("fusion")) page.add("fusion", "How the tracks join, in SI units", words(summary.at("fusion")));
  if (summary.contains("solid"))
    page.add("solid", "What became of the powder, in SI units", words(summary.at("solid")));
  page.add("grid", "Grid and its choice, in SI units", words(summary.at("grid")));
  page.add("ledger", "Ledger, in SI units", words(summary.at("ledger")));
  page.add("definitions", "Definitions", words(summary.at("definitions")));
  page.add("case", "The case, in SI units",
           "<details><summary>Every key of the case, defaults filled in</summary>\n" + case_table(study.placed) +
               "</details>\n");
  return page.html();
}

}  // namespace layerloop::coupling
