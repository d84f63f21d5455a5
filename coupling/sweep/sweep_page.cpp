#include "coupling/sweep/sweep_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/write_file.hpp"
#include "coupling/program_version.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "coupling/report/processing_window.hpp"
#include "coupling/report/svg_plot.hpp"
#include "coupling/report/svg_scatter.hpp"
#include "coupling/sweep/sweep_run.hpp"

namespace layerloop::coupling {
namespace {

constexpr std::size_t most_series = 6, most_windows = 4;

std::int64_t count_of(std::vector<CaseRecord> const& records, CaseState state) {
  return std::ranges::count(records, state, &CaseRecord::state);
}

/// First case of every point.
std::vector<SweepCase const*> first_cases(SweepPlan const& plan) {
  std::vector<SweepCase const*> first(plan.points);
  for (SweepCase const& one : plan.cases) {
    if (!first[one.point]) first[one.point] = &one;
  }
  return first;
}

std::string axis_label(SweptKey const& key) {
  std::string const unit = shown_unit(key.dimension).name;
  return key.name + (unit.empty() ? "" : " [" + (unit == "um" ? "\xc2\xb5m" : unit) + "]");
}

double shown(SweptKey const& key, SweptValue const& value) { return value.value * shown_unit(key.dimension).scale; }

/// What a point has for the other keys, in words; the name of a key where there are several.
std::string others_of(SweepPlan const& plan, SweepCase const& one, std::vector<std::string> const& but) {
  bool const several = plan.keys.size() > but.size() + 1;
  std::string words;
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    if (std::ranges::find(but, plan.keys[k].name) != but.end()) continue;
    SweptValue const& value = one.values[k];
    bool const number = plan.keys[k].is_number && std::isfinite(value.value);
    std::string const name = plan.keys[k].name.substr(plan.keys[k].name.rfind('.') + 1);
    words += fmt::format("{}{}{}", words.empty() ? "" : ", ", several ? name + " " : "",
                         number ? format_quantity(value.value, plan.keys[k].dimension) : value.text);
  }
  return words;
}

/// Points that differ in one key only.
struct Line {
  std::string others;  ///< what they share, in words
  std::vector<SweepCase const*> points;
};

std::vector<Line> lines_along(SweepPlan const& plan, std::size_t key) {
  std::vector<Line> lines;
  for (SweepCase const* one : first_cases(plan)) {
    std::string const others = others_of(plan, *one, {plan.keys[key].name});
    auto line = std::ranges::find(lines, others, &Line::others);
    if (line == lines.end()) line = lines.insert(line, Line{others, {}});
    line->points.push_back(one);
  }
  for (Line& line : lines)
    std::ranges::stable_sort(line.points, {}, [&](SweepCase const* one) { return one->values[key].value; });
  return lines;
}

std::string along(SweepPlan const& plan, SweepTable const& table, std::size_t key, std::size_t quantity) {
  LinePlot plot{.x_label = axis_label(plan.keys[key]), .y_label = title_of(table.quantities[quantity]), .series = {}};
  for (Line const& line : lines_along(plan, key)) {
    Series series{.name = line.others, .x = {}, .y = {}};
    for (SweepCase const* one : line.points) {
      Sample const& sample = table.points[one->point][quantity];
      series.x.push_back(shown(plan.keys[key], one->values[key]));
      series.y.push_back(sample.mean);
      series.error.push_back(std::isfinite(sample.half_width) ? sample.half_width : 0.0);
    }
    plot.series.push_back(std::move(series));
  }
  if (plot.series.size() > 4) plot.width = 620;  // room for the names
  return line_plot(plot);
}

std::string against(SweepPlan const& plan, SweepTable const& table, std::size_t key, std::size_t quantity) {
  PointSeries points;
  for (SweepCase const* one : first_cases(plan)) {
    Sample const& sample = table.points[one->point][quantity];
    points.x.push_back(shown(plan.keys[key], one->values[key]));
    points.y.push_back(sample.mean);
    points.y_error.push_back(std::isfinite(sample.half_width) ? sample.half_width : 0.0);
    points.words.push_back(words_of(plan, *one));
  }
  ScatterPlot plot{
      .x_label = axis_label(plan.keys[key]), .y_label = title_of(table.quantities[quantity]), .series = {points}};
  return scatter_plot(plot);
}

/// Number keys that differ between points, those with most values first.
std::vector<std::size_t> number_keys(SweepPlan const& plan) {
  std::vector<std::size_t> keys;
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    SweptKey const& key = plan.keys[k];
    if (key.is_number && key.values.size() > 1 && std::isfinite(key.values[0].value)) keys.push_back(k);
  }
  std::ranges::stable_sort(keys, std::greater{}, [&](std::size_t k) { return plan.keys[k].values.size(); });
  return keys;
}

