#include "validation/compare_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "coupling/report/html.hpp"
#include "coupling/report/svg_scatter.hpp"
#include "validation/display.hpp"

namespace layerloop::validation {
namespace {

using coupling::escape;
using coupling::figure;
using coupling::PointSeries;

std::string pairs(std::string const& figures) {
  return figures.empty() ? "" : "<div class=\"pairs\">" + figures + "</div>\n";
}

Observation const& reading(Comparison const& compared, ComparedPoint const& point) {
  return compared.study.observations[point.observation];
}

std::string words_of(Comparison const& compared, ComparedPoint const& point) {
  Observation const& seen = reading(compared, point);
  double const f = display_of(seen.quantity).factor;
  return fmt::format("{} under {}: measured {:.4g}, simulated {:.4g}, off by {:.1f} u_val", seen.id,
                     compared.study.conditions[seen.condition].id, f * point.measured, f * point.simulated,
                     point.error() / point.u_val());
}

std::string parity(Comparison const& compared, std::string const& quantity) {
  Display const shown = display_of(quantity);
  PointSeries series{.name = "simulated", .x = {}, .y = {}};
  for (ComparedPoint const& point : compared.points) {
    if (reading(compared, point).quantity != quantity) continue;
    series.x.push_back(shown.factor * point.measured);
    series.y.push_back(shown.factor * point.simulated);
    series.x_error.push_back(shown.factor * point.u_data);
    series.y_error.push_back(shown.factor * std::hypot(point.u_num, point.u_input));
    series.words.push_back(words_of(compared, point));
  }
  return figure(coupling::scatter_plot({.x_label = "measured " + shown.label(quantity),
                                        .y_label = "simulated " + shown.label(""),
                                        .series = {series},
                                        .diagonal = coupling::Diagonal::drawn,
                                        .width = 540,
                                        .height = 400}),
                escape(quantity) +
                    ": bars are one standard uncertainty, of the reading across, of mesh, sampling and "
                    "inputs up.",
                "residuals.csv");
}

/// Value of an axis for a reading, in the unit that people read; not a number where it has none.
struct Axis {
  std::string label;
  std::function<double(Observation const&, Observable const&)> of;
};

double input_of(Study const& study, Observation const& seen, std::string const& key) {
  auto const& inputs = study.conditions[seen.condition].inputs;
  auto const found = inputs.find(key);
  return found == inputs.end() ? std::nan("") : found->second * display_of(key).factor;
}

Axis input_axis(Study const& study, std::string const& key) {
  return {display_of(key).label(key),
          [&study, key](Observation const& o, Observable const&) { return input_of(study, o, key); }};
}

/// Inputs that vary over the readings, those of beam and layer first.
std::vector<std::string> varied_inputs(Comparison const& compared) {
  std::map<std::string, std::set<double>> levels;
  for (ComparedPoint const& point : compared.points)
    for (auto const& [key, value] : compared.study.conditions[reading(compared, point).condition].inputs)
      levels[key].insert(value);
  std::vector<std::string> keys;
  for (char const* key : {"laser.power", "scan.scan_speed", "laser.spot_diameter", "machine.layer_thickness"})
    if (levels.contains(key) && levels[key].size() > 1) keys.push_back(key);
  for (auto const& [key, values] : levels)
    if (values.size() > 1 && std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  return keys;
}

std::set<std::string> quantities_of(Comparison const& compared) {
  std::set<std::string> names;
  for (ComparedPoint const& point : compared.points) names.insert(reading(compared, point).quantity);
  return names;
}

/// Errors of a quantity in units of u_val over two axes; the mean where several readings share a place.
std::string map_of(Comparison const& compared, std::string const& quantity, Axis const& across, Axis const& up) {
  std::map<std::array<double, 2>, std::vector<double>> places;
  for (ComparedPoint const& point : compared.points) {
    Observation const& seen = reading(compared, point);
    Observable const& asked = compared.study.observables[seen.observable];
    std::array<double, 2> const place{across.of(seen, asked), up.of(seen, asked)};
    if (seen.quantity != quantity || !std::isfinite(place[0]) || !std::isfinite(place[1])) continue;
    places[place].push_back(point.error() / point.u_val());
  }
  if (places.size() < 3) return "";
  coupling::ColouredPoints plot{
      .x_label = across.label, .y_label = up.label, .value_label = "E / u_val", .x = {}, .y = {}, .value = {}};
  for (auto const& [place, errors] : places) {
    double mean = 0;
    for (double const error : errors) mean += error / static_cast<double>(errors.size());
    plot.x.push_back(place[0]), plot.y.push_back(place[1]), plot.value.push_back(mean);
  }
  return figure(coupling::coloured_points(plot), escape(quantity) + ": red where the model is too high.",
                "residuals.csv");
}

/// Errors of all quantities over one axis.
std::string errors_over(Comparison const& compared, Axis const& axis, bool whole) {
  std::map<std::string, PointSeries> series;
  std::set<double> places;
  for (ComparedPoint const& point : compared.points) {
    Observation const& seen = reading(compared, point);
    double const x = axis.of(seen, compared.study.observables[seen.observable]);
    if (!std::isfinite(x)) continue;
    PointSeries& one = series[seen.quantity];
    one.name = seen.quantity;
    one.x.push_back(x);
    one.y.push_back(point.error() / point.u_val());
    one.words.push_back(words_of(compared, point));
    places.insert(x);
  }
  if (places.size() < 2) return "";
  coupling::ScatterPlot plot{.x_label = axis.label,
                             .y_label = "E / u_val",
                             .series = {},
                             .levels = {-2, 0, 2},
                             .whole_x = whole,
                             .width = 540};
  for (auto const& [name, one] : series) plot.series.push_back(one);
  return figure(coupling::scatter_plot(plot),
                "Errors over " + escape(axis.label) + "; the lines stand at 0 and &plusmn; 2 u<sub>val</sub>.",
                "residuals.csv");
}

}  // namespace

std::string parity_figures(Comparison const& compared) {
  std::string all;
  for (std::string const& quantity : quantities_of(compared)) all += parity(compared, quantity);
  return pairs(all);
}

std::string residual_figures(Comparison const& compared) {
  Study const& study = compared.study;
  std::vector<std::string> const inputs = varied_inputs(compared);
  std::string over, maps;
  for (std::string const& key : inputs) over += errors_over(compared, input_axis(study, key), false);
  over += errors_over(compared, {"layer", [](auto&, Observable const& o) { return o.layer ? *o.layer : std::nan(""); }},
                      true);
  over += errors_over(
      compared,
      {"order of acquisition (row)",
       [&](Observation const& o, auto&) { return static_cast<double>(&o - study.observations.data() + 1); }},
      true);
  Axis const x{"x [um]", [](auto&, Observable const&o) { return o.x ? 1e6 * *o.x : std::nan(""); }},
      y{"y [um]", [](auto&, Observable const&o) { return o.y ? 1e6 * *o.y : std::nan(""); }};
  for (std::string const& quantity : quantities_of(compared)) {
    for (std::size_t k = 0; k + 1 < std::min<std::size_t>(inputs.size(), 4); k += 2)
      maps += map_of(compared, quantity, input_axis(study, inputs[k]), input_axis(study, inputs[k + 1]));
    maps += map_of(compared, quantity, x, y);
  }
  return pairs(over) + pairs(maps);
}

}  // namespace layerloop::validation
