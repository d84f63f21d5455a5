// The report of the verb compare: one HTML file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "validation/compare_figures.hpp"
#include "validation/compare_output.hpp"
#include "validation/display.hpp"

namespace layerloop::validation {
namespace {

using coupling::card;
using coupling::escape;
using coupling::significant;
using coupling::with_uncertainty;

/// The null is drawn some ten thousand times.
std::string chance(double p) { return p < 1e-4 ? "&lt; 0.0001" : significant(p, 2); }

std::string cards(Comparison const& compared) {
  std::string all = "<div class=\"cards\">\n";
  all += card("Misfit", significant(compared.chi2),
              fmt::format("chi&sup2; of {} readings with all their uncertainties, nothing fitted", compared.dof));
  auto const inside = std::ranges::count_if(compared.points, &ComparedPoint::inside);
  all += card("Within 2 u<sub>val</sub>",
              compared.points.empty()
                  ? "&ndash;"
                  : fmt::format("{:.0f} %", 100.0 * static_cast<double>(inside) / static_cast<double>(compared.dof)),
              "about 95 % if model and uncertainties are right");
  if (!compared.patterns.empty())
    all += card("Strongest pattern", "p " + chance(compared.patterns.front().p),
                escape(compared.patterns.front().text) + "; p is that of the whole family");
  return all +
         card("Cost", significant(compared.passes),
              "passes of the model over the data; what the cache held counts nothing") +
         "</div>\n";
}

std::string quantity_table(Comparison const& compared) {
  std::string rows;
  for (ComparedQuantity const& q : compared.quantities) {
    double const f = display_of(q.name).factor;
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}{}</td><td>{}</td><td>{}</td><td>{:.0f}</td><td>{:.0f} %</td><td>{}</td>"
        "<td>{}</td></tr>\n",
        escape(display_of(q.name).label(q.name)), q.points,
        q.unanswered > 0 ? fmt::format(" ({} without an answer)", q.unanswered) : "", significant(q.bias * f),
        significant(q.rms * f), 100 * q.relative_rms, 100 * q.inside_2u, significant(q.area * f), significant(q.chi2));
  }
  return "<div class=\"scroll\"><table class=\"figures\"><thead><tr><th>quantity</th><th>readings</th><th>bias</th>"
         "<th>rms</th><th>rms [%]</th><th>within 2 u<sub>val</sub></th><th>area metric</th><th>chi&sup2;</th></tr>"
         "</thead><tbody>\n" +
         rows +
         "</tbody></table></div>\n<p class=\"remark\"><b>E = simulated &minus; measured</b>; bias and rms are its mean "
         "and its root mean square, [%] that of E over the reading. u<sub>val</sub>&sup2; = u<sub>num</sub>&sup2; + "
         "u<sub>input</sub>&sup2; + u<sub>D</sub>&sup2; (ASME V&amp;V 20): mesh and sampling, calibration numbers and "
         "inputs as uncertain as the study says, reading. The area metric is the area between the distributions of "
         "simulated and measured values. <a class=\"numbers\" href=\"quantities.csv\">quantities.csv</a> <a "
         "class=\"numbers\" href=\"residuals.csv\">residuals.csv</a></p>\n";
}

std::string stage_table(Comparison const& compared) {
  std::string rows;
  for (ComparedStage const& stage : compared.stages) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        name_of(stage.stage), stage.points, significant(stage.chi2),
                        stage.chi2_clamped ? fmt::format("{} of {} readings", significant(stage.chi2_of_clamped_points),
                                                         stage.clamped_points)
                                           : "&ndash;",
                        stage.chi2_clamped ? significant(*stage.chi2_clamped) : "&ndash;",
                        stage.sentence.empty() ? "&ndash;" : escape(stage.sentence));
  }
  if (rows.empty()) return "";
  return "<div class=\"scroll\"><table class=\"figures\"><thead><tr><th>stage</th><th>readings</th><th>chi&sup2;</th>"
         "<th>as simulated</th><th>with the measured absorptivity</th><th>which means</th></tr></thead><tbody>\n" +
         rows +
         "</tbody></table></div>\n<p class=\"remark\">Where a quantity that one stage hands to the next was measured "
         "under the same conditions, "
         "the later stage is run again with the measured value in the place of the simulated one.</p>\n";
}

