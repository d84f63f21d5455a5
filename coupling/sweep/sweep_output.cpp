#include "coupling/sweep/sweep_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "coupling/program_version.hpp"
#include "coupling/sweep/sweep_page.hpp"
#include "coupling/sweep/sweep_run.hpp"
#include "coupling/sweep/sweep_table.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Quoted where it has to be; one line in any case.
std::string csv_field(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted;
  for (char const c : text) quoted.append(c == '"' ? 2 : 1, c);
  return fmt::format("\"{}\"", quoted);
}

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

/// "laser.power [W]", numbers in the unit that people use.
std::string key_columns(SweepPlan const& plan) {
  std::string columns;
  for (SweptKey const& key : plan.keys) {
    std::string const unit = key.is_number ? shown_unit(key.dimension).name : "";
    columns += fmt::format(",{}", key.name);
    if (!unit.empty()) columns += fmt::format(" [{}]", unit);
  }
  return columns;
}

std::string key_fields(SweepPlan const& plan, SweepCase const& one) {
  std::string fields;
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    SweptValue const& value = one.values[k];
    bool const number = plan.keys[k].is_number && std::isfinite(value.value);
    fields += fmt::format(
        ",{}", number ? csv_number(value.value * shown_unit(plan.keys[k].dimension).scale) : csv_field(value.text));
  }
  return fields;
}

json settings_of(SweepPlan const& plan, SweepCase const& one) {
  json settings = json::object();
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    bool const number = plan.keys[k].is_number && std::isfinite(one.values[k].value);
    double const unit = plan.keys[k].dimension == Dimension::angle ? shown_unit(Dimension::angle).scale : 1;
    settings[plan.keys[k].name] = number ? json(unit * one.values[k].value) : json(one.values[k].text);
  }
  return settings;
}

std::vector<json> read_summaries(SweepPlan const& plan, std::vector<CaseRecord> const& records,
                                 fs::path const& folder) {
  std::vector<json> summaries(plan.cases.size());
  for (std::size_t k = 0; k < plan.cases.size(); ++k) {
    if (records[k].state == CaseState::done)
      summaries[k] = json::parse(read_file(folder / case_folder(plan.cases[k].number) / "summary.json"));
  }
  return summaries;
}

json summary_of(SweepPlan const& plan, std::vector<CaseRecord> const& records, std::vector<json> const& summaries) {
  json all{{"verb", "sweep"},
           {"swept_verb", name_of(plan.verb)},
           {"case", plan.name},
           {"version", program_version()},
           {"replicates", plan.replicates},
           {"points", plan.points},
           {"definitions", json::object()},
           {"cases", json::array()}};
  double wall_time = 0;
  for (std::size_t k = 0; k < plan.cases.size(); ++k) {
    SweepCase const& one = plan.cases[k];
    json entry = summaries[k].is_object() ? summaries[k] : json::object();
    if (entry.contains("definitions")) all["definitions"] = entry["definitions"];
    entry.erase("definitions");
    entry["number"] = one.number;
    entry["point"] = one.point;
    entry["seed"] = one.checked.seed;
    entry["folder"] = case_folder(one.number);
    entry["settings"] = settings_of(plan, one);
    entry["state"] = name_of(records[k].state);
    entry["reason"] = records[k].reason;
    entry["attempts"] = records[k].attempts;
    wall_time += records[k].wall_time;
    all["cases"].push_back(std::move(entry));
  }
  all["wall_time"] = {{"total", wall_time}};
  return all;
}

std::string regime_of(json const& summary) {
  return summary.is_object() && summary.contains("regime") && summary["regime"].is_string()
             ? summary["regime"].get<std::string>()
             : "";
}

void write_cases(SweepPlan const& plan, std::vector<CaseRecord> const& records, std::vector<json> const& summaries,
                 SweepTable const& table, fs::path const& path) {
  std::string text = "case,point,seed,state,attempts,wall_time [s]" + key_columns(plan);
  for (ShownQuantity const& q : table.quantities) text += fmt::format(",{}{}", q.key, column_unit(q));
  text += ",regime,reason\n";
  for (std::size_t k = 0; k < plan.cases.size(); ++k) {
    SweepCase const& one = plan.cases[k];
    text += fmt::format("{},{},{},{},{},{}{}", one.number, one.point + 1, one.checked.seed, name_of(records[k].state),
                        records[k].attempts, csv_number(records[k].wall_time), key_fields(plan, one));
    for (double const value : table.values[k]) text += fmt::format(",{}", csv_number(value));
    text += fmt::format(",{},{}\n", regime_of(summaries[k]), csv_field(records[k].reason));
  }
  write_file(path, text);
}

void write_points(SweepPlan const& plan, SweepTable const& table, fs::path const& path) {
  std::string text = "point" + key_columns(plan);
  for (ShownQuantity const& q : table.quantities) {
    std::string const unit = column_unit(q);
    text += fmt::format(",{0}{1},{0}_u_bed{1},{0}_n", q.key, unit);
  }
  text += "\n";
  for (SweepCase const& one : plan.cases) {
    if ((one.number - 1) % plan.replicates != 0) continue;
    text += fmt::format("{}{}", one.point + 1, key_fields(plan, one));
    for (Sample const& sample : table.points[one.point])
      text += fmt::format(",{},{},{}", csv_number(sample.mean), csv_number(sample.half_width), sample.n);
    text += "\n";
  }
  write_file(path, text);
}

}  // namespace

void write_sweep(SweepPlan const& plan, std::vector<CaseRecord> const& records, fs::path const& folder) {
  std::vector<json> const summaries = read_summaries(plan, records, folder);
  SweepTable const table = tabulate(plan, summaries);
  write_file(folder / "summary.json", summary_of(plan, records, summaries).dump(1) + "\n");
  write_cases(plan, records, summaries, table, folder / "cases.csv");
  write_points(plan, table, folder / "points.csv");
  write_windows(plan, table, folder);
  write_file(folder / "report.html", sweep_page(plan, records, table));
}

}  // namespace layerloop::coupling
