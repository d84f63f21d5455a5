#include "coupling/report/tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "core/case_file.hpp"
#include "core/case_schema.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/ledger_checks.hpp"

namespace layerloop::coupling {
namespace {

std::string um(double metres, int digits = 3) { return significant(1e6 * metres, digits); }

std::string card(std::string_view label, std::string const& value_html, std::string_view unit,
                 std::string const& note_html, std::string_view css = "") {
  return fmt::format(
      "<div class=\"card {}\"><h3>{}</h3><p class=\"value\">{} <span class=\"unit\">{}</span></p><p "
      "class=\"note\">{}</p></div>\n",
      css, label, value_html, unit, note_html);
}

std::string laser_cards(LayerRecord const& last) {
  PoolSize const &pool = last.pool, &u = last.pool_u_num;
  std::string const sizes =
      fmt::format("{} <span class=\"times\">&times;</span> {} <span class=\"times\">&times;</span> {}", um(pool.width),
                  um(pool.depth), um(pool.length));
  std::string const bonded = pool.depth > 0 ? fmt::format("reaches {} &micro;m below the powder", um(pool.depth))
                                            : std::string("does not reach what lies below the powder");
  return card("Absorptivity", with_uncertainty(last.absorptivity, last.absorptivity_standard_error), "",
              fmt::format("of the laser power; {} hits on a surface per ray", significant(last.mean_bounces))) +
         card("Melt pool: width, depth, length", sizes, "&micro;m",
              fmt::format("&plusmn; {}, {}, {} &micro;m; {}", um(u.width, 2), um(u.depth, 2), um(u.length, 2), bonded),
              "wide");
}

struct Row {
  std::string_view label, unit;
  std::function<std::string(LayerRecord const&)> value;
};

std::vector<Row> powder_rows() {
  using L = LayerRecord const&;
  return {{"grains in the layer", "", [](L l) { return count(l.grains_in_layer); }},
          {"grains nipped by the blade", "", [](L l) { return count(l.grains_nipped); }},
          {"effective thickness", "&micro;m",
           [](L l) {
             return with_uncertainty(1e6 * l.metrics.effective_thickness, 1e6 * l.metrics.effective_thickness_u_num);
           }},
          {"real effective thickness", "&micro;m",
           [](L l) {
             return with_uncertainty(1e6 * l.metrics.real_effective_thickness,
                                     1e6 * l.metrics.real_effective_thickness_u_num);
           }},
          {"void layer", "&micro;m", [](L l) { return um(l.metrics.void_layer); }},
          {"volume fraction, nominal", "", [](L l) { return significant(l.metrics.volume_fraction_nominal); }},
          {"volume fraction, real", "",
           [](L l) { return with_uncertainty(l.metrics.volume_fraction_real, l.metrics.volume_fraction_real_u_num); }},
          {"surface coverage", "", [](L l) { return significant(l.metrics.surface_coverage); }},
          {"roughness Sa", "&micro;m",
           [](L l) { return with_uncertainty(1e6 * l.metrics.roughness_sa, 1e6 * l.metrics.roughness_sa_u_num); }},
          {"roughness Sq", "&micro;m", [](L l) { return um(l.metrics.roughness_sq); }},
          {"roughness Sz", "&micro;m", [](L l) { return um(l.metrics.roughness_sz); }},
          {"D10, D50, D90 by volume", "&micro;m",
           [](L l) { return fmt::format("{}, {}, {}", um(l.metrics.d10), um(l.metrics.d50), um(l.metrics.d90)); }},
          {"D10, D50, D90 by number", "&micro;m",
           [](L l) {
             return fmt::format("{}, {}, {}", um(l.metrics.d10_number), um(l.metrics.d50_number),
                                um(l.metrics.d90_number));
           }},
          {"mean diameter D[1,0], D[3,2], D[4,3]", "&micro;m",
           [](L l) {
             return fmt::format("{}, {}, {}", um(l.metrics.mean_diameter), um(l.metrics.sauter_diameter),
                                um(l.metrics.mass_diameter));
           }},
          {"coordination number", "", [](L l) { return significant(l.metrics.coordination_number); }},
          {"share of rattlers", "", [](L l) { return significant(l.metrics.rattler_fraction); }},
          {"segregation index", "", [](L l) { return significant(l.metrics.segregation_index, 2); }},
          {"Lacey index", "", [](L l) { return significant(l.metrics.lacey_index); }}};
}

std::vector<Row> stroke_rows() {
  using L = LayerRecord const&;
  using S = StrokeMetrics const&;
  return {
      {"settled height of the feed", "&micro;m", [](L l) { return um(l.stroke.settled_height); }},
      {"settled density of the feed", "", [](L l) { return significant(l.stroke.settled_density); }},
      {"heap angle, accumulation", "deg",
       [](L l) {
         S s = l.stroke;
         return with_uncertainty(s.heap_angle_accumulation, s.heap_angle_accumulation_u_num);
       }},
      {"heap angle, deposition", "deg",
       [](L l) {
         S s = l.stroke;
         return with_uncertainty(s.heap_angle_deposition, s.heap_angle_deposition_u_num);
       }},
      {"mean diameter in the reservoir, before and after", "&micro;m",
       [](L l) {
         return fmt::format("{}, {}", um(l.stroke.reservoir_mean_diameter_before),
                            um(l.stroke.reservoir_mean_diameter));
       }},
      {"mass left in the reservoir over before", "", [](L l) { return significant(l.stroke.reservoir_mass_ratio); }},
      {"force on the blade, largest and mean", "mN",
       [](L l) {
         return fmt::format("{}, {}", significant(1e3 * l.stroke.blade_force),
                            significant(1e3 * l.stroke.mean_blade_force));
       }},
      {"Bond number of the median grain", "", [](L l) { return significant(l.stroke.bond_number); }},
      {"steps a contact, largest overlap", "1, %", [](L l) {
         return fmt::format("{}, {}", significant(l.stroke.steps_per_contact),
                            significant(1e2 * l.stroke.largest_overlap));
       }}};
}

std::vector<Row> laser_rows() {
  using L = LayerRecord const&;
  return {
      {"absorptivity", "", [](L l) { return with_uncertainty(l.absorptivity, l.absorptivity_standard_error); }},
      {"temperature at the start", "K", [](L l) { return significant(l.start_temperature, 4); }},
      {"peak temperature", "K", [](L l) { return significant(l.peak_temperature, 4); }},
      {"pool width", "&micro;m", [](L l) { return with_uncertainty(1e6 * l.pool.width, 1e6 * l.pool_u_num.width); }},
      {"pool depth", "&micro;m", [](L l) { return with_uncertainty(1e6 * l.pool.depth, 1e6 * l.pool_u_num.depth); }},
      {"pool length", "&micro;m",
       [](L l) { return with_uncertainty(1e6 * l.pool.length, 1e6 * l.pool_u_num.length); }}};
}

std::vector<Row> part_rows() {
  using L = LayerRecord const&;
  return {{"grains melted (of them trapped whole)", "",
           [](L l) { return fmt::format("{} ({})", l.consolidation.grains_melted, l.consolidation.grains_trapped); }},
          {"melted mass", "&micro;g", [](L l) { return significant(1e9 * l.consolidation.melted_mass, 4); }},
          {"grains moved clear of the new surface", "", [](L l) { return count(l.consolidation.grains_moved); }},
          {"triangles of plate and part", "", [](L l) { return count(l.consolidation.triangles); }},
          {"relative density of the part", "%",
           [](L l) { return significant(100 * l.consolidation.part_relative_density, 4); }}};
}

}  // namespace

std::string headline(Case const& c, std::size_t layers) {
  auto const um = [](double metres) { return chosen(1e6 * metres); };
  std::string text = fmt::format(
      "{} layer{} of {} powder, {} &micro;m each, spread by a blade at {} mm/s over {} &times; {} &micro;m. ", layers,
      layers == 1 ? "" : "s", escape(c.material.name), um(c.machine.layer_thickness),
      chosen(1e3 * c.machine.recoating_speed), um(c.machine.deposition_length), um(c.machine.width));
  if (c.machine.frozen_zone) return text + "No laser: a zone of the bed was frozen and meshed.";
  if (!c.has_laser()) return text + "No laser: the powder stays as it was spread.";
  static constexpr std::array definition{"1/e&sup2;", "D4&sigma;", "FWHM"};
  std::string const spot = fmt::format("spot {} &micro;m ({}).", um(c.laser.spot_diameter),
                                       definition[static_cast<std::size_t>(c.laser.spot_definition)]);
  if (c.scan.kind == ScanKind::file) return text + fmt::format("The way of {}, {}", escape(c.scan.path), spot);
  std::string const tracks = c.scan.kind == ScanKind::hatch
                                 ? fmt::format("{} tracks of {} &micro;m a layer, {} &micro;m apart,", c.scan.tracks,
                                               um(c.scan.track_length), um(c.scan.hatch_spacing))
                                 : fmt::format("One track of {} &micro;m a layer", um(c.scan.track_length));
  return text +
         fmt::format("{} at {} m/s and {} W, {}", tracks, chosen(c.scan.scan_speed), chosen(c.laser.power), spot);
}

std::string cards(ReportInput const& input) {
  LayerRecord const& last = input.last();
  LayerMetrics const& m = last.metrics;
  std::string all =
      card("Layers",
           fmt::format("{} <span class=\"times\">&times;</span> {}", input.layer_count(),
                       chosen(1e6 * input.checked.machine.layer_thickness)),
           "&micro;m",
           fmt::format("{} grains fed, {} in the last layer", count(input.record.ledger.particles_fed),
                       count(last.grains_in_layer))) +
      card("Effective layer thickness", um(m.effective_thickness), "&micro;m",
           fmt::format("surface over the nominal plate level; real: {} &micro;m", um(m.real_effective_thickness))) +
      card("Packing of the layer", significant(m.volume_fraction_real), "",
           fmt::format("volume fraction, real; {} % of the surface is covered", significant(100 * m.surface_coverage)));
  if (input.laser()) all += laser_cards(last);
  if (input.part_grows())
    all += card("Part density", significant(100 * last.consolidation.part_relative_density, 4), "%",
                fmt::format("{} grains melted, {} trapped whole inside", input.record.ledger.particles_melted,
                            input.record.ledger.particles_trapped));
  std::vector<LedgerCheck> const checks = ledger_checks(input.record.ledger, input.laser());
  auto const closed = std::count_if(checks.begin(), checks.end(), [](LedgerCheck const& check) { return check.holds; });
  bool const good = closed == static_cast<std::ptrdiff_t>(checks.size());
  all += card("Ledgers", good ? "&#10003; closed" : "&#10007; open", "",
              fmt::format("{} of {} checks hold", closed, checks.size()), good ? "good" : "bad");

  std::string notes;
  for (LayerRecord const& layer : input.record.layers)
    if (!layer.blade_note.empty())
      notes += fmt::format("<p class=\"warning\"><b>Layer {}.</b> {}</p>\n", layer.layer, escape(layer.blade_note));
  return fmt::format("<div class=\"cards\">\n{}</div>\n{}", all, notes);
}

std::string layer_table(ReportInput const& input) {
  std::vector<Row> rows = powder_rows();
  auto const add = [&](std::vector<Row> more) { rows.insert(rows.end(), more.begin(), more.end()); };
  add(stroke_rows());
  if (input.laser()) add(laser_rows());
  if (input.part_grows()) add(part_rows());
  std::string table = "<table class=\"figures\"><thead><tr><th>quantity</th><th>unit</th>";
  for (LayerRecord const& layer : input.record.layers) table += fmt::format("<th>layer {}</th>", layer.layer);
  table += "</tr></thead><tbody>\n";
  for (Row const& row : rows) {
    table += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"unit\">{}</td>", row.label, row.unit);
    for (LayerRecord const& layer : input.record.layers) table += fmt::format("<td>{}</td>", row.value(layer));
    table += "</tr>\n";
  }
  return "<div class=\"scroll\">" + table +
         "</tbody></table></div>\n<p class=\"numbers-line\"><a class=\"numbers\" "
         "href=\"layers.csv\">layers.csv</a></p>\n";
}

