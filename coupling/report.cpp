#include "coupling/report.hpp"

#include <fmt/format.h>

#include "core/write_file.hpp"
#include "coupling/report/bed_viewer.hpp"
#include "coupling/report/csv_tables.hpp"
#include "coupling/report/figures.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/tables.hpp"
#include "report_assets.hpp"

namespace layerloop::coupling {
namespace {

constexpr std::size_t layers_with_maps = 6;

/// All layers of a short run; of a long one the first, the last and some between, evenly.
std::vector<LayerRecord const*> choose_layers(RunRecord const& record) {
  std::size_t const n = record.layers.size(), shown = std::min(n, layers_with_maps);
  std::vector<LayerRecord const*> layers;
  for (std::size_t k = 0; k < shown; ++k) layers.push_back(&record.layers[shown > 1 ? k * (n - 1) / (shown - 1) : 0]);
  return layers;
}

/// Only our own style and script run, known by their digests; nothing is fetched from anywhere.
std::string content_security_policy() {
  auto const digest = [](std::string_view hex) {
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
      bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    return base64(bytes);
  };
  return fmt::format("default-src 'none'; img-src data:; style-src 'sha256-{}'; script-src 'sha256-{}'",
                     digest(report_css_sha256), digest(viewer_js_sha256));
}

std::string shown_note(ReportInput const& input) {
  if (input.shown.size() == input.layer_count()) return "";
  return fmt::format("<p class=\"remark\">Pictures and maps of {} of the {} layers; the files of the run hold all.</p>",
                     input.shown.size(), input.layer_count());
}

/// A section of the page with its entry in the list of contents; nothing when it has no content.
std::string section(std::string& contents, std::string_view id, std::string_view title, std::string const& content) {
  if (content.empty()) return "";
  contents += fmt::format("<a href=\"#{}\">{}</a>", id, title);
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, content);
}

std::string page(ReportInput const& input) {
  std::string contents;
  auto const add = [&](std::string_view id, std::string_view title, std::string const& content) {
    return section(contents, id, title, content);
  };
  double const plate_top = -input.checked.machine.layer_thickness * static_cast<double>(input.layer_count());
  std::string body = add("bed", "The bed", shown_note(input) + bed_pictures(input) + std::string(viewer_html));
  body += add("layers", "Layer by layer", layer_table(input) + trends(input));
  body += add("powder", "The powder layer", surface_maps(input) + profiles_and_sizes(input));
  if (input.laser()) {
    body += add("light", "Where the light went", energy_maps(input));
    body += add("melt", "What melted", std::string(melt_key_html) + melt_section_figures(input));
  }
  body += add("part", "The part", part_surface_maps(input));
  body += add("ledgers", "Ledgers", std::string(ledger_words_html) + ledger_tables(input));
  body += add("time", "Wall time", wall_time_bar(input));
  body += add("reading", "How to read it", std::string(reading_html));
  body +=
      add("limits", "What the model leaves out", fill_in(limits_html, {{"effects", effects_left_out(input.checked)}}));
  body += add("definitions", "Definitions", definition_table(input));
  body += add("case", "The case, in SI units",
              "<details><summary>Every key of the case, defaults filled in</summary>\n" + case_table(input.checked) +
                  "</details>\n");
  return fill_in(report_html, {{"policy", content_security_policy()},
                               {"title", escape(input.checked.name)},
                               {"style", std::string(report_css)},
                               {"script", std::string(viewer_js)},
                               {"version", escape(input.extras.version)},
                               {"seed", std::to_string(input.checked.seed)},
                               {"headline", headline(input)},
                               {"cards", cards(input)},
                               {"contents", contents},
                               {"body", body},
                               {"bed_data", viewer_data(input.bed, input.part, plate_top)}});
}

}  // namespace

void write_report(std::filesystem::path const& folder, Case const& checked, RunRecord const& record,
                  PowderBed const& bed, TriangleSurface const& part, ReportExtras const& extras) {
  ReportInput const input{folder, checked, record, bed, part, extras, choose_layers(record)};
  write_csv_tables(input);
  write_file(folder / "report.html", page(input));
}

}  // namespace layerloop::coupling