std::string pattern_table(Comparison const& compared) {
  std::string rows;
  for (std::size_t k = 0; k < std::min<std::size_t>(10, compared.patterns.size()); ++k)
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{:.1f}</td><td>{}</td></tr>\n",
                        escape(compared.patterns[k].text), compared.patterns[k].z, chance(compared.patterns[k].p));
  if (rows.empty()) return "";
  return "<table class=\"words\"><thead><tr><th>pattern of measured &minus; simulated</th><th>z</th><th>p</th></tr>"
         "</thead><tbody>\n" +
         rows +
         "</tbody></table>\n<p class=\"remark\">Shapes without physics: offset, slope over an input, difference "
         "between labels, drift. p is the chance that any of them all is as strong where nothing is wrong. "
         "<a class=\"numbers\" href=\"patterns.csv\">patterns.csv</a></p>\n";
}

std::string regime_table(Comparison const& compared) {
  if (compared.categories.empty()) return "";
  std::map<std::array<std::string, 2>, int> counts;
  for (ComparedCategory const& c : compared.categories) ++counts[{c.measured, c.simulated}];
  auto const agree =
      std::ranges::count_if(compared.categories, [](ComparedCategory const& c) { return c.measured == c.simulated; });
  std::string rows;
  for (auto const& [words, count] : counts)
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>\n", escape(words[0]),
                        words[1].empty() ? "no answer" : escape(words[1]), count);
  return fmt::format("<p>{} of {} agree. Regimes are compared only; they enter no chi&sup2;.</p>\n", agree,
                     compared.categories.size()) +
         "<table class=\"words\"><thead><tr><th>measured</th><th>simulated</th><th>tracks</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string list(std::vector<std::string> const& lines) {
  std::string items;
  for (std::string const& line : lines) items += fmt::format("<li>{}</li>\n", escape(line));
  return items.empty() ? "" : "<ul class=\"reading\">\n" + items + "</ul>\n";
}

std::string calibration_table(Study const& study) {
  std::string rows;
  for (CalibrationParameter const& p : study.calibration) {
    Display const shown = p.relative ? Display{} : display_of(p.key);
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(shown.label(p.name)),
                        p.relative ? fmt::format("&plusmn; {} %", significant(100 * p.sd, 2))
                                   : with_uncertainty(p.mean * shown.factor, p.sd * shown.factor));
  }
  if (rows.empty()) return "";
  return "<table class=\"words\"><thead><tr><th>number of the model</th><th>known beforehand, &plusmn; 1 sd</th></tr>"
         "</thead><tbody>\n" +
         rows + "</tbody></table>\n<p class=\"remark\">Nothing is fitted here: explain does that.</p>\n";
}

std::string headline(Comparison const& compared) {
  std::set<std::size_t> conditions;
  for (Observation const& o : compared.study.observations) conditions.insert(o.condition);
  return fmt::format("The model as it stands beside {} readings under {} conditions. What was held out is not shown.",
                     compared.study.observations.size(), conditions.size());
}

}  // namespace

std::string compare_page(Comparison const& compared) {
  coupling::Page page;
  page.title = compared.study.name;
  page.version = LAYERLOOP_VERSION;
  page.seed = compared.seed;
  page.headline = headline(compared);
  page.cards = cards(compared);
  page.files = "; residuals.csv, quantities.csv and patterns.csv lie in the same folder";
  page.add("quantities", "How far off", quantity_table(compared));
  page.add("parity", "Measured and simulated", parity_figures(compared));
  page.add("stages", "Which stage", stage_table(compared));
  page.add("maps", "Where it is off", residual_figures(compared));
  page.add("patterns", "Patterns", pattern_table(compared));
  page.add("regimes", "Regimes", regime_table(compared));
  page.add("calibration", "What may be calibrated", calibration_table(compared.study));
  page.add("limits", "What these data cannot tell", list(compared.study.limits));
  page.add("notes", "What had no answer", list(compared.notes));
  return page.html();
}

}  // namespace layerloop::validation
