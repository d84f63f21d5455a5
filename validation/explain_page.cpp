// The report of the verb explain: one HTML file.
#include "validation/explain_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "validation/explain_figures.hpp"
#include "validation/explain_output.hpp"

namespace layerloop::validation {
namespace {

using coupling::card;
using coupling::escape;
using coupling::significant;
using coupling::with_uncertainty;

std::string verdict_words(Verdict verdict) {
  std::string words = name_of(verdict);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string cards(Explanation const& explained) {
  Diagnosis const& found = explained.found;
  std::string all = "<div class=\"cards\">\n" + card("Verdict", verdict_words(found.verdict), "the words stand above");
  for (CandidateFinding const& effect : found.effects)
    if (effect.active)
      all += card(escape(effect.name + (effect.group.empty() ? "" : " or ") +
                         fmt::format("{}", fmt::join(effect.group, " or "))),
                  with_uncertainty(effect.strength, effect.u_strength),
                  fmt::format("strength &plusmn; 1 sd; z {:.1f}, ln B {:.1f}, {:.0f} % kept", effect.z, effect.evidence,
                              100 * effect.kept_fraction));
  std::string const scaled =
      found.sigma2 > 1 ? fmt::format("; uncertainties taken {:.2g} times as large", std::sqrt(found.sigma2)) : "";
  all +=
      card("Misfit", fmt::format("{} &rarr; {}", significant(found.chi2_before), significant(found.chi2_after)),
           fmt::format("chi2 after calibration and with the effects; {:.0f} degrees of freedom{}", found.dof, scaled));
  if (found.chi2_before > found.dof)
    all += card("Explained", fmt::format("{:.0f} %", 100 * std::clamp(found.explained, 0.0, 1.0)),
                fmt::format("of the excess; any smooth correction {:.0f} %", 100 * found.smooth_explained));
  return all + card("Cost", significant(found.passes), "passes of the model over the data") + "</div>\n";
}

std::string list(std::vector<std::string> const& lines) {
  std::string items;
  for (std::string const& line : lines) items += fmt::format("<li>{}</li>\n", escape(line));
  return items.empty() ? "" : "<ul class=\"reading\">\n" + items + "</ul>\n";
}

/// What these data cannot tell: limits, effects that cannot act in this study, and those that would need to be strong.
std::string not_testable(Explanation const& explained) {
  std::vector<std::string> limits = explained.study.limits;
  limits.insert(limits.end(), explained.found.limits.begin(), explained.found.limits.end());
  std::string rows;
  int count = 0;
  for (CandidateFinding const& effect : explained.found.effects) {
    auto const candidate = std::ranges::find(explained.candidates, effect.name, &Candidate::name);
    double const scale = candidate == explained.candidates.end() ? 1 : candidate->prior_scale;
    bool const blunt = effect.not_testable.empty() && effect.detectable > 2 * scale;
    if (effect.not_testable.empty() && !blunt) continue;
    ++count;
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(effect.name),
                        blunt ? fmt::format("only a strength above {} would show; {} is likely",
                                            significant(effect.detectable), significant(scale))
                              : escape(effect.not_testable));
  }
  if (!rows.empty())
    rows = fmt::format(
        "<details><summary>{} effects that could not be tested, and why</summary>\n"
        "<table class=\"words\"><tbody>\n{}</tbody></table></details>\n",
        count, rows);
  return list(limits) + rows;
}

std::string patterns(Diagnosis const& found) {
  std::string rows;
  auto const add = [&](std::string const& when, std::vector<PatternFinding> const& patterns) {
    for (std::size_t k = 0; k < std::min<std::size_t>(6, patterns.size()); ++k)
      rows += fmt::format("<tr><td>{}</td><th scope=\"row\">{}</th><td>{:.1f}</td><td>{}</td></tr>\n", when,
                          escape(patterns[k].text), patterns[k].z, significant(patterns[k].p, 2));
  };
  add("calibrated", found.patterns_before);
  add("with the effects", found.patterns_after);
  if (rows.empty()) return "";
  return "<table class=\"words\"><thead><tr><th>residuals</th><th>pattern</th><th>z</th><th>p, over all patterns</th>"
         "</tr></thead><tbody>\n" +
         rows +
         "</tbody></table>\n<p class=\"numbers-line\"><a class=\"numbers\" "
         "href=\"patterns.csv\">patterns.csv</a></p>\n";
}

std::string outliers(Diagnosis const& found) {
  std::vector<std::string> lines;
  for (OutlierFinding const& outlier : found.outliers)
    lines.push_back(fmt::format("{}: {:.1f} standard deviations off, even where every pattern is allowed",
                                outlier.obs_id, outlier.z));
  return list(lines);
}

std::string assumptions(Explanation const& explained) {
  std::vector<std::string> lines{
      "Uncertainties are normal; u_stat is independent from row to row, u_sys fully shared within a sys_group.",
      "What calibration could do to first order is taken out of every signature before it is compared with the data.",
      "An effect is named only if the model, run again with it, leaves nothing that a test at the threshold can see.",
      fmt::format("Every uncertainty was multiplied by {:.2f}, which the replicates and the residuals ask for.",
                  std::sqrt(explained.found.sigma2)),
      "A cause outside the list of candidates that acts like one of them is named as that one: its twins are in "
      "candidates.csv."};
  return list(lines);
}

std::string provenance(Explanation const& explained) {
  Thresholds const& t = explained.thresholds;
  std::string rows;
  auto const row = [&](std::string const& name, std::string const& value) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"code\">{}</td></tr>\n", escape(name), escape(value));
  };
  row("program", fmt::format("layerloop {}", LAYERLOOP_VERSION));
  row("seed", std::to_string(explained.seed));
  for (auto const& [file, digest] : explained.sha256) row("sha256 of " + file, digest);
  row("family error", fmt::format("{}", t.family_error));
  row("z of a candidate, at least", fmt::format("{:.2f}", explained.found.z_critical));
  row("z of a pattern, at least", fmt::format("{:.2f}", explained.found.pattern_critical));
  row("adequate p, rival gap, whole, structure p, of several names",
      fmt::format("{}, {}, {}, {}, {}", t.adequate_p, t.rival_gap, t.whole, t.structure_p, t.several_p));
  row("outlier z, noisy scale, large pull", fmt::format("{}, {}, {}", t.outlier_z, t.noisy_scale, t.large_pull));
  std::vector<std::string> tried;
  for (Candidate const& candidate : explained.candidates) tried.push_back(candidate.name);
  row(fmt::format("{} candidates tried", tried.size()), fmt::format("{}", fmt::join(tried, ", ")));
  return "<table class=\"words\"><tbody>\n" + rows + "</tbody></table>\n";
}

}  // namespace

