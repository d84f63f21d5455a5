#include "validation/addition_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "coupling/report/svg_scatter.hpp"
#include "validation/explain_figures.hpp"
#include "validation/explain_tables.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;
using coupling::card;
using coupling::escape;
using coupling::figure;
using coupling::significant;
using nlohmann::json;

std::string names_of(std::vector<AddedEffect> const& effects) {
  std::string names;
  for (AddedEffect const& effect : effects) names += (names.empty() ? "" : " and ") + effect.name;
  return names;
}

std::string effect_cards(BeforeAfter const& both) {
  std::string cards;
  for (AddedEffect const& effect : both.effects)
    cards += card(escape(effect.name), coupling::with_uncertainty(effect.strength, effect.u_strength),
                  "strength on top of the case &plusmn; 1 sd");
  return cards;
}

struct Step {
  std::string name;
  double rms;
};
std::vector<Step> steps_of(BeforeAfter const& both) {
  auto const rms = [&](double chi2) { return std::sqrt(chi2 / static_cast<double>(both.study.observations.size())); };
  return {{"the case as it stands", rms(both.chi2_base)},
          {"calibrated", rms(both.chi2_before)},
          {"with " + names_of(both.effects), rms(both.chi2_after)},
          {"noise", rms(both.dof)}};
}

std::string steps_csv(std::vector<Step> const& steps) {
  std::string text = "step,rms [sd]\n";
  for (Step const& step : steps) text += fmt::format("{},{:.6g}\n", step.name, step.rms);
  return text;
}

std::string steps_figure(std::vector<Step> const& steps, std::string const& caption, std::string const& csv) {
  coupling::LyingBars plot{.x_label = "root mean square of the misfit [sd]", .bars = {}, .marks = {1}};
  for (Step const& step : steps)
    plot.bars.push_back({.name = step.name,
                         .value = step.rms,
                         .words = fmt::format("{:.2f}", step.rms),
                         .strong = step.name.starts_with("with ")});
  return figure(coupling::lying_bars(plot), caption, csv);
}

json effects_json(BeforeAfter const& both) {
  json all = json::array();
  for (AddedEffect const& effect : both.effects)
    all.push_back({{"name", effect.name}, {"strength", effect.strength}, {"u_strength", number(effect.u_strength)}});
  return all;
}

coupling::Page page_of(BeforeAfter const& both, std::string const& headline) {
  return {.title = both.study.name,
          .version = LAYERLOOP_VERSION,
          .headline = headline,
          .cards = "",
          .seed = both.after.point.seeds,
          .files = ""};
}

json held_out(HeldOutError const& error) {
  return {{"readings", error.readings},
          {"rms_before", number(error.rms_before)},
          {"rms_after", number(error.rms_after)},
          {"inside_2u_before", number(error.inside_before)},
          {"inside_2u_after", number(error.inside_after)}};
}

std::string held_out_table(Confirmation const& found) {
  std::string rows;
  auto const row = [&](std::string const& name, HeldOutError const& e) {
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.2f} %</td><td>{:.2f} %</td><td>{:.0f} %</td><td>{:.0f} "
        "%</td></tr>\n",
        escape(name), e.readings, 100 * e.rms_before, 100 * e.rms_after, 100 * e.inside_before, 100 * e.inside_after);
  };
  for (auto const& [quantity, error] : found.quantities) row(quantity, error);
  row("all", found.all);
  return "<table class=\"figures\"><thead><tr><th>quantity</th><th>readings</th><th>rms error before</th><th>after</th>"
         "<th>within 2 u before</th><th>after</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::vector<Step> held_out_steps(Confirmation const& found) {
  return {{"calibrated", found.whitened_rms_before},
          {"with " + names_of(found.train.effects), found.whitened_rms_after},
          {"noise", 1}};
}

std::string confirmation_sentence(Confirmation const& found) {
  std::string const gain = fmt::format(
      "a held-out reading's squared residual falls by {:.2f} variances (95 % interval {:.2f} to {:.2f}, {} conditions)",
      found.gain, found.ci95[0], found.ci95[1], found.conditions);
  if (found.confirmed) return fmt::format("{} is confirmed: {}.", names_of(found.train.effects), gain);
  return fmt::format("{} is not confirmed: {}{}.", names_of(found.train.effects), gain,
                     found.conditions < 3 ? "; fewer than three held-out conditions prove nothing" : "");
}

std::string confirmation_page(Confirmation const& found, std::string const& verdict, std::size_t looks) {
  coupling::Page page =
      page_of(found.train, fmt::format("<b>{}.</b> {}", found.confirmed ? "Confirmed" : "Not confirmed",
                                       escape(confirmation_sentence(found))));
  page.cards =
      "<div class=\"cards\">\n" +
      card("Verdict", escape(verdict),
           looks == 1 ? "after the first look at the holdout" : fmt::format("after look {} at the holdout", looks)) +
      card("Held-out error",
           fmt::format("{:.1f} &rarr; {:.1f} %", 100 * found.all.rms_before, 100 * found.all.rms_after),
           fmt::format("rms over {} readings that nobody used", found.all.readings)) +
      card("In standard deviations",
           fmt::format("{:.2f} &rarr; {:.2f}", found.whitened_rms_before, found.whitened_rms_after), "noise alone: 1") +
      effect_cards(found.train) + "</div>\n";
  page.add("parity", "Held-out measurements", parity_figures(found.study, found.table, true, "holdout.csv"));
  page.add("quantities", "By quantity", held_out_table(found));
  page.add("waterfall", "Before and after",
           steps_figure(held_out_steps(found), "On the holdout.", "waterfall_holdout.csv") +
               steps_figure(steps_of(found.train),
                            "On the training data. Before and after share mesh, random numbers and calibration.",
                            "waterfall_train.csv"));
  return page.html();
}

}  // namespace

