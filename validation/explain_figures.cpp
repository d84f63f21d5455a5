// The pictures of the explain report.
#include "validation/explain_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "coupling/report/html.hpp"
#include "coupling/report/svg_scatter.hpp"
#include "validation/display.hpp"
#include "validation/explain_output.hpp"
#include "validation/explain_tables.hpp"

namespace layerloop::validation {
namespace {

using coupling::escape;
using coupling::figure;
using coupling::PointSeries;
using coupling::significant;

constexpr std::size_t most_bars = 16, most_overlays = 3;
constexpr double lowest_evidence = -3;

std::string pairs(std::string const& figures) {
  return figures.empty() ? "" : "<div class=\"pairs\">" + figures + "</div>\n";
}

std::set<std::string> quantities_of(Study const& study) {
  std::set<std::string> names;
  for (Observation const& seen : study.observations) names.insert(seen.quantity);
  return names;
}

bool any_active(Diagnosis const& found) {
  return std::ranges::any_of(found.effects, [](CandidateFinding const& e) { return e.active; });
}

/// Those that were tested, active ones first, then by evidence.
std::vector<CandidateFinding const*> tested(Diagnosis const& found, std::size_t most) {
  std::vector<CandidateFinding const*> chosen;
  for (CandidateFinding const& effect : found.effects)
    if (effect.not_testable.empty() && chosen.size() < most) chosen.push_back(&effect);
  return chosen;
}

Eigen::Index column_of(Diagnosis const& found, std::string const& name) {
  return std::ranges::find(found.candidate_names, name) - found.candidate_names.begin();
}

std::string parity_of(Study const& study, ObservationTable const& table, bool effects, std::string const& csv,
                      std::string const& quantity) {
  Display const shown = display_of(quantity);
  PointSeries calibrated{.name = "calibrated", .x = {}, .y = {}, .hollow = true};
  PointSeries final_model{.name = "with the effects", .x = {}, .y = {}};
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    Observation const& seen = study.observations[i];
    if (seen.quantity != quantity) continue;
    auto const k = static_cast<Eigen::Index>(i);
    std::string const& condition = study.conditions[seen.condition].id;
    for (auto& [series, model] : {std::pair{&calibrated, &table.calibrated}, {&final_model, &table.final_model}}) {
      series->x.push_back(shown.factor * table.measured[k]);
      series->y.push_back(shown.factor * (*model)[k]);
      series->x_error.push_back(shown.factor * table.u_data[k]);
      series->y_error.push_back(shown.factor * table.u_model[k]);
      series->words.push_back(fmt::format("{} under {}: measured {:.4g}, {} {:.4g}", seen.id, condition,
                                          series->x.back(), series->name, series->y.back()));
    }
  }
  std::vector<PointSeries> series{calibrated};
  if (effects) series.push_back(final_model);
  return figure(coupling::scatter_plot({.x_label = "measured " + shown.label(quantity),
                                        .y_label = "model " + shown.label(""),
                                        .series = series,
                                        .diagonal = coupling::Diagonal::drawn,
                                        .width = 540,
                                        .height = 400}),
                escape(quantity) + ": bars are one standard uncertainty, of the reading across, of the model up.", csv);
}

/// Keys of inputs that vary, those of the beam first.
std::vector<std::string> varied_inputs(Study const& study) {
  std::vector<std::string> const first{"laser.power",
                                       "scan.scan_speed",
                                       "laser.spot_diameter",
                                       "machine.layer_thickness",
                                       "machine.recoating_speed",
                                       "scan.hatch_spacing"};
  std::map<std::string, std::set<double>> values;
  for (Condition const& c : study.conditions)
    for (auto const& [key, value] : c.inputs) values[key].insert(value);
  std::vector<std::string> keys;
  for (std::string const& key : first)
    if (values.contains(key) && values[key].size() > 1) keys.push_back(key);
  for (auto const& [key, levels] : values)
    if (levels.size() > 1 && std::ranges::find(first, key) == first.end()) keys.push_back(key);
  return keys;
}

double input_of(Study const& study, Observation const& seen, std::string const& key) {
  auto const& inputs = study.conditions[seen.condition].inputs;
  auto const found = inputs.find(key);
  return found == inputs.end() ? std::nan("") : found->second * display_of(key).factor;
}

/// Mean residual of a quantity at every place of two inputs.
std::string residual_map(Explanation const& explained, std::string const& quantity, std::string const& x_key,
                         std::string const& y_key) {
  Study const& study = explained.study;
  std::map<std::pair<double, double>, std::pair<double, int>> places;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    Observation const& seen = study.observations[i];
    double const r = explained.found.table.residual_before[static_cast<Eigen::Index>(i)];
    double const x = input_of(study, seen, x_key), y = input_of(study, seen, y_key);
    if (seen.quantity != quantity || !std::isfinite(r + x + y)) continue;
    auto& [sum, n] = places[{x, y}];
    sum += r, ++n;
  }
  if (places.size() < 3) return "";
  coupling::ColouredPoints plot{.x_label = display_of(x_key).label(x_key),
                                .y_label = display_of(y_key).label(y_key),
                                .value_label = quantity + ", residual [sd]",
                                .x = {},
                                .y = {},
                                .value = {},
                                .width = 540};
  for (auto const& [place, mean] : places) {
    plot.x.push_back(place.first);
    plot.y.push_back(place.second);
    plot.value.push_back(mean.first / mean.second);
  }
  return figure(coupling::coloured_points(plot), "Measured minus model after calibration; red: the model is too low.",
                "observations.csv");
}

