#include "coupling/report/replicate_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/write_file.hpp"
#include "coupling/report/csv_table.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "coupling/report/shown_quantity.hpp"
#include "coupling/report/svg_plot.hpp"
#include "coupling/report/tables.hpp"

namespace layerloop::coupling {
namespace {

using nlohmann::json;

using Quantity = ShownQuantity;

constexpr char const* um = "\xc2\xb5m";

std::vector<Quantity> bin_quantities() {
  return {{"relative_density", "relative density", ""},
          {"effective_thickness", "effective thickness", um, 1e6},
          {"real_effective_thickness", "real effective thickness", um, 1e6},
          {"mean_diameter", "mean diameter", um, 1e6},
          {"surface_coverage", "surface coverage", ""},
          {"volume_fraction_nominal", "volume fraction, nominal", ""}};
}

double value(json const& from, Quantity const& q) { return q.scale * figure_in(from, q.key); }
double interval(json const& from, Quantity const& q) { return q.scale * figure_in(from, q.key + "_u_bed"); }

std::string column(Quantity const& q) {
  std::string const unit = column_unit(q);
  return fmt::format("{0}{1},{0}_u_bed{1},{0}_n", q.key, unit);
}

void add_point(Series& series, double x, json const& from, Quantity const& q) {
  double const error = interval(from, q);
  series.x.push_back(x);
  series.y.push_back(value(from, q));
  series.error.push_back(std::isfinite(error) ? error : 0.0);
}

/// The quantity in every bin; of many layers the first, the last and some between.
Series profile(json const& layer, Quantity const& q) {
  Series series{.name = fmt::format("layer {}", layer["layer"].get<int>()), .x = {}, .y = {}};
  for (json const& bin : layer["bins"]) add_point(series, 1e6 * figure_in(bin, "x"), bin, q);
  return series;
}

std::string profiles(json const& layers) {
  constexpr std::size_t most = 4;
  std::size_t const n = layers.size(), shown = std::min(n, most);
  std::string figures;
  for (Quantity const& q : bin_quantities()) {
    LinePlot plot{.x_label = "x [\xc2\xb5m]", .y_label = title_of(q), .series = {}, .width = 560, .height = 290};
    for (std::size_t k = 0; k < shown; ++k)
      plot.series.push_back(profile(layers[shown > 1 ? k * (n - 1) / (shown - 1) : 0], q));
    figures += figure(line_plot(plot), "", "profiles.csv");
  }
  return "<div class=\"pairs\">" + figures + "</div>\n";
}

std::string trends(json const& layers) {
  if (layers.size() < 2) return "";
  std::string figures;
  for (Quantity const& q : layer_quantities()) {
    LinePlot plot{
        .x_label = "layer", .y_label = title_of(q), .series = {{}}, .whole_x = true, .width = 420, .height = 250};
    for (json const& layer : layers) add_point(plot.series[0], figure_in(layer, "layer"), layer, q);
    bool const measured = std::ranges::any_of(plot.series[0].y, [](double y) { return std::isfinite(y); });
    if (measured) figures += figure(line_plot(plot), "", "layers.csv");
  }
  return "<div class=\"grid\">" + figures + "</div>\n";
}

std::string table(json const& layers) {
  std::string rows;
  for (Quantity const& q : layer_quantities()) {
    if (!layers[0].contains(q.key)) continue;
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"unit\">{}</td>", q.label, q.unit);
    for (json const& layer : layers)
      rows += fmt::format("<td>{}</td>", with_uncertainty(value(layer, q), interval(layer, q)));
    rows += "</tr>\n";
  }
  std::string head;
  for (json const& layer : layers) head += fmt::format("<th>layer {}</th>", layer["layer"].get<int>());
  return fmt::format(
      "<div class=\"scroll\"><table class=\"figures\"><thead><tr><th>quantity</th><th>unit</th>{}</tr></thead><tbody>\n"
      "{}</tbody></table></div>\n<p class=\"numbers-line\">Mean &plusmn; half width of the 95 % t-interval. <a "
      "class=\"numbers\" href=\"layers.csv\">layers.csv</a></p>\n",
      head, rows);
}

std::string cards(json const& last) {
  std::string all;
  for (Quantity const& q : layer_quantities()) {
    bool const chosen_one = q.key == "effective_thickness" || q.key == "volume_fraction_real" ||
                            q.key == "surface_coverage" || q.key == "heap_angle_accumulation" ||
                            q.key == "reservoir_mass_ratio";
    if (!chosen_one) continue;
    all += fmt::format(
        "<div class=\"card\"><h3>{}</h3><p class=\"value\">{} <span class=\"unit\">{}</span></p><p "
        "class=\"note\">layer {}, {:.0f} seeds</p></div>\n",
        q.label, with_uncertainty(value(last, q), interval(last, q)), q.unit, last["layer"].get<int>(),
        figure_in(last, q.key + "_n"));
  }
  return "<div class=\"cards\">\n" + all + "</div>\n";
}

std::string pictures(std::filesystem::path const& folder, std::string const& run, json const& layers) {
  std::string figures;
  for (std::string_view const name : {"machine", "layer", "layer_top"}) {
    std::string const file = fmt::format("{}_{:04}.png", name, layers.back()["layer"].get<int>());
    if (!std::filesystem::exists(folder / run / file)) continue;
    figures += figure(fmt::format("<img src=\"data:image/png;base64,{}\" alt=\"{}\">",
                                  base64(read_file(folder / run / file)), escape(file)),
                      fmt::format("{}, last layer, coloured by grain size.", escape(run)));
  }
  return figures.empty() ? "" : "<div class=\"pictures\">" + figures + "</div>\n";
}

std::string links(std::vector<std::string> const& folders) {
  std::string list;
  for (std::string const& folder : folders)
    list += fmt::format("<li><a href=\"{0}/report.html\">{0}</a></li>\n", escape(folder));
  return "<ul>\n" + list + "</ul>\n";
}

std::string words(json const& entries) {
  std::string rows;
  for (auto const& [key, entry] : entries.items()) {
    std::string const text = entry.is_string() ? entry.get<std::string>() : entry.dump();
    rows += fmt::format("<tr><th scope=\"row\"><code>{}</code></th><td>{}</td></tr>\n", escape(key), escape(text));
  }
  return "<table class=\"words\"><tbody>\n" + rows + "</tbody></table>\n";
}

void write_table(std::filesystem::path const& path, std::string header, std::vector<Quantity> const& quantities,
                 std::vector<std::pair<std::vector<double>, json const*>> const& rows) {
  for (Quantity const& q : quantities) (header += ',') += column(q);
  CsvTable csv(header);
  for (auto const& [place, from] : rows) {
    std::vector<double> values = place;
    for (Quantity const& q : quantities)
      values.insert(values.end(), {value(*from, q), interval(*from, q), figure_in(*from, q.key + "_n")});
    csv.row(values);
  }
  csv.write(path);
}

void write_csv(std::filesystem::path const& folder, json const& layers) {
  std::vector<std::pair<std::vector<double>, json const*>> by_layer, by_bin;
  for (json const& layer : layers) {
    by_layer.push_back({{figure_in(layer, "layer")}, &layer});
    for (json const& bin : layer["bins"])
      by_bin.push_back({{figure_in(layer, "layer"), 1e6 * figure_in(bin, "x")}, &bin});
  }
  write_table(folder / "layers.csv", "layer", layer_quantities(), by_layer);
  write_table(folder / "profiles.csv", "layer,x [um]", bin_quantities(), by_bin);
}

}  // namespace

void write_replicate_report(std::filesystem::path const& folder, Case const& checked, json const& summary,
                            std::vector<std::string> const& folders) {
  json const& layers = summary.at("layers");
  write_csv(folder, layers);
  Page page{.title = checked.name,
            .version = summary.at("version").get<std::string>(),
            .headline = headline(checked, layers.size()) +
                        fmt::format(" {} runs that differ in their seed only.", folders.size()),
            .cards = cards(layers.back()),
            .seed = checked.seed};
  page.add("bed", "The bed", pictures(folder, folders.front(), layers));
  page.add("layers", "Layer by layer", table(layers) + trends(layers));
  page.add("profiles", "Along the way of the blade", profiles(layers));
  page.add("runs", "Every run", links(folders));
  page.add("ledgers", "Ledger over all runs, in SI units", words(summary.at("ledger")));
  page.add("definitions", "Definitions", words(summary.at("definitions")));
  page.add(
      "case", "The case, in SI units",
      "<details><summary>Every key of the case, defaults filled in</summary>\n" + case_table(checked) + "</details>\n");
  write_file(folder / "report.html", page.html());
}

}  // namespace layerloop::coupling