std::string addition_in_words(BeforeAfter const& both, fs::path const& case_file) {
  std::string text;
  for (AddedEffect const& effect : both.effects)
    text += fmt::format("{}: strength {:.3g} +- {:.2g} with fresh seeds\n", effect.name, effect.strength,
                        effect.u_strength);
  for (Step const& step : steps_of(both)) text += fmt::format("  {:40} {:8.2f} sd\n", step.name, step.rms);
  return text + case_file.string() + '\n';
}

void write_addition(fs::path const& folder, BeforeAfter const& both) {
  std::vector<Step> const steps = steps_of(both);
  coupling::Page page = page_of(both, fmt::format("{} added. Both models were calibrated anew, with fresh seeds.",
                                                  escape(names_of(both.effects))));
  page.cards = "<div class=\"cards\">\n" + effect_cards(both) +
               card("Misfit", fmt::format("{} &rarr; {}", significant(both.chi2_before), significant(both.chi2_after)),
                    fmt::format("chi2, {:.0f} degrees of freedom", both.dof)) +
               "</div>\n";
  page.add("waterfall", "Before and after", steps_figure(steps, "Down to the noise, 1.", "waterfall.csv"));
  page.add("parity", "Model against measurement", parity_figures(both.study, both.table, true, "observations.csv"));
  write_file(folder / "waterfall.csv", steps_csv(steps));
  write_file(folder / "observations.csv", observations_csv(both.study, both.table));
  write_file(folder / "report.html", page.html());
  json const summary{{"verb", "add"},
                     {"study", both.study.name},
                     {"version", LAYERLOOP_VERSION},
                     {"effects", effects_json(both)},
                     {"chi2_base", number(both.chi2_base)},
                     {"chi2_before", number(both.chi2_before)},
                     {"chi2_after", number(both.chi2_after)},
                     {"dof", both.dof},
                     {"seeds", both.after.point.seeds}};
  write_file(folder / "summary.json", summary.dump(2) + "\n");
}

std::string verdict_after(std::string const& verdict, Confirmation const& found) {
  if (found.confirmed) return verdict;
  return found.ci95[1] > 0 ? "PARTIAL" : "UNKNOWN";
}

std::string confirmation_in_words(Confirmation const& found, ReadExplanation const& explained, std::size_t looks) {
  std::string text = fmt::format(
      "{}: {}\n  held-out error {:.2f} % -> {:.2f} % over {} readings; {:.2f} -> {:.2f} standard deviations\n",
      found.confirmed ? "CONFIRMED" : "NOT CONFIRMED", confirmation_sentence(found), 100 * found.all.rms_before,
      100 * found.all.rms_after, found.all.readings, found.whitened_rms_before, found.whitened_rms_after);
  std::string const left = verdict_after(explained.verdict, found);
  if (left != explained.verdict) text += fmt::format("  the verdict {} becomes {}\n", explained.verdict, left);
  if (looks > 1)
    text += fmt::format(
        "  this is look {} at this holdout: what was chosen after an earlier look is not proven by it\n", looks);
  return text;
}

void write_confirmation(fs::path const& folder, Confirmation const& found, ReadExplanation const& explained,
                        std::size_t looks) {
  std::string const verdict = verdict_after(explained.verdict, found);
  json summary{{"verb", "confirm"},
               {"study", found.train.study.name},
               {"version", LAYERLOOP_VERSION},
               {"confirmed", found.confirmed},
               {"verdict_before", explained.verdict},
               {"verdict", verdict},
               {"effects", effects_json(found.train)},
               {"rms_before", number(found.all.rms_before)},
               {"rms_after", number(found.all.rms_after)},
               {"whitened_rms_before", number(found.whitened_rms_before)},
               {"whitened_rms_after", number(found.whitened_rms_after)},
               {"gain", number(found.gain)},
               {"ci95", {number(found.ci95[0]), number(found.ci95[1])}},
               {"holdout_points", found.all.readings},
               {"holdout_conditions", found.conditions},
               {"looks", looks},
               {"quantities", json::object()}};
  for (auto const& [quantity, error] : found.quantities) summary["quantities"][quantity] = held_out(error);
  summary["definitions"] = {
      {"rms_before", "root mean square of (measured - model) / measured over the holdout, calibrated without effects"},
      {"whitened_rms_after", "the same in standard deviations, shared errors and calibration's uncertainty in them"},
      {"ci95", "of gain: what the effects take off a held-out squared residual, in variances; mean over conditions"}};
  write_file(folder / "holdout.csv", observations_csv(found.study, found.table));
  write_file(folder / "train.csv", observations_csv(found.train.study, found.train.table));
  write_file(folder / "waterfall_holdout.csv", steps_csv(held_out_steps(found)));
  write_file(folder / "waterfall_train.csv", steps_csv(steps_of(found.train)));
  write_file(folder / "report.html", confirmation_page(found, verdict, looks));
  write_file(folder / "summary.json", summary.dump(2) + "\n");
}

void downgrade(fs::path const& explain_summary, Confirmation const& found, ReadExplanation const& explained) {
  std::string const left = verdict_after(explained.verdict, found);
  if (left == explained.verdict) return;
  fs::path const path = fs::is_directory(explain_summary) ? explain_summary / "summary.json" : explain_summary;
  json summary = json::parse(read_file(path));
  summary["verdict"] = left;
  summary["verdict_before_confirm"] = explained.verdict;
  summary["sentence"] = explained.sentence + " The holdout did not confirm it.";
  write_file(path, summary.dump(2) + "\n");
}

}  // namespace layerloop::validation
