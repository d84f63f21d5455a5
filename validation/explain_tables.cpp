#include "validation/explain_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/write_file.hpp"
#include "validation/display.hpp"
#include "validation/explain_output.hpp"
#include "validation/quantity.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;

/// A cell of text: quoted where it has to be.
std::string text_cell(std::string const& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string safe = "\"";
  for (char const c : text) safe += c == '"' ? "\"\"" : std::string(1, c);
  return safe + '"';
}

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; }

std::string matrix_csv(std::string const& corner, std::vector<std::string> const& rows,
                       std::vector<std::string> const& columns, Eigen::MatrixXd const& values) {
  std::string text = corner;
  for (std::string const& name : columns) text += ',' + text_cell(name);
  text += '\n';
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    text += text_cell(rows[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < values.cols(); ++j) text += ',' + cell(values(i, j));
    text += '\n';
  }
  return text;
}

std::string candidates_csv(Diagnosis const& found) {
  std::string text =
      "name,active,strength,u_strength,z,evidence,kept_fraction,detectable_strength,chi2_after,share_of_excess,group,"
      "twins,not_testable\n";
  for (CandidateFinding const& e : found.effects) {
    text += text_cell(e.name) + (e.active ? ",1" : ",0");
    for (double const value : {e.strength, e.u_strength, e.z, e.evidence, e.kept_fraction, e.detectable, e.chi2_after,
                               share_explained(found, e.chi2_after)})
      text += ',' + cell(value);
    text += fmt::format(",{},{},{}\n", fmt::join(e.group, " "), fmt::join(e.twins, " "), text_cell(e.not_testable));
  }
  return text;
}

std::string parameters_csv(Diagnosis const& found) {
  std::string text = "name,mean,sd,value,u,pull\n";
  for (ParameterFinding const& p : found.parameters)
    text += fmt::format("{},{},{},{},{},{}\n", text_cell(p.name), cell(p.mean), cell(p.sd), cell(p.value), cell(p.u),
                        cell(p.pull));
  return text;
}

std::string patterns_csv(Diagnosis const& found) {
  std::string text = "when,text,z,p\n";
  for (PatternFinding const& p : found.patterns_before)
    text += fmt::format("calibrated,{},{},{}\n", text_cell(p.text), cell(p.z), cell(p.p));
  for (PatternFinding const& p : found.patterns_after)
    text += fmt::format("with effects,{},{},{}\n", text_cell(p.text), cell(p.z), cell(p.p));
  return text;
}

std::string settings_of(Condition const& condition) {
  std::string text;
  for (auto const& [key, value] : condition.inputs) text += fmt::format("{}={:.6g} ", key, value);
  return text;
}

std::string next_csv(Explanation const& explained) {
  std::string text = "conditions [SI],quantity,replicates,separation,difference [SI],u [SI],separates,simulated\n";
  for (NextExperiment const& next : explained.next) {
    std::string where = settings_of(next.condition);
    for (Condition const& condition : next.also_at) where += "and " + settings_of(condition);
    text += fmt::format("{},{},{},{},{},{},{},{}\n", text_cell(where), text_cell(measured_in_words(next)),
                        next.replicates, cell(next.separation), cell(next.difference), cell(next.u),
                        text_cell(fmt::format("{}", fmt::join(next.separates, " "))), next.simulated ? 1 : 0);
  }
  return text;
}

}  // namespace

std::string observations_csv(Study const& study, ObservationTable const& table) {
  std::string text =
      "obs_id,condition_id,quantity,unit,measured,u_data,case,calibrated,with_effects,u_model,residual_before,"
      "residual_after\n";
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    Observation const& seen = study.observations[i];
    Display const shown = display_of(seen.quantity);
    auto const k = static_cast<Eigen::Index>(i);
    text += fmt::format("{},{},{},{}", text_cell(seen.id), text_cell(study.conditions[seen.condition].id),
                        seen.quantity, shown.unit);
    for (Eigen::VectorXd const* column :
         {&table.measured, &table.u_data, &table.base, &table.calibrated, &table.final_model, &table.u_model})
      text += ',' + cell((*column)[k] * shown.factor);
    text += ',' + cell(table.residual_before[k]) + ',' + cell(table.residual_after[k]) + '\n';
  }
  return text;
}

std::vector<StageMisfit> stage_misfits(Explanation const& explained) {
  static constexpr std::array names{"dem", "laser", "heat", "solid"};
  std::map<EffectStage, StageMisfit> by_stage;
  for (std::size_t i = 0; i < explained.study.observations.size(); ++i) {
    Quantity const* const quantity = find_quantity(explained.study.observations[i].quantity);
    double const before = explained.found.table.residual_before[static_cast<Eigen::Index>(i)];
    double const after = explained.found.table.residual_after[static_cast<Eigen::Index>(i)];
    if (!quantity || !std::isfinite(before)) continue;
    StageMisfit& misfit = by_stage[quantity->stage];
    misfit.stage = names.at(static_cast<std::size_t>(quantity->stage));
    ++misfit.observations;
    misfit.before += before * before;
    misfit.after += after * after;
  }
  std::vector<StageMisfit> all;
  for (auto& [stage, misfit] : by_stage) {
    misfit.before /= static_cast<double>(misfit.observations);
    misfit.after /= static_cast<double>(misfit.observations);
    all.push_back(misfit);
  }
  return all;
}

std::vector<WaterfallStep> waterfall(Diagnosis const& found) {
  std::vector<WaterfallStep> steps{{"the case as it stands", found.chi2_base}, {"calibrated", found.chi2_before}};
  std::string added;
  for (CandidateFinding const& effect : found.effects)
    if (effect.active) added += (added.empty() ? "with " : " and ") + effect.name;
  if (!added.empty()) steps.push_back({added, found.chi2_after});
  steps.push_back({"noise", found.dof});
  return steps;
}

double share_explained(Diagnosis const& found, double chi2) {
  double const excess = found.chi2_before - found.dof;
  if (excess <= 0 || !std::isfinite(chi2)) return std::nan("");
  return 1 - std::max(0.0, chi2 - found.dof) / excess;
}

void write_explain_tables(fs::path const& folder, Explanation const& explained) {
  Diagnosis const& found = explained.found;
  std::vector<std::string> ids;
  for (Observation const& seen : explained.study.observations) ids.push_back(seen.id);
  write_file(folder / "observations.csv", observations_csv(explained.study, explained.found.table));
  write_file(folder / "signatures.csv", matrix_csv("obs_id", ids, found.candidate_names, found.table.signatures));
  write_file(folder / "cosines.csv",
             matrix_csv("candidate", found.candidate_names, found.candidate_names, found.cosines));
  write_file(folder / "candidates.csv", candidates_csv(found));
  write_file(folder / "parameters.csv", parameters_csv(found));
  write_file(folder / "patterns.csv", patterns_csv(found));
  write_file(folder / "next.csv", next_csv(explained));
  std::string stages = "stage,observations,mean_square_before,mean_square_after\n";
  for (StageMisfit const& m : stage_misfits(explained))
    stages += fmt::format("{},{},{},{}\n", m.stage, m.observations, cell(m.before), cell(m.after));
  write_file(folder / "stages.csv", stages);
  std::string steps = "step,chi2,rms [sd]\n";
  for (WaterfallStep const& step : waterfall(found))
    steps += fmt::format("{},{},{}\n", text_cell(step.name), cell(step.chi2), cell(std::sqrt(step.chi2 / found.dof)));
  write_file(folder / "waterfall.csv", steps);
}

}  // namespace layerloop::validation
