#include "validation/learning/learn_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coupling/program_version.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "coupling/report/svg_plot.hpp"
#include "coupling/report/svg_scatter.hpp"
#include "coupling/sweep/sweep_table.hpp"

namespace layerloop::validation {
namespace {

using coupling::card;
using coupling::escape;
using coupling::figure;
using coupling::significant;

std::string axis_label(coupling::SweptKey const& key) {
  std::string const unit = coupling::shown_unit(key.dimension).name;
  return key.name + (unit.empty() ? "" : " [" + (unit == "um" ? "\xc2\xb5m" : unit) + "]");
}

/// "layer thickness [um]", which breaks into lines on a card.
std::string card_label(coupling::SweptKey const& key) {
  std::string label = axis_label(key);
  label.erase(0, label.find('.') + 1);
  std::ranges::replace(label, '_', ' ');
  return label;
}

std::string best_word(Goal goal) { return goal == Goal::minimise ? "smallest" : "largest"; }

std::string interval(double low, double high) { return significant(low) + " to " + significant(high); }

std::string cards(LearnStudy const& study, LearnResults const& results) {
  coupling::ShownQuantity const& output = study.settings.output;
  Optimum const& found = results.optimum;
  std::string all =
      "<div class=\"cards\">\n" +
      card(fmt::format("{} {}", best_word(study.settings.goal), escape(coupling::title_of(output))),
           significant(output.scale * found.value.mean),
           fmt::format("95 %: {}", interval(output.scale * found.value_low, output.scale * found.value_high)));
  for (std::size_t k = 0; k < study.plan.keys.size(); ++k) {
    auto const d = static_cast<Eigen::Index>(k);
    double const scale = coupling::shown_unit(study.plan.keys[k].dimension).scale;
    all +=
        card(escape(card_label(study.plan.keys[k])), significant(scale * found.place[d]),
             fmt::format("95 %: {}; looked from {}", interval(scale * found.place_low[d], scale * found.place_high[d]),
                         interval(scale * study.box.low[d], scale * study.box.high[d])));
  }
  if (auto const failed = failed_runs(study); failed > 0)
    all += card("failed runs", std::to_string(failed),
                fmt::format("of {}; the optimum is looked for where the nearest run did not", study.trials.size()));
  return all + "</div>\n";
}

std::string in_words(Acquisition acquisition) {
  std::string words = name_of(acquisition);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string headline(LearnStudy const& study, LearnResults const& results) {
  bool const varies = !results.surrogates.empty() && results.surrogates.front().output.key == study.settings.output.key;
  if (!varies)
    return fmt::format("{} runs: {} does not vary.", study.trials.size(), escape(study.settings.output.label));
  Skill const& skill = results.surrogates.front().skill;
  return fmt::format(
      "{} runs: {} of the start design and {} where {} sent them. Left out place by place, {} is predicted with an "
      "error "
      "of {} (Q2 = {:.2f}), and {:.0f} % of its 95 % intervals hold.",
      study.trials.size(), study.start * static_cast<std::size_t>(study.plan.replicates),
      (study.plan.points - study.start) * static_cast<std::size_t>(study.plan.replicates),
      in_words(study.settings.acquisition), escape(study.settings.output.label),
      significant(study.settings.output.scale * skill.rmse), skill.q2, 100 * skill.coverage);
}

std::string parity(LearnStudy const& study, LearnResults const& results) {
  coupling::ShownQuantity const& output = study.settings.output;
  coupling::PointSeries start{.name = "start design", .x = {}, .y = {}, .hollow = true};
  coupling::PointSeries active{.name = "acquisition", .x = {}, .y = {}};
  for (std::size_t i = 0; i < results.used.size(); ++i) {
    coupling::SweepCase const& one = study.plan.cases[results.used[i]];
    coupling::PointSeries& series = one.point < study.start ? start : active;
    auto const row = static_cast<Eigen::Index>(i);
    series.x.push_back(output.scale * results.values[row]);
    series.y.push_back(output.scale * results.left_out.mean[row]);
    series.y_error.push_back(1.96 * output.scale * results.left_out.sd[row]);
    series.words.push_back(fmt::format("case {}: {}", one.number, words_of(study.plan, one)));
  }
  std::vector<coupling::PointSeries> series{start};
  if (!active.x.empty()) series.push_back(active);
  return figure(coupling::scatter_plot({.x_label = "simulated " + coupling::title_of(output),
                                        .y_label = "predicted from the other places",
                                        .series = series,
                                        .diagonal = coupling::Diagonal::drawn,
                                        .width = 540,
                                        .height = 400}),
                "Bars: 95 % intervals of a run, its noise included.", "left_out.csv");
}

std::string progress(LearnStudy const& study, LearnResults const& results) {
  if (results.history.size() < 2) return "";
  coupling::ShownQuantity const& output = study.settings.output;
  coupling::Series best{.name = "best run so far", .x = {}, .y = {}},
      believed{.name = "optimum of the surrogate", .x = {}, .y = {}};
  for (Believed const& one : results.history) {
    auto const cases = static_cast<double>(one.cases);
    best.x.push_back(cases), best.y.push_back(output.scale * one.best), best.error.push_back(0);
    believed.x.push_back(cases), believed.y.push_back(output.scale * one.optimum.mean);
    believed.error.push_back(1.96 * output.scale * one.optimum.sd);
  }
  return figure(
      coupling::line_plot(
          {.x_label = "runs", .y_label = coupling::title_of(output), .series = {best, believed}, .whole_x = true}),
      "After every run of the search. A run has noise, so the best of many runs is too good; the surrogate, with "
      "its 95 % interval, averages it out.",
      "learn.csv");
}

std::string slices(LearnStudy const& study, LearnResults const& results) {
  coupling::ShownQuantity const& output = study.settings.output;
  std::string figures;
  for (std::size_t k = 0; k < results.slices.size(); ++k) {
    double const scale = coupling::shown_unit(study.plan.keys[k].dimension).scale;
    Slice const& slice = results.slices[k];
    coupling::Series series{.name = "", .x = {}, .y = {}};
    for (std::size_t i = 0; i < slice.x.size(); ++i) {
      series.x.push_back(scale * slice.x[i]);
      series.y.push_back(output.scale * slice.mean[i]);
      series.error.push_back(1.96 * output.scale * slice.sd[i]);
    }
    figures += figure(
        coupling::line_plot(
            {.x_label = axis_label(study.plan.keys[k]), .y_label = coupling::title_of(output), .series = {series}}),
        "", "slices.csv");
  }
  return "<p>Through the optimum, the other keys held there. Bars: 95 % intervals of the surrogate, without the noise "
         "of a "
         "run.</p>\n<div class=\"pairs\">" +
         figures + "</div>\n";
}

std::string skill_cells(Skill const& skill, double scale) {
  if (skill.n == 0) return "<td></td><td></td><td></td>";
  return fmt::format("<td>{}</td><td>{:.2f}</td><td>{:.0f} % ({:.0f} to {:.0f})</td>", significant(scale * skill.rmse),
                     skill.q2, 100 * skill.coverage, 100 * skill.coverage_low, 100 * skill.coverage_high);
}

std::string table(std::string const& head, std::string const& rows, std::string const& csv) {
  return fmt::format(
      "<div class=\"scroll\"><table class=\"figures\"><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n<p "
      "class=\"numbers-line\"><a class=\"numbers\" href=\"{}\">{}</a></p>\n",
      head, rows, csv, csv);
}

std::string surrogate_table(LearnResults const& results) {
  std::string rows;
  for (OutputSkill const& one : results.surrogates)
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>{}<td>{}</td></tr>\n",
                        escape(coupling::title_of(one.output)), one.skill.n, skill_cells(one.skill, one.output.scale),
                        significant(one.output.scale * one.noise_sd));
  return "<p>Each place predicted from the others, with the kernel of all runs. Q2 = 1 - (error / spread of the "
         "runs)<sup>2</sup>: 1 is perfect, 0 "
         "no "
         "better than the average.</p>\n" +
         table(
             "<th>output</th><th>runs</th><th>error (rms)</th><th>Q2</th><th>in the 95 % interval</th><th>noise of a "
             "run (sd)</th>",
             rows, "surrogates.csv");
}

std::string layer_table(LearnResults const& results) {
  if (results.layer_models.empty()) return "";
  std::vector<coupling::ShownQuantity> const outputs = coupling::layer_quantities();
  std::string rows;
  for (LayerSkill const& one : results.layer_models) {
    auto const output = std::ranges::find(outputs, one.output, &coupling::ShownQuantity::key);
    rows += fmt::format("<tr><th scope=\"row\">{}</th><th>{}</th>{}{}</tr>\n", escape(coupling::title_of(*output)),
                        escape(words_of(one.model)), skill_cells(one.last, output->scale),
                        skill_cells(one.all, output->scale));
  }
  return "<p>Each place predicted from the others. Models of roughness and void layer need the layer below, which only "
         "a "
         "run tells.</p>\n" +
         table(
             "<th>output</th><th>predicted from</th><th>last layer: error</th><th>Q2</th><th>in 95 %</th><th>all "
             "layers: "
             "error</th><th>Q2</th><th>in 95 %</th>",
             rows, "layer_models.csv");
}

}  // namespace

std::string learn_page(LearnStudy const& study, LearnResults const& results) {
  coupling::Page page{.title = study.plan.name,
                      .version = coupling::program_version(),
                      .headline = headline(study, results),
                      .cards = cards(study, results),
                      .seed = study.settings.seed,
                      .files = ""};
  page.add("progress", "Run by run", progress(study, results));
  page.add("slices", "Through the optimum", slices(study, results));
  page.add("left-out", "Predicted and simulated", parity(study, results));
  page.add("surrogates", "Every output", surrogate_table(results));
  page.add("layers", "Models of a layer", layer_table(results));
  page.add("cases", "Cases", "<p><a href=\"cases.html\">Every case, with what was varied</a></p>\n");
  return page.html();
}

}  // namespace layerloop::validation
