#include "coupling/replicate_summary.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/json_number.hpp"
#include "core/statistics.hpp"

namespace layerloop::coupling {
namespace {

using nlohmann::json;

bool is_place(std::string const& key) { return key == "x" || key == "layer"; }
bool is_measured(json const& value) { return value.is_number() || value.is_null(); }

std::vector<double> numbers(std::vector<json> const& values) {
  std::vector<double> all;
  for (json const& value : values) all.push_back(number_or_nan(value));
  return all;
}

/// Values of a key in all runs that have it.
std::vector<json> values_of(std::vector<json> const& objects, std::string const& key) {
  std::vector<json> values;
  for (json const& object : objects)
    if (object.contains(key)) values.push_back(object[key]);
  return values;
}

json merged(std::vector<json> const& values);

void put_mean(json& into, std::string const& key, std::vector<json> const& values) {
  Sample const sample = sample_of(numbers(values));
  auto const number_or_null = [](double value) { return std::isfinite(value) ? json(value) : json(nullptr); };
  into[key] = number_or_null(sample.mean);
  if (key.ends_with("_u_num")) return;
  into[key + "_u_bed"] = number_or_null(sample.half_width);
  into[key + "_n"] = sample.n;
}

json merged_objects(std::vector<json> const& objects) {
  json into = json::object();
  for (json const& object : objects) {
    for (auto const& [key, value] : object.items()) {
      if (into.contains(key)) continue;
      std::vector<json> const values = values_of(objects, key);
      if (is_measured(value) && !is_place(key)) {
        put_mean(into, key, values);
      } else {
        into[key] = merged(values);
      }
    }
  }
  return into;
}

json merged(std::vector<json> const& values) {
  if (values.front().is_object()) return merged_objects(values);
  if (!values.front().is_array()) return values.front();
  json array = json::array();
  for (std::size_t k = 0; k < values.front().size(); ++k) {
    std::vector<json> elements;
    for (json const& value : values) elements.push_back(value.at(k));
    array.push_back(merged(elements));
  }
  return array;
}

json merged_ledger(std::vector<json> const& ledgers) {
  json into = json::object();
  for (auto const& [key, first] : ledgers.front().items()) {
    std::vector<double> const values = numbers(values_of(ledgers, key));
    bool const worst = key.ends_with("_relative_error") || key.ends_with("_relative_error_dem");
    bool const mean = key.starts_with("power_") || key == "surface_height_correction";
    double const sum = sample_of(values).mean * static_cast<double>(values.size());
    if (first.is_number_integer()) {
      std::int64_t count = 0;
      for (json const& ledger : ledgers) count += ledger[key].get<std::int64_t>();
      into[key] = count;
    } else {
      into[key] = worst ? std::ranges::max(values) : mean ? sample_of(values).mean : sum;
    }
  }
  return into;
}

}  // namespace

json summary_over_replicates(std::vector<json> const& summaries) {
  std::vector<json> measured = summaries;
  for (json& summary : measured) {
    for (char const* key : {"ledger", "wall_time", "seed"}) summary.erase(key);
  }
  json all = merged_objects(measured);
  std::vector<json> const times = values_of(summaries, "wall_time");
  all["ledger"] = merged_ledger(values_of(summaries, "ledger"));
  all["wall_time"] = merged_ledger(times);
  all["seed"] = summaries.front().at("seed");
  return all;
}

}  // namespace layerloop::coupling