/// Residuals before and after over something that every observation has.
template <class Place>
std::string residual_line(Explanation const& explained, std::string const& label, Place const& place) {
  Study const& study = explained.study;
  PointSeries before{.name = "calibrated", .x = {}, .y = {}, .hollow = true};
  PointSeries after{.name = "with the effects", .x = {}, .y = {}};
  std::set<double> places;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    double const x = place(i);
    places.insert(x);
    for (auto& [series, residual] : {std::pair{&before, &explained.found.table.residual_before},
                                     {&after, &explained.found.table.residual_after}}) {
      series->x.push_back(x);
      series->y.push_back((*residual)[static_cast<Eigen::Index>(i)]);
      series->words.push_back(
          fmt::format("{} {}: {:.2f}", study.observations[i].id, study.observations[i].quantity, series->y.back()));
    }
  }
  if (places.size() < 2) return "";
  std::vector<PointSeries> series{before};
  if (any_active(explained.found)) series.push_back(after);
  return figure(
      coupling::scatter_plot(
          {.x_label = label, .y_label = "residual [sd]", .series = series, .levels = {-2, 0, 2}, .width = 540}),
      "All quantities; lines at two standard deviations.", "observations.csv");
}

std::string overlay(Explanation const& explained, CandidateFinding const& effect, double prior_scale, bool two_sided) {
  Diagnosis const& found = explained.found;
  Eigen::Index const column = column_of(found, effect.name);
  if (column >= found.table.signatures.cols()) return "";
  // The score of a two-sided candidate has no sign; its signature tells which way it would have to go.
  double const way = found.table.signatures.col(column).dot(found.table.residual_before) < 0 ? -1 : 1;
  // Residuals are in units of the scatter found, signatures in those of the stated uncertainties.
  double const factor = (two_sided ? way : 1) * std::abs(effect.strength) / (prior_scale * std::sqrt(found.sigma2));
  std::vector<PointSeries> series;
  for (std::string const& quantity : quantities_of(explained.study)) {
    PointSeries& s = series.emplace_back(PointSeries{.name = quantity, .x = {}, .y = {}});
    for (std::size_t i = 0; i < explained.study.observations.size(); ++i) {
      if (explained.study.observations[i].quantity != quantity) continue;
      auto const k = static_cast<Eigen::Index>(i);
      s.x.push_back(found.table.signatures(k, column) * factor);
      s.y.push_back(found.table.residual_before[k]);
    }
  }
  return figure(coupling::scatter_plot({.x_label = effect.name + " would change it by [sd]",
                                        .y_label = "residual [sd]",
                                        .series = series,
                                        .diagonal = coupling::Diagonal::drawn,
                                        .width = 540,
                                        .height = 400}),
                fmt::format("{} at its best strength {}; on the line it explains the residual.", escape(effect.name),
                            coupling::with_uncertainty(effect.strength, effect.u_strength)),
                "signatures.csv");
}

}  // namespace

