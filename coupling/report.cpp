#include "coupling/report.hpp"

#include <fmt/format.h>

#include "core/write_file.hpp"
#include "coupling/report/bed_viewer.hpp"
#include "coupling/report/csv_tables.hpp"
#include "coupling/report/figures.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
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

std::string shown_note(ReportInput const& input) {
  if (input.shown.size() == input.layer_count()) return "";
  return fmt::format("<p class=\"remark\">Pictures and maps of {} of the {} layers; the files of the run hold all.</p>",
                     input.shown.size(), input.layer_count());
}

std::string page(ReportInput const& input) {
  double const plate_top = -input.checked.machine.layer_thickness * static_cast<double>(input.layer_count());
  Page page{.title = input.checked.name,
            .version = input.extras.version,
            .headline = headline(input.checked, input.layer_count()),
            .cards = cards(input),
            .seed = input.checked.seed,
            .bed_data = viewer_data(input.bed, input.part, plate_top)};
  page.add("bed", "The bed", shown_note(input) + bed_pictures(input) + std::string(viewer_html));
  page.add("layers", "Layer by layer", layer_table(input) + trends(input));
  page.add("powder", "The powder layer", surface_maps(input) + profiles_and_sizes(input));
  if (input.laser()) {
    page.add("light", "Where the light went", energy_maps(input));
    page.add("melt", "What melted", std::string(melt_key_html) + melt_section_figures(input));
  }
  if (input.part_grows()) page.add("part", "The part", part_surface_maps(input));
  page.add("ledgers", "Ledgers", std::string(ledger_words_html) + ledger_tables(input));
  page.add("time", "Wall time", wall_time_bar(input));
  page.add("reading", "How to read it", std::string(reading_html));
  page.add("limits", "What the model leaves out", fill_in(limits_html, {{"effects", effects_left_out(input.checked)}}));
  page.add("definitions", "Definitions", definition_table(input));
  page.add("case", "The case, in SI units",
           "<details><summary>Every key of the case, defaults filled in</summary>\n" + case_table(input.checked) +
               "</details>\n");
  return page.html();
}

}  // namespace

void write_report(std::filesystem::path const& folder, Case const& checked, RunRecord const& record,
                  PowderBed const& bed, TriangleSurface const& part, ReportExtras const& extras) {
  ReportInput const input{folder, checked, record, bed, part, extras, choose_layers(record)};
  write_csv_tables(input);
  write_file(folder / "report.html", page(input));
}

}  // namespace layerloop::coupling
