#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "validation/study_tables.hpp"

namespace layerloop::validation {
namespace {

bool has_replicates(Study const& study) {
  std::set<std::size_t> seen;
  return std::ranges::any_of(study.observations,
                             [&](Observation const& o) { return !seen.insert(o.observable).second; });
}

/// Inputs that are given but never change over the conditions that were measured.
std::vector<std::string> inputs_of_one_level(Study const& study) {
  std::map<std::string, std::set<double>> levels;
  std::set<std::size_t> measured;
  for (Observable const& o : study.observables) measured.insert(o.condition);
  for (std::size_t const i : measured)
    for (auto const& [key, value] : study.conditions[i].inputs) levels[key].insert(value);
  std::vector<std::string> constant;
  for (auto const& [key, values] : levels)
    if (values.size() == 1) constant.push_back(key);
  return constant;
}

std::vector<std::string> quantities_of_one_row(Study const& study) {
  std::map<std::string, int> rows;
  for (Observation const& o : study.observations) ++rows[o.quantity];
  std::vector<std::string> single;
  for (auto const& [quantity, count] : rows)
    if (count == 1) single.push_back(quantity);
  return single;
}

std::vector<std::string> inputs_without_relative_error(Study const& study) {
  std::set<std::string> keys;
  for (Condition const& c : study.conditions)
    for (auto const& [key, u] : c.u_inputs)
      if (!c.inputs.contains(key) || c.inputs.at(key) == 0) keys.insert(key);
  return {keys.begin(), keys.end()};
}

}  // namespace

std::vector<std::string> limits_of(Study const& study, bool has_holdout) {
  std::vector<std::string> limits;
  std::size_t const data = study.observations.size(), parameters = study.calibration.size();
  if (!has_replicates(study))
    limits.push_back("no replicates: whether the stated uncertainties are right can be told from the fit alone");
  if (data <= parameters)
    limits.push_back(
        fmt::format("{} readings for {} calibration numbers: calibration can explain anything, and no "
                    "effect can be seen",
                    data, parameters));
  if (auto const keys = inputs_of_one_level(study); !keys.empty())
    limits.push_back(fmt::format("one level only of {}: what acts through it cannot be told from a constant factor",
                                 fmt::join(keys, ", ")));
  if (auto const names = quantities_of_one_row(study); !names.empty())
    limits.push_back(fmt::format("a single reading of {}: it shows no trend", fmt::join(names, ", ")));
  if (!has_holdout) limits.push_back("no holdout: nothing can be confirmed on data that were not used");
  if (auto const keys = inputs_without_relative_error(study); !keys.empty())
    limits.push_back(
        fmt::format("the uncertainty of {} is not used where the value is 0 or blank (errors of inputs "
                    "are relative)",
                    fmt::join(keys, ", ")));
  return limits;
}

}  // namespace layerloop::validation
