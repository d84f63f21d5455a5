#include "validation/condition_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/case_file.hpp"
#include "core/case_values.hpp"
#include "core/error.hpp"
#include "core/toml_entries.hpp"
#include "core/write_file.hpp"
#include "coupling/melt_plate.hpp"
#include "validation/stage_run.hpp"
#include "validation/study_tables.hpp"

namespace layerloop::validation {
namespace {

/// Text needs quotation marks, a flag or a list has none.
std::string word_setting(std::string const& key, std::string const& word) {
  CaseKey const& row = *case_key(key);
  bool const text =
      std::holds_alternative<Choice>(row.target) || std::holds_alternative<Member<std::string>>(row.target);
  return fmt::format("{}={}", key, text ? toml_text(word) : word);
}

bool has_table(std::string const& text, std::string const& table) {
  try {
    return parse_toml(text).tables.contains(table);
  } catch (SyntaxFault const&) {
    return false;  // make() reports it
  }
}

}  // namespace

std::string setting(std::string const& key, double value) { return fmt::format("{}={}", key, value); }

ConditionCases::ConditionCases(Study const& study)
    : study_(study), text_(read_file(study.case_file)), scans_(has_table(text_, "scan")) {}

std::vector<std::string> ConditionCases::settings(std::size_t condition, Eigen::VectorXd const& calibration) const {
  Condition const& now = study_.conditions.at(condition);
  std::map<std::string, double> numbers = now.inputs;
  for (std::size_t p = 0; p < study_.calibration.size(); ++p) {
    CalibrationParameter const& parameter = study_.calibration[p];
    if (!parameter.acts_on.empty() && !parameter.acts_on.at(condition)) continue;
    double const value = calibration[static_cast<Eigen::Index>(p)];
    if (!parameter.relative) {
      numbers[parameter.key] = value;
    } else if (auto const input = numbers.find(parameter.key); input != numbers.end()) {
      input->second *= 1 + value;
    }
  }
  std::vector<std::string> all{"run.replicates=1", "run.pictures=false", "run.checkpoint=false"};
  for (auto const& [key, value] : numbers) all.push_back(setting(key, value));
  for (auto const& [key, word] : now.words) all.push_back(word_setting(key, word));
  return all;
}

Case ConditionCases::make(std::vector<std::string> const& settings, Verb verb) const {
  return case_of_text(text_, study_.case_file, settings, process_of(verb));
}

std::vector<std::string> mesh_settings(Case const& base, std::vector<Case> const& others) {
  if (base.has_machine()) return {};
  std::vector<std::string> settings;
  coupling::PoolEstimate const estimate = coupling::estimate_pool(base);
  Case placed = base;
  if (base.heat.cell_size == 0) {
    constexpr double step = 1e-7;  // a number that people can read
    double const spot = 2 * (base.laser.spot_radius() + base.laser.ring_half_width());
    double const depth = estimate.pool.depth > 0 ? estimate.pool.depth / 3 : spot;
    placed.heat.cell_size = step * std::floor(std::clamp(depth, spot / 24, spot / 8) / step + 1e-6);
    settings.push_back(setting("heat.cell_size", placed.heat.cell_size));
  }
  if (!base.heat.size.empty()) return settings;
  std::vector<double> size = coupling::with_plate(placed, estimate).heat.size;
  for (Case const& other : others) size[2] = std::max(size[2], 3 * coupling::estimate_pool(other).pool.depth);
  settings.push_back(fmt::format("heat.size=[{}]", fmt::join(size, ", ")));
  return settings;
}

}  // namespace layerloop::validation
