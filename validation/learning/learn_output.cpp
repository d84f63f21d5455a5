#include "validation/learning/learn_output.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "coupling/sweep/sweep_table.hpp"
#include "validation/learning/learn_page.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json skill_json(Skill const& skill) {
  return {{"n", skill.n},
          {"rmse", number(skill.rmse)},
          {"q2", number(skill.q2)},
          {"coverage", number(skill.coverage)},
          {"coverage_ci95", {number(skill.coverage_low), number(skill.coverage_high)}}};
}

json optimum_json(LearnStudy const& study, Optimum const& found) {
  json settings = json::object();
  for (std::size_t k = 0; k < study.plan.keys.size(); ++k) {
    auto const d = static_cast<Eigen::Index>(k);
    settings[study.plan.keys[k].name] = {{"value", number(found.place[d])},
                                         {"ci95", {number(found.place_low[d]), number(found.place_high[d])}}};
  }
  return {{"settings", settings},
          {"value", number(found.value.mean)},
          {"value_sd", number(found.value.sd)},
          {"best_value_ci95", {number(found.value_low), number(found.value_high)}}};
}

json learn_json(LearnStudy const& study, LearnResults const& results) {
  json surrogates = json::object(), models = json::array(), history = json::array();
  for (OutputSkill const& one : results.surrogates) {
    surrogates[one.output.key] = skill_json(one.skill);
    surrogates[one.output.key]["noise_sd"] = number(one.noise_sd);
  }
  for (LayerSkill const& one : results.layer_models) {
    models.push_back({{"model", words_of(one.model)}, {"output", one.output}, {"last_layer", skill_json(one.last)}});
    if (one.all.n > 0) models.back()["all_layers"] = skill_json(one.all);
  }
  for (Believed const& one : results.history)
    history.push_back({{"cases", one.cases},
                       {"best", number(one.best)},
                       {"optimum", number(one.optimum.mean)},
                       {"optimum_sd", number(one.optimum.sd)}});
  return {{"output", study.settings.output.key},
          {"goal", name_of(study.settings.goal)},
          {"acquisition", name_of(study.settings.acquisition)},
          {"start_points", study.start},
          {"points", study.plan.points},
          {"failed", failed_runs(study)},
          {"optimum", optimum_json(study, results.optimum)},
          {"surrogates", surrogates},
          {"layer_models", models},
          {"history", history}};
}

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string csv_skill(Skill const& skill, double scale) {
  if (skill.n == 0) return "0,,,,,";
  return fmt::format("{},{},{},{},{},{}", skill.n, csv_number(scale * skill.rmse), csv_number(skill.q2),
                     csv_number(skill.coverage), csv_number(skill.coverage_low), csv_number(skill.coverage_high));
}

std::string key_columns(coupling::SweepPlan const& plan) {
  std::string columns;
  for (coupling::SweptKey const& key : plan.keys) {
    std::string const unit = coupling::shown_unit(key.dimension).name;
    columns += fmt::format(",{}{}", key.name, unit.empty() ? "" : " [" + unit + "]");
  }
  return columns;
}

/// Every case with what was simulated and what the other places predict there.
void write_left_out(LearnStudy const& study, LearnResults const& results, fs::path const& path) {
  coupling::ShownQuantity const& output = study.settings.output;
  std::string const unit = coupling::column_unit(output);
  std::string text =
      fmt::format("case,chosen_by{},simulated{},predicted{},u95{}\n", key_columns(study.plan), unit, unit, unit);
  for (std::size_t i = 0; i < results.used.size(); ++i) {
    coupling::SweepCase const& one = study.plan.cases[results.used[i]];
    auto const row = static_cast<Eigen::Index>(i);
    text += fmt::format("{},{}", one.number, one.point < study.start ? "start design" : "acquisition");
    for (std::size_t k = 0; k < one.values.size(); ++k)
      text += fmt::format(",{}", one.values[k].value * coupling::shown_unit(study.plan.keys[k].dimension).scale);
    text += fmt::format(",{},{},{}\n", output.scale * results.values[row], output.scale * results.left_out.mean[row],
                        1.96 * output.scale * results.left_out.sd[row]);
  }
  write_file(path, text);
}

void write_history(LearnStudy const& study, LearnResults const& results, fs::path const& path) {
  coupling::ShownQuantity const& output = study.settings.output;
  std::string const unit = coupling::column_unit(output);
  std::string text = fmt::format("cases,best_simulated{},optimum{},optimum_u95{}\n", unit, unit, unit);
  for (Believed const& one : results.history)
    text += fmt::format("{},{},{},{}\n", one.cases, csv_number(output.scale * one.best),
                        output.scale * one.optimum.mean, 1.96 * output.scale * one.optimum.sd);
  write_file(path, text);
}

void write_skills(LearnResults const& results, fs::path const& folder) {
  std::string const columns = "n,rmse,q2,coverage,coverage_low,coverage_high";
  std::string text = "output," + columns + ",noise_sd,unit\n";
  for (OutputSkill const& one : results.surrogates)
    text += fmt::format("{},{},{},{}\n", one.output.key, csv_skill(one.skill, one.output.scale),
                        csv_number(one.output.scale * one.noise_sd), plain_unit(one.output));
  write_file(folder / "surrogates.csv", text);
  if (results.layer_models.empty()) return;
  text = "output,model,layers," + columns + "\n";  // SI
  for (LayerSkill const& one : results.layer_models) {
    text += fmt::format("{},\"{}\",last,{}\n", one.output, words_of(one.model), csv_skill(one.last, 1));
    if (one.all.n > 0)
      text += fmt::format("{},\"{}\",all,{}\n", one.output, words_of(one.model), csv_skill(one.all, 1));
  }
  write_file(folder / "layer_models.csv", text);
}

void write_slices(LearnStudy const& study, LearnResults const& results, fs::path const& path) {
  coupling::ShownQuantity const& output = study.settings.output;
  std::string text = fmt::format("key,value,unit,{0}{1},{0}_u95{1}\n", output.key, coupling::column_unit(output));
  for (std::size_t k = 0; k < results.slices.size(); ++k) {
    coupling::ShownUnit const unit = coupling::shown_unit(study.plan.keys[k].dimension);
    Slice const& slice = results.slices[k];
    for (std::size_t i = 0; i < slice.x.size(); ++i)
      text += fmt::format("{},{},{},{},{}\n", study.plan.keys[k].name, slice.x[i] * unit.scale, unit.name,
                          output.scale * slice.mean[i], 1.96 * output.scale * slice.sd[i]);
  }
  write_file(path, text);
}

}  // namespace

void write_learning(LearnStudy const& study, LearnResults const& results, fs::path const& folder) {
  json summary = json::parse(read_file(folder / "summary.json"));
  summary["verb"] = "learn";
  summary["learn"] = learn_json(study, results);
  write_file(folder / "summary.json", summary.dump(1) + "\n");
  write_left_out(study, results, folder / "left_out.csv");
  write_history(study, results, folder / "learn.csv");
  write_skills(results, folder);
  write_slices(study, results, folder / "slices.csv");
  fs::rename(folder / "report.html", folder / "cases.html");
  write_file(folder / "report.html", learn_page(study, results));
}

}  // namespace layerloop::validation