std::string parity_figures(Study const& study, ObservationTable const& table, bool effects, std::string const& csv) {
  std::string figures;
  for (std::string const& quantity : quantities_of(study)) figures += parity_of(study, table, effects, csv, quantity);
  return pairs(figures);
}

std::string parity_figures(Explanation const& explained) {
  return parity_figures(explained.study, explained.found.table, any_active(explained.found), "observations.csv");
}

std::string residual_maps(Explanation const& explained) {
  Study const& study = explained.study;
  std::vector<std::string> const keys = varied_inputs(study);
  std::string figures;
  for (std::string const& quantity : quantities_of(study))
    for (std::size_t k = 0; k + 1 < keys.size(); k += 2)
      figures += residual_map(explained, quantity, keys[k], keys[k + 1]);
  if (keys.size() % 2 == 1)
    figures += residual_line(explained, display_of(keys.back()).label(keys.back()),
                             [&](std::size_t i) { return input_of(study, study.observations[i], keys.back()); });
  auto const observable = [&](std::size_t i) { return study.observables[study.observations[i].observable]; };
  figures += residual_line(explained, "layer", [&](std::size_t i) { return observable(i).layer.value_or(0); });
  figures += residual_line(explained, "x [um]", [&](std::size_t i) { return 1e6 * observable(i).x.value_or(0); });
  figures += residual_line(explained, "y [um]", [&](std::size_t i) { return 1e6 * observable(i).y.value_or(0); });
  figures += residual_line(explained, "order of acquisition", [](std::size_t i) { return static_cast<double>(i + 1); });
  return pairs(figures);
}

std::string stage_strip(Explanation const& explained) {
  coupling::LyingBars plot{.x_label = "mean square of the residuals [variances]", .bars = {}, .marks = {1}};
  for (StageMisfit const& m : stage_misfits(explained)) {
    plot.bars.push_back({.name = m.stage + ", calibrated",
                         .value = m.before,
                         .words = fmt::format("{} readings", m.observations),
                         .strong = false});
    if (any_active(explained.found)) plot.bars.push_back({.name = m.stage + ", with the effects", .value = m.after});
  }
  if (plot.bars.empty()) return "";
  return figure(coupling::lying_bars(plot),
                "By the stage that a quantity shows. 1: noise alone. <code>layerloop compare</code> puts measured "
                "upstream quantities in place of computed ones, to tell which stage is at fault.",
                "stages.csv");
}

std::string evidence_bars(Explanation const& explained) {
  Diagnosis const& found = explained.found;
  coupling::LyingBars evidence{.x_label = "evidence against nothing [ln of the Bayes factor]",
                               .bars = {{.name = "nothing", .value = 0, .words = "", .strong = false}}};
  coupling::LyingBars shares{.x_label = "share of the excess chi2 that is taken away", .bars = {}, .marks = {1}};
  for (CandidateFinding const* effect : tested(found, most_bars)) {
    evidence.bars.push_back({.name = effect->name,
                             .value = std::max(lowest_evidence, effect->evidence),
                             .words = fmt::format("kept {:.0f} %, z {:.1f}", 100 * effect->kept_fraction, effect->z),
                             .strong = effect->active});
    double const share = share_explained(found, effect->chi2_after);
    if (std::isfinite(share))
      shares.bars.push_back({.name = effect->name + " alone", .value = std::max(0.0, share), .strong = effect->active});
  }
  std::string figures = figure(coupling::lying_bars(evidence),
                               "Each by itself, from its signature at the calibrated model, before any refit; orange: "
                               "in the verdict. Kept: share of the signature that calibration cannot swallow; of "
                               "an effect with little kept "
                               "these data say little.",
                               "candidates.csv");
  if (found.chi2_before > found.dof) {
    shares.bars.push_back({.name = "the verdict", .value = std::max(0.0, found.explained)});
    shares.bars.push_back({.name = "any smooth correction", .value = found.smooth_explained, .strong = false});
    figures +=
        figure(coupling::lying_bars(shares),
               "Any smooth correction: one Gaussian process a quantity without physics, each condition predicted "
               "from the others. Where it does better than the verdict, something unknown is at work.",
               "candidates.csv");
  }
  return figures;
}

