#include "validation/blind/study_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "core/case_schema.hpp"
#include "core/write_file.hpp"
#include "validation/quantity.hpp"
#include "validation/study_tables.hpp"

namespace layerloop::validation {
namespace {

std::string unit_of(std::string const& key) {
  CaseKey const* const row = case_key(key);
  return row ? std::string(si_unit(row->dimension)) : "";
}

std::string in_brackets(std::string const& unit) { return unit.empty() ? std::string() : fmt::format(" [{}]", unit); }

std::string study_text(Study const& study) {
  std::string text = fmt::format(
      "[study]\nname = \"{}\"\ncase = \"case.toml\"\nconditions = \"conditions.csv\"\nmeasurements = "
      "\"measurements.csv\"\n",
      study.name);
  for (CalibrationParameter const& number : study.calibration)
    if (!number.relative)
      text += fmt::format("\n[[calibration]]\nkey = \"{}\"\nmean = {:#.17g}\nsd = {:#.17g}\n", number.key, number.mean,
                          number.sd);
  return text;
}

std::string conditions_text(Study const& study) {
  std::set<std::string> keys, labels;
  for (Condition const& condition : study.conditions) {
    for (auto const& [key, value] : condition.inputs) keys.insert(key);
    for (auto const& [label, value] : condition.labels) labels.insert(label);
  }
  std::string text = "condition_id";
  for (std::string const& key : keys) text += fmt::format(",{}{}", key, in_brackets(unit_of(key)));
  for (CalibrationParameter const& number : study.calibration)
    if (number.relative) text += fmt::format(",u({}){}", number.key, in_brackets(unit_of(number.key)));
  for (std::string const& label : labels) text += fmt::format(",{}", label);
  for (Condition const& condition : study.conditions) {
    text += fmt::format("\n{}", condition.id);
    auto const value_of = [&](auto const& from, auto const& key) {
      auto const found = from.find(key);
      return found == from.end() ? std::string() : fmt::format("{}", found->second);
    };
    for (std::string const& key : keys) text += fmt::format(",{}", value_of(condition.inputs, key));
    for (CalibrationParameter const& number : study.calibration)
      if (number.relative) text += fmt::format(",{}", number.sd * condition.inputs.at(number.key));
    for (std::string const& label : labels) text += fmt::format(",{}", value_of(condition.labels, label));
  }
  return text + "\n";
}

std::string measurements_text(Study const& study) {
  std::string text =
      "obs_id,condition_id,quantity,value,unit,u_stat,u_sys_rel,u_sys_abs,sys_group,rep_id,layer,x [m],y [m],operator,"
      "instrument,role,source";
  for (Observation const& row : study.observations) {
    Observable const& seen = study.observables[row.observable];
    Quantity const* const quantity = find_quantity(row.quantity);
    std::string const unit = quantity ? std::string(si_unit(quantity->dimension)) : "";
    auto const place = [](std::optional<double> at) { return at ? fmt::format("{}", *at) : std::string(); };
    text +=
        fmt::format("\n{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", row.id, study.conditions[row.condition].id,
                    row.quantity, row.value, unit, row.u_stat, row.u_sys_rel, row.u_sys_abs, row.sys_group, row.rep_id,
                    seen.layer ? fmt::format("{}", *seen.layer) : std::string(), place(seen.x), place(seen.y), row.oper,
                    row.instrument, row.role == Role::train ? "train" : "holdout", "blind test");
  }
  return text + "\n";
}

}  // namespace

void write_study(Study const& study, std::string const& case_text, std::filesystem::path const& folder) {
  std::filesystem::create_directories(folder);
  write_file(folder / "case.toml", case_text);
  write_file(folder / "study.toml", study_text(study));
  write_file(folder / "conditions.csv", conditions_text(study));
  write_file(folder / "measurements.csv", measurements_text(study));
}

}  // namespace layerloop::validation