std::string ledger_tables(ReportInput const& input) {
  std::string tables;
  for (LedgerTable const& ledger : ledgers(input.record.ledger, input.laser())) {
    std::string rows;
    for (LedgerEntry const& entry : ledger.entries)
      rows += fmt::format("<tr class=\"{}\"><th scope=\"row\">{}</th><td>{}</td></tr>\n", entry.is_total ? "total" : "",
                          entry.label, entry.value_html);
    for (LedgerCheck const& check : ledger.checks)
      rows +=
          fmt::format("<tr class=\"{}\"><th scope=\"row\">{} {}</th><td>{}</td></tr>\n", check.holds ? "pass" : "fail",
                      check.holds ? "&#10003;" : "&#10007;", check.label, check.value_html);
    tables +=
        fmt::format("<div class=\"ledger\"><h3>{}</h3><table><tbody>\n{}</tbody></table></div>\n", ledger.title, rows);
  }
  return "<div class=\"pairs\">" + tables + "</div>\n";
}

std::string definition_table(ReportInput const& input) {
  std::string rows;
  for (auto const& [quantity, sentence] : definitions(input.extras))
    rows +=
        fmt::format("<tr><th scope=\"row\"><code>{}</code></th><td>{}</td></tr>\n", escape(quantity), escape(sentence));
  return "<table class=\"words\"><tbody>\n" + rows + "</tbody></table>\n";
}

