#include "validation/compare_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "validation/display.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t shown_patterns = 3;
constexpr double clear_p = 0.01;

json stages(Comparison const& compared) {
  json all = json::object();
  for (ComparedStage const& stage : compared.stages) {
    json one{{"points", stage.points}, {"chi2", stage.chi2}};
    if (stage.chi2_clamped) {
      one["clamped"] = stage.clamped;
      one["clamped_points"] = stage.clamped_points;
      one["chi2_simulated"] = stage.chi2_of_clamped_points;
      one["chi2_clamped"] = *stage.chi2_clamped;
      one["sentence"] = stage.sentence;
    }
    all[name_of(stage.stage)] = one;
  }
  return all;
}

json quantities_of(Comparison const& compared) {
  json all = json::object();
  for (ComparedQuantity const& q : compared.quantities)
    all[q.name] = {{"points", q.points},       {"unanswered", q.unanswered},
                   {"bias", number(q.bias)},   {"rms", number(q.rms)},
                   {"inside_2u", q.inside_2u}, {"relative_rms", number(q.relative_rms)},
                   {"area", q.area},           {"chi2", q.chi2}};
  return all;
}

json patterns_of(Comparison const& compared) {
  json all = json::array();
  for (PatternFinding const& p : compared.patterns) all.push_back({{"text", p.text}, {"z", p.z}, {"p", p.p}});
  return all;
}

json definitions() {
  return {{"chi2",
           "of measured minus simulated, nothing fitted, with the covariance of readings, mesh, sampling, "
           "calibration numbers and uncertain inputs"},
          {"dof", "readings that the model has an answer for"},
          {"bias, rms, area", "of simulated minus measured, SI; area: between their distributions"},
          {"inside_2u", "share with |E| <= 2 u_val, u_val^2 = u_num^2 + u_input^2 + u_D^2 (ASME V&V 20)"},
          {"patterns[].p", "chance that any pattern of the family is as strong without a cause"},
          {"stages.*.chi2_clamped", "with the measured upstream quantity in the place of the simulated one"},
          {"model_runs", "passes of the model over the data"}};
}

json summary(Comparison const& compared) {
  json regimes = json::array();
  for (ComparedCategory const& c : compared.categories)
    regimes.push_back(
        {{"obs_id", c.id}, {"condition_id", c.condition}, {"measured", c.measured}, {"simulated", c.simulated}});
  return {{"verb", "compare"},
          {"study", compared.study.name},
          {"version", LAYERLOOP_VERSION},
          {"chi2", compared.chi2},
          {"dof", compared.dof},
          {"quantities", quantities_of(compared)},
          {"stages", stages(compared)},
          {"patterns", patterns_of(compared)},
          {"regimes", regimes},
          {"limits", compared.study.limits},
          {"notes", compared.notes},
          {"model_runs", compared.passes},
          {"definitions", definitions()}};
}

std::string quoted(std::string const& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string all = "\"";
  for (char const c : text) all += c == '"' ? std::string("\"\"") : std::string(1, c);
  return all + "\"";
}

std::string residuals(Comparison const& compared) {
  std::string text =
      "obs_id,condition_id,quantity,unit,measured,simulated,error,u_data,u_num,u_input,u_val,inside_2u\n";
  for (ComparedPoint const& point : compared.points) {
    Observation const& seen = compared.study.observations[point.observation];
    text += fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g},{:.4g},{:.4g},{:.4g},{:.4g},{}\n", quoted(seen.id),
                        quoted(compared.study.conditions[seen.condition].id), seen.quantity,
                        si_unit(display_of(seen.quantity).dimension), point.measured, point.simulated, point.error(),
                        point.u_data, point.u_num, point.u_input, point.u_val(), point.inside() ? 1 : 0);
  }
  return text;
}

std::string quantity_table(Comparison const& compared) {
  std::string text = "quantity,unit,points,unanswered,bias,rms,relative_rms,inside_2u,area,chi2\n";
  for (ComparedQuantity const& q : compared.quantities)
    text += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.4g},{:.6g},{:.6g}\n", q.name,
                        si_unit(display_of(q.name).dimension), q.points, q.unanswered, q.bias, q.rms, q.relative_rms,
                        q.inside_2u, q.area, q.chi2);
  return text;
}

std::string pattern_table(Comparison const& compared) {
  std::string text = "pattern,z,p\n";
  for (PatternFinding const& p : compared.patterns) text += fmt::format("{},{:.4g},{:.4g}\n", quoted(p.text), p.z, p.p);
  return text;
}

}  // namespace

std::string const& name_of(EffectStage stage) {
  static std::array<std::string, 4> const names{"dem", "laser", "heat", "solid"};
  return names.at(static_cast<std::size_t>(stage));
}

void write_comparison(fs::path const& folder, Comparison const& compared) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw FileError(fmt::format("cannot make the folder {} ({})", folder.string(), failure.message()));
  write_file(folder / "residuals.csv", residuals(compared));
  write_file(folder / "quantities.csv", quantity_table(compared));
  write_file(folder / "patterns.csv", pattern_table(compared));
  write_file(folder / "report.html", compare_page(compared));
  write_file(folder / "summary.json", summary(compared).dump(2) + "\n");
}

std::string comparison_in_words(Comparison const& compared) {
  std::string text = fmt::format("{}: chi2 {:.1f} for {} readings, nothing fitted\n", compared.study.name,
                                 compared.chi2, compared.dof);
  for (ComparedQuantity const& q : compared.quantities) {
    Display const shown = display_of(q.name);
    std::string const unit = shown.unit.empty() ? "" : " " + shown.unit;
    text +=
        fmt::format("  {:<26}bias {:>+8.3g}{}, rms {:.3g}{} ({:.0f} %), {:.0f} % of {} within 2 u_val{}\n", q.name,
                    q.bias * shown.factor, unit, q.rms * shown.factor, unit, 100 * q.relative_rms, 100 * q.inside_2u,
                    q.points, q.unanswered > 0 ? fmt::format("; {} without an answer", q.unanswered) : "");
  }
  for (ComparedStage const& stage : compared.stages)
    if (!stage.sentence.empty()) text += fmt::format("  {}: {}\n", name_of(stage.stage), stage.sentence);
  std::size_t shown = 0;
  for (PatternFinding const& p : compared.patterns)
    if (p.p < clear_p && shown++ < shown_patterns)
      text += fmt::format("  pattern: {} (p {})\n", p.text, p.p < 1e-4 ? "< 0.0001" : fmt::format("{:.2g}", p.p));
  if (shown == 0) text += "  no pattern in the residuals at 1 %\n";
  return text;
}

}  // namespace layerloop::validation