std::string signature_overlays(Explanation const& explained) {
  std::string figures;
  for (CandidateFinding const* effect : tested(explained.found, most_overlays)) {
    auto const candidate = std::ranges::find(explained.candidates, effect->name, &Candidate::name);
    if (candidate != explained.candidates.end())
      figures += overlay(explained, *effect, candidate->prior_scale, candidate->two_sided);
  }
  return pairs(figures);
}

std::string confusion_matrix(Explanation const& explained) {
  Diagnosis const& found = explained.found;
  std::vector<std::string> names;
  std::vector<Eigen::Index> columns;
  for (CandidateFinding const* effect : tested(found, most_bars)) {
    Eigen::Index const column = column_of(found, effect->name);
    if (column >= found.cosines.cols()) continue;
    names.push_back(effect->name);
    columns.push_back(column);
  }
  if (names.size() < 2) return "";
  std::vector<double> values;
  for (Eigen::Index const i : columns)
    for (Eigen::Index const j : columns) values.push_back(found.cosines(i, j));
  return figure(
      coupling::square_matrix(names, values, "cosines between signatures"),
      "Cosine between two signatures, in per cent, after calibration was taken out. Near &plusmn;100 these data "
      "cannot tell the two apart.",
      "cosines.csv");
}

std::string pull_bars(Explanation const& explained) {
  coupling::LyingBars plot{.x_label = "(value - prior mean) / prior sd", .bars = {}, .marks = {-3, 3}};
  for (ParameterFinding const& p : explained.found.parameters)
    plot.bars.push_back({.name = p.name,
                         .value = (p.value - p.mean) / p.sd,
                         .error = p.u / p.sd,
                         .words = fmt::format("{:.4g} +- {:.2g}, was {:.4g} +- {:.2g}", p.value, p.u, p.mean, p.sd),
                         .strong = std::abs(p.pull) >= explained.thresholds.large_pull});
  if (plot.bars.empty()) return "";
  return figure(coupling::lying_bars(plot), "Calibration numbers, in SI units; the line is one standard deviation.",
                "parameters.csv");
}

std::string waterfall_bars(Explanation const& explained) {
  coupling::LyingBars plot{.x_label = "root mean square of the misfit [sd]", .bars = {}, .marks = {1}};
  for (WaterfallStep const& step : waterfall(explained.found))
    plot.bars.push_back({.name = step.name,
                         .value = std::sqrt(step.chi2 / explained.found.dof),
                         .words = fmt::format("chi2 {:.1f}", step.chi2),
                         .strong = step.name.starts_with("with")});
  return figure(coupling::lying_bars(plot),
                fmt::format("On the training data, {:.0f} degrees of freedom. <code>layerloop confirm</code> does the "
                            "same on the holdout.",
                            explained.found.dof),
                "waterfall.csv");
}

std::string next_table(Explanation const& explained) {
  if (explained.next.empty()) return "";
  std::string rows;
  for (NextExperiment const& next : explained.next) {
    Display const shown = display_of(next.quantity);
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{} {}</td><td>{} {}</td><td>{}</td><td>{}</td></tr>\n",
        escape(measured_in_words(next)), escape(places_in_words(next)), next.replicates,
        significant(shown.factor * next.difference), shown.unit, significant(shown.factor * next.u, 2), shown.unit,
        escape(fmt::format("{}", fmt::join(next.separates, ", "))), next.simulated ? "true runs" : "surrogate");
  }
  return "<div class=\"scroll\"><table class=\"words\"><thead><tr><th>measure</th><th>at</th><th>readings</th>"
         "<th>rivals differ by</th><th>a reading's u</th><th>separates</th><th>by</th></tr></thead><tbody>\n" +
         rows +
         "</tbody></table></div>\n<p class=\"remark\">Best first. Readings: as many as put the right one ahead in 95 "
         "of 100 studies, and end the group in 77. <a class=\"numbers\" href=\"next.csv\">next.csv</a></p>\n";
}

}  // namespace layerloop::validation