std::string case_table(Case const& checked) {
  std::string rows, table;
  std::istringstream lines(resolved_toml(checked));
  for (std::string line; std::getline(lines, line);) {
    std::size_t const equals = line.find(" = ");
    if (line.starts_with('[')) {
      table = line.substr(1, line.rfind(']') - 1);
      rows += fmt::format("<tr class=\"group\"><th colspan=\"4\">[{}]</th></tr>\n", escape(table));
    } else if (equals != std::string::npos) {
      std::string const key = line.substr(0, equals);
      CaseKey const* const row = find_key(table, key);
      rows += fmt::format(
          "<tr><th scope=\"row\"><code>{}</code></th><td class=\"code\">{}</td><td "
          "class=\"unit\">{}</td><td>{}</td></tr>\n",
          escape(key), escape(line.substr(equals + 3)), row ? escape(si_unit(row->dimension)) : "",
          row ? escape(row->sentence) : "");
    }
  }
  return "<table class=\"words\"><tbody>\n" + rows + "</tbody></table>\n";
}

std::string effects_left_out(Case const& checked) {
  std::string names;
  for (auto const& [name, effect] : checked.effects)
    if (!effect.enabled) names += fmt::format("{}<code>{}</code>", names.empty() ? "" : ", ", escape(name));
  return names.empty() ? ""
                       : fmt::format("<li>Switched off in this case (table <code>[effects]</code>): {}.</li>", names);
}

}  // namespace layerloop::coupling
