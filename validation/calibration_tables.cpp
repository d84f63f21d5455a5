// [[calibration]] of study.toml, and the uncertain inputs of conditions.csv
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/case_values.hpp"
#include "core/error.hpp"
#include "core/spelling.hpp"
#include "validation/study_tables.hpp"

namespace layerloop::validation {
namespace {

/// One [[calibration]] table.
class CalibrationReader {
 public:
  CalibrationReader(TomlTable const& table, std::vector<Condition> const& conditions, std::vector<Fault>& faults)
      : table_(table), conditions_(conditions), faults_(faults) {}

  std::vector<CalibrationParameter> read() {
    std::size_t const before = faults_.size();
    take_entries();
    for (auto const& [key, entry] : {std::pair("key", key_), std::pair("mean", mean_), std::pair("sd", sd_)}) {
      if (!entry) report(table_.place, fmt::format("missing key \"{}\" in [[calibration]]", key));
    }
    if (faults_.size() > before) return {};
    CalibrationParameter parameter;
    auto const* const name = std::get_if<std::string>(&key_->value.content);
    parameter.name = parameter.key = name ? *name : "";
    CaseKey const* const row = key_row(parameter.key);
    if (!row) return {};
    parameter.mean = mean_of(*row);
    parameter.sd = sd_of(*row);
    if (faults_.size() > before) return {};
    return per_ ? one_per_label(parameter) : std::vector{parameter};
  }

 private:
  void report(Place const& place, std::string const& message) { faults_.push_back({place, message}); }

  void take_entries() {
    for (TomlEntry const& entry : table_.entries) {
      if (entry.key == "key")
        key_ = &entry;
      else if (entry.key == "mean")
        mean_ = &entry;
      else if (entry.key == "sd")
        sd_ = &entry;
      else if (entry.key == "per")
        per_ = &entry;
      else
        report(entry.place, fmt::format("unknown key \"{}\" in [[calibration]] (known: key, mean, sd, per){}",
                                        entry.key, did_you_mean(entry.key, {"key", "mean", "sd", "per"})));
    }
  }

  CaseKey const* key_row(std::string const& name) {
    CaseKey const* const row = case_key(name);
    if (!row) {
      report(key_->place,
             fmt::format("key = {} is no key of the case file{}", shown(key_->value), likely_case_key(name)));
    } else if (!takes_number(*row)) {
      report(key_->place, fmt::format("key = \"{}\" is not a number (it cannot be fitted)", name));
      return nullptr;
    } else if (std::ranges::any_of(conditions_, [&](Condition const& c) { return c.inputs.contains(name); })) {
      report(key_->place, fmt::format("key = \"{0}\" is a column of conditions.csv too (which sets it) leave one out; "
                                      "an uncertain input has a column \"u({0})\"",
                                      name));
    }
    return row;
  }

  double mean_of(CaseKey const& row) {
    try {
      Case scratch;
      store(row, mean_->value, scratch);
      return number(mean_->value, row.dimension, false);
    } catch (InputError const& fault) {
      report(mean_->place, fmt::format("mean: {}", fault.what()));
      return 0;
    }
  }

  double sd_of(CaseKey const& row) {
    try {
      double const sd = number(sd_->value, row.dimension, true);
      if (!(sd > 0))
        report(sd_->place, fmt::format("sd = {} (must be above 0) it is one standard deviation of what is known of {} "
                                       "beforehand",
                                       shown(sd_->value), name_of(row)));
      return sd;
    } catch (InputError const& fault) {
      report(sd_->place, fmt::format("sd = {}", fault.what()));
      return 0;
    }
  }

  static double number(TomlValue const& value, Dimension dimension, bool difference) {
    if (auto const* const whole = std::get_if<std::int64_t>(&value.content)) return static_cast<double>(*whole);
    if (auto const* const real = std::get_if<double>(&value.content)) return *real;
    auto const* const text = std::get_if<std::string>(&value.content);
    if (!text) throw InputError(fmt::format("{} (must be a number or text with a unit)", shown(value)));
    if (!difference) return parse_quantity(*text, dimension);
    std::size_t const end = std::min(text->find_first_not_of("0123456789.+-eE "), text->size());
    return parse_difference(text->substr(0, end), text->substr(end), dimension);
  }

  std::vector<CalibrationParameter> one_per_label(CalibrationParameter const& parameter) {
    auto const* const text = std::get_if<std::string>(&per_->value.content);
    std::string const label = text ? *text : shown(per_->value);
    std::set<std::string> values;
    for (Condition const& condition : conditions_)
      if (condition.labels.contains(label)) values.insert(condition.labels.at(label));
    if (values.empty() && !conditions_.empty())
      report(per_->place,
             fmt::format("per = \"{}\" is no label of conditions.csv (labels are {}, in columns of their own){}", label,
                         fmt::join(label_names(), ", "), did_you_mean(label, label_names())));
    std::vector<CalibrationParameter> all;
    for (std::string const& value : values) {
      CalibrationParameter one = parameter;
      one.name = fmt::format("{} of {} {}", parameter.key, label, value);
      for (Condition const& condition : conditions_)
        one.acts_on.push_back(condition.labels.contains(label) && condition.labels.at(label) == value);
      all.push_back(one);
    }
    return all;
  }

  TomlTable const& table_;
  std::vector<Condition> const& conditions_;
  std::vector<Fault>& faults_;
  TomlEntry const *key_ = nullptr, *mean_ = nullptr, *sd_ = nullptr, *per_ = nullptr;
};

/// One shared relative error for every input that conditions.csv calls uncertain.
std::vector<CalibrationParameter> errors_of_inputs(std::vector<Condition> const& conditions) {
  std::map<std::string, CalibrationParameter> by_key;
  std::map<std::string, int> counts;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    for (auto const& [key, u] : conditions[i].u_inputs) {
      auto const value = conditions[i].inputs.find(key);
      if (value == conditions[i].inputs.end() || value->second == 0) continue;  // limits_of() says so
      CalibrationParameter& error = by_key[key];
      error.acts_on.resize(conditions.size());
      error.acts_on[i] = true;
      error.sd += std::pow(u / value->second, 2);
      ++counts[key];
    }
  }
  std::vector<CalibrationParameter> all;
  for (auto& [key, error] : by_key) {
    error.name = "error of " + key;
    error.key = key;
    error.relative = true;
    error.sd = std::sqrt(error.sd / counts[key]);
    if (std::ranges::all_of(error.acts_on, [](bool acts) { return acts; })) error.acts_on.clear();
    all.push_back(error);
  }
  return all;
}

}  // namespace

std::vector<CalibrationParameter> read_calibration(std::vector<TomlTable> const& tables,
                                                   std::vector<Condition> const& conditions,
                                                   std::vector<Fault>& faults) {
  std::vector<CalibrationParameter> all;
  std::map<std::string, Place> seen;
  for (TomlTable const& table : tables) {
    if (table.name != "calibration") continue;
    for (CalibrationParameter const& parameter : CalibrationReader(table, conditions, faults).read()) {
      if (auto const [at, is_new] = seen.emplace(parameter.name, table.place); !is_new) {
        faults.push_back({table.place, fmt::format("\"{}\" is calibrated twice (first in line {}) leave one out",
                                                   parameter.name, at->second.line)});
      } else {
        all.push_back(parameter);
      }
    }
  }
  std::vector<CalibrationParameter> const errors = errors_of_inputs(conditions);
  all.insert(all.end(), errors.begin(), errors.end());
  return all;
}

}  // namespace layerloop::validation