std::string trends(SweepPlan const& plan, SweepTable const& table) {
  std::vector<std::size_t> const keys = number_keys(plan);
  if (keys.empty()) return "";
  bool const in_lines = plan.design == SweepDesign::grid && lines_along(plan, keys.front()).size() <= most_series;
  std::string figures;
  for (std::size_t q = 0; q < table.quantities.size(); ++q) {
    if (!varies(table, q)) continue;
    if (in_lines) {
      figures += figure(along(plan, table, keys.front(), q), "", "points.csv");
    } else {
      for (std::size_t const key : keys) figures += figure(against(plan, table, key, q), "", "points.csv");
    }
  }
  if (figures.empty()) return "";
  std::string lines;
  for (std::size_t k = 0; in_lines && k < plan.keys.size(); ++k) {
    if (k != keys.front())
      lines += fmt::format("{}<code>{}</code>", lines.empty() ? " Lines: equal " : ", ", plan.keys[k].name);
  }
  if (!lines.empty()) lines += ".";
  return fmt::format("<p>{}{}</p>\n<div class=\"pairs\">{}</div>\n",
                     plan.replicates > 1
                         ? fmt::format("Means over {} seeds with their 95 % t-interval.", plan.replicates)
                         : "One seed a point: there is nothing that error bars could be made of.",
                     lines, figures);
}

struct Window {
  std::string others;  ///< what its points share beside power and speed, in words
  ProcessingWindow map;
};

/// Power and speed swept over tracks: what their pools mean for parts, a map for every combination of other keys.
std::vector<Window> windows_of(SweepPlan const& plan, SweepTable const& table) {
  auto const key = [&](char const* name) { return std::ranges::find(plan.keys, name, &SweptKey::name); };
  auto const quantity = [&](char const* name) {
    return std::ranges::find(table.quantities, name, &ShownQuantity::key) - table.quantities.begin();
  };
  auto const width = static_cast<std::size_t>(quantity("pool.width")),
             depth = static_cast<std::size_t>(quantity("pool.depth"));
  if (key("laser.power") == plan.keys.end() || key("scan.scan_speed") == plan.keys.end()) return {};
  if (std::max(width, depth) == table.quantities.size()) return {};
  std::vector<Window> windows;
  for (SweepCase const* one : first_cases(plan)) {
    Case const& checked = one->checked;
    bool const powder = spreads_first(plan.verb, checked) || plan.verb == Verb::run;
    double const hatch = checked.scan.kind == ScanKind::hatch ? checked.scan.hatch_spacing : plan.hatch_spacing,
                 layer = checked.has_machine() ? checked.machine.layer_thickness : plan.layer_thickness;
    std::vector<Sample> const& figures = table.points[one->point];
    bool const done = std::ranges::any_of(figures, [](Sample const&sample) { return sample.n > 0; }),
               melts = figures[width].n > 0 && figures[depth].n > 0;
    if (!(hatch > 0) || !(layer > 0) || !done) continue;
    double const w = melts ? 1e-6 * figures[width].mean : 0,
                 d = melts ? 1e-6 * figures[depth].mean + (powder ? layer : 0) : 0;
    std::string const others = others_of(plan, *one, {"laser.power", "scan.scan_speed"});
    auto at = std::ranges::find(windows, others, &Window::others);
    if (at == windows.end()) {
      at = windows.insert(at, Window{others, {}});
      at->map.hatch_spacing = hatch;
      at->map.layer_thickness = layer;
      at->map.pool_origin =
          fmt::format("<code>layerloop {}</code>{}", name_of(plan.verb), others.empty() ? "" : ", " + escape(others));
    }
    at->map.points.push_back({checked.laser.power, checked.scan.scan_speed, w, d});
  }
  std::erase_if(windows, [](Window const& window) { return window.map.points.size() < 4; });
  return windows;
}

std::string window_figures(SweepPlan const& plan, SweepTable const& table) {
  std::string figures;
  std::vector<Window> const windows = windows_of(plan, table);
  for (std::size_t k = 0; k < std::min(windows.size(), most_windows); ++k)
    figures += processing_window_figure(windows[k].map, fmt::format("window_{}.csv", k + 1));
  if (windows.size() > most_windows)
    figures +=
        fmt::format("<p>Further ones, up to <code>window_{}.csv</code>, lie beside this page.</p>\n", windows.size());
  return figures;
}