std::string explain_page(Explanation const& explained) {
  Study const& study = explained.study;
  coupling::Page page{.title = study.name,
                      .version = LAYERLOOP_VERSION,
                      .headline = fmt::format("<b>{}.</b> {}", verdict_words(explained.found.verdict),
                                              escape(explained.found.sentence)),
                      .cards = cards(explained),
                      .seed = explained.seed,
                      .files = ""};
  page.add("limits", "What these data cannot tell", not_testable(explained));
  page.add("parity", "Model against measurement", parity_figures(explained));
  page.add("residuals", "Where the calibrated model is off", residual_maps(explained) + patterns(explained.found));
  page.add("stages", "Which stage", stage_strip(explained));
  page.add("evidence", "The candidates", evidence_bars(explained));
  page.add("signatures", "Residuals over signatures", signature_overlays(explained));
  page.add("confusion", "Which candidates look alike", confusion_matrix(explained));
  page.add("pulls", "What calibration did", pull_bars(explained));
  page.add("waterfall", "Before and after", waterfall_bars(explained));
  page.add("next", "What to measure next", next_table(explained));
  page.add("outliers", "Outliers", outliers(explained.found));
  page.add("assumptions", "Assumptions", assumptions(explained));
  page.add("provenance", "Provenance", provenance(explained));
  return page.html();
}

std::string next_page(Explanation const& explained) {
  std::string const answer = explained.next.empty() ? nothing_to_separate(explained)
                                                    : "Measure " + proposal_in_words(explained.next.front()) + ".";
  coupling::Page page{.title = explained.study.name,
                      .version = LAYERLOOP_VERSION,
                      .headline = escape(answer),
                      .cards = cards(explained),
                      .seed = explained.seed,
                      .files = ""};
  page.add("next", "What to measure next", next_table(explained));
  page.add("evidence", "The candidates so far", evidence_bars(explained));
  page.add("confusion", "Which candidates look alike", confusion_matrix(explained));
  return page.html();
}

}  // namespace layerloop::validation