std::string point_table(SweepPlan const& plan, SweepTable const& table) {
  std::string head, rows;
  for (SweptKey const& key : plan.keys) head += fmt::format("<th>{}</th>", escape(axis_label(key)));
  for (std::size_t q = 0; q < table.quantities.size(); ++q)
    if (varies(table, q)) head += fmt::format("<th>{}</th>", escape(title_of(table.quantities[q])));
  for (SweepCase const* one : first_cases(plan)) {
    rows += "<tr>";
    for (std::size_t k = 0; k < plan.keys.size(); ++k) {
      bool const number = plan.keys[k].is_number && std::isfinite(one->values[k].value);
      rows += fmt::format("<td>{}</td>", number ? fmt::format("{:.5g}", shown(plan.keys[k], one->values[k]))
                                                : escape(one->values[k].text));
    }
    for (std::size_t q = 0; q < table.quantities.size(); ++q) {
      Sample const& sample = table.points[one->point][q];
      if (varies(table, q)) rows += fmt::format("<td>{}</td>", with_uncertainty(sample.mean, sample.half_width));
    }
    rows += "</tr>\n";
  }
  return fmt::format(
      "<div class=\"scroll\"><table class=\"figures\"><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n<p "
      "class=\"numbers-line\"><a class=\"numbers\" href=\"points.csv\">points.csv</a></p>\n",
      head, rows);
}

std::string case_rows(SweepPlan const& plan, std::vector<CaseRecord> const& records) {
  std::string rows;
  for (std::size_t k = 0; k < plan.cases.size(); ++k) {
    SweepCase const& one = plan.cases[k];
    std::string const folder = case_folder(one.number);
    bool const done = records[k].state == CaseState::done;
    std::string const name = done ? fmt::format("<a href=\"{0}/report.html\">{0}</a>", folder) : folder;
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", name,
                        escape(words_of(plan, one)), one.checked.seed, name_of(records[k].state),
                        done ? fmt::format("{:.1f} s", records[k].wall_time) : escape(records[k].reason));
  }
  return "<div class=\"scroll\"><table class=\"words\"><thead><tr><th>case</th><th>settings</th><th>seed</th>"
         "<th>state</th><th>time, or why not</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n<p class=\"numbers-line\"><a class=\"numbers\" href=\"cases.csv\">cases.csv" +
         "</a></p>\n";
}

std::string cards(SweepPlan const& plan, std::vector<CaseRecord> const& records) {
  double const time = std::transform_reduce(records.begin(), records.end(), 0.0, std::plus{},
                                            [](CaseRecord const& r) { return r.wall_time; });
  auto const open = count_of(records, CaseState::waiting) + count_of(records, CaseState::interrupted) +
                    count_of(records, CaseState::running);
  return "<div class=\"cards\">\n" +
         card("cases done", fmt::format("{} of {}", count_of(records, CaseState::done), records.size()),
              fmt::format("{} points, {} seed{} each", plan.points, plan.replicates, plan.replicates == 1 ? "" : "s")) +
         card("failed", count(count_of(records, CaseState::failed)), "stopped by a guard of the model") +
         card("open", count(open), "waiting, running or interrupted: go on with --resume") +
         card("time", fmt::format("{} <span class=\"unit\">s</span>", significant(time)), "of all cases together") +
         "</div>\n";
}

}  // namespace

void write_windows(SweepPlan const& plan, SweepTable const& table, std::filesystem::path const& folder) {
  std::vector<Window> const windows = windows_of(plan, table);
  for (std::size_t k = 0; k < windows.size(); ++k)
    write_file(folder / fmt::format("window_{}.csv", k + 1), processing_window_csv(windows[k].map));
}

std::string sweep_page(SweepPlan const& plan, std::vector<CaseRecord> const& records, SweepTable const& table) {
  Page page{.title = plan.name,
            .version = program_version(),
            .headline = fmt::format("{} cases of <code>layerloop {}</code>.", plan.cases.size(), name_of(plan.verb)),
            .cards = cards(plan, records),
            .seed = plan.cases.front().checked.seed,
            .files = "; each case has a folder of its own, with its own report"};
  page.add("window", "Processing window", window_figures(plan, table));
  page.add("trends", "What depends on what", trends(plan, table));
  page.add("points", "Point by point", point_table(plan, table));
  page.add("cases", "Every case", case_rows(plan, records));
  return page.html();
}

}  // namespace layerloop::coupling
