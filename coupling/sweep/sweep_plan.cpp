#include "coupling/sweep/sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/case_file.hpp"
#include "core/case_key.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/spelling.hpp"
#include "core/toml_entries.hpp"
#include "core/write_file.hpp"
#include "coupling/sweep/space_filling.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t most_cases = 100000;

std::vector<std::string> const& design_names() {
  static std::vector<std::string> const names{"grid", "list", "latin_hypercube", "sobol"};
  return names;
}

bool fills_space(SweepDesign design) { return design == SweepDesign::latin_hypercube || design == SweepDesign::sobol; }

/// A value as TOML.
std::string written(TomlValue const& value) {
  if (auto const* const text = std::get_if<std::string>(&value.content)) {
    std::string quoted;
    for (char const c : *text) quoted.append(c == '"' || c == '\\' ? "\\" : "").append(1, c);
    return fmt::format("\"{}\"", quoted);
  }
  auto const* const items = std::get_if<std::vector<TomlValue>>(&value.content);
  if (!items) return shown(value);
  std::string all;
  for (TomlValue const& item : *items) all.append(all.empty() ? "" : ", ").append(written(item));
  return fmt::format("[{}]", all);
}

/// The same for people: text without its quotes.
std::string text_of(TomlValue const& value) {
  auto const* const text = std::get_if<std::string>(&value.content);
  return text ? *text : written(value);
}

/// [sweep] and [sweep.vary] as the user wrote them.
class SweepReader {
 public:
  SweepReader(TomlContent const& content, std::vector<TomlEntry> const& overrides) {
    for (TomlEntry const& entry : content.entries) {
      if (entry.table == "sweep") settings_.insert_or_assign(entry.key, entry);
      if (entry.table == "sweep.vary") varied_.push_back(entry);
    }
    for (TomlEntry const& entry : overrides) {
      std::string const name = entry.table + "." + entry.key;
      if (entry.table == "sweep") settings_.insert_or_assign(entry.key, entry);
      if (std::ranges::find(varied_, name, &TomlEntry::key) != varied_.end())
        report(entry.place, fmt::format("{} is swept (its values stand in [sweep.vary]) leave the option out", name));
    }
    if (auto const table = content.tables.find("sweep"); table != content.tables.end()) place_ = table->second;
    std::ranges::stable_sort(varied_, {}, &TomlEntry::place);
    read();
  }

  std::vector<Fault> const& faults() const { return faults_; }
  SweepPlan plan;
  std::int64_t wanted = 0;  ///< points of a space-filling design
  std::uint64_t seed = 1;   ///< of the design

 private:
  void report(Place const& place, std::string const& message) { faults_.push_back({place, message}); }

  void read() {
    std::vector<std::string> const known{"verb", "design",        "cases",           "replicates",
                                         "seed", "hatch_spacing", "layer_thickness", "vary"};
    for (auto const& [key, entry] : settings_) {
      if (std::ranges::find(known, key) == known.end())
        report(entry.place, fmt::format("unknown key \"{}\" in [sweep] (known: {}){}", key, fmt::join(known, ", "),
                                        did_you_mean(key, known)));
      if (key == "vary") report(entry.place, "vary is a table (write [sweep.vary] on a line of its own)");
    }
    plan.verb = static_cast<Verb>(word("verb", verb_names(), static_cast<std::size_t>(Verb::run), true));
    plan.design = static_cast<SweepDesign>(word("design", design_names(), 0, false));
    plan.replicates = whole("replicates", 1, 1, 10000);
    seed = static_cast<std::uint64_t>(whole("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
    plan.hatch_spacing = length("hatch_spacing");
    plan.layer_thickness = length("layer_thickness");
    if (fills_space(plan.design)) wanted = whole("cases", 0, 1, most_cases);
    if (!fills_space(plan.design) && settings_.contains("cases"))
      report(settings_["cases"].place,
             fmt::format("cases is given for a {} (whose values say how many there are) leave it out",
                         design_names()[static_cast<std::size_t>(plan.design)]));
    if (varied_.empty())
      report(place_, "missing table [sweep.vary] (it must hold what varies: laser.power = [\"100 W\", \"200 W\"])");
    for (TomlEntry const& entry : varied_) read_key(entry);
    if (plan.design == SweepDesign::list) check_lengths();
  }

  /// Place of a word in its list.
  std::size_t word(std::string const& key, std::vector<std::string> const& words, std::size_t fallback, bool needed) {
    auto const entry = settings_.find(key);
    if (entry == settings_.end()) {
      if (needed) report(place_, fmt::format("missing key \"{}\" in [sweep] (one of {})", key, fmt::join(words, ", ")));
      return fallback;
    }
    auto const* const text = std::get_if<std::string>(&entry->second.value.content);
    auto const found = text ? std::ranges::find(words, *text) : words.end();
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    report(entry->second.place, fmt::format("{} = {} (must be one of {}){}", key, shown(entry->second.value),
                                            fmt::join(words, ", "), text ? did_you_mean(*text, words) : ""));
    return fallback;
  }

  std::int64_t whole(std::string const& key, std::int64_t fallback, std::int64_t least, std::int64_t most) {
    auto const entry = settings_.find(key);
    if (entry == settings_.end()) {
      if (fallback < least) report(place_, fmt::format("missing key \"{}\" in [sweep] (a whole number)", key));
      return fallback;
    }
    auto const* const number = std::get_if<std::int64_t>(&entry->second.value.content);
    if (number && *number >= least && *number <= most) return *number;
    report(entry->second.place,
           fmt::format("{} = {} (must be a whole number from {} to {})", key, shown(entry->second.value), least, most));
    return fallback;
  }

  double length(std::string const& key) {
    auto const entry = settings_.find(key);
    if (entry == settings_.end()) return 0;
    try {
      double const value = number_of(entry->second.value, Dimension::length);
      if (value > 1e-6 && value < 1e-2) return value;
      if (std::isnan(value)) throw InputError("must be a length, as in \"90 um\"");
      report(entry->second.place,
             fmt::format("{} = {} (must lie between 1 um and 1 cm)", key, format_quantity(value, Dimension::length)));
    } catch (InputError const& fault) {
      report(entry->second.place, fmt::format("{}: {}", key, fault.what()));
    }
    return 0;
  }

  /// A plain number is in SI. Not a number: a list.
  static double number_of(TomlValue const& item, Dimension dimension) {
    if (auto const* const number = std::get_if<double>(&item.content)) return *number;
    if (auto const* const whole = std::get_if<std::int64_t>(&item.content)) return static_cast<double>(*whole);
    if (auto const* const text = std::get_if<std::string>(&item.content)) return parse_quantity(*text, dimension);
    return std::numeric_limits<double>::quiet_NaN();
  }

  void read_key(TomlEntry const& entry) {
    CaseKey const* const row = case_key(entry.key);
    if (!row)
      return report(entry.place, fmt::format("unknown key \"{}\" in [sweep.vary] (it must be a key of the case)"
                                             "{}",
                                             entry.key, likely_case_key(entry.key)));
    if (entry.key == "case.seed")
      return report(entry.place, "case.seed is swept (seeds are replicates of one point) write replicates in [sweep]");
    auto const* const items = std::get_if<std::vector<TomlValue>>(&entry.value.content);
    if (!items || items->empty())
      return report(entry.place, fmt::format("{} = {} (must be a list of values)", entry.key, shown(entry.value)));
    SweptKey key{entry.key, row->dimension, takes_number(*row), {}, entry.place};
    for (TomlValue const& item : *items) {
      try {
        key.values.push_back(value_of(item, *row));
      } catch (InputError const& fault) {
        report(entry.place, fmt::format("{}: {}", entry.key, fault.what()));
      }
    }
    std::set<std::string> seen;
    for (SweptValue const& value : key.values) {
      if (seen.insert(value.written).second || plan.design != SweepDesign::grid) continue;
      report(entry.place,
             fmt::format("{} = {} twice (the same case again) leave one out, or write replicates in [sweep] "
                         "for other seeds",
                         entry.key, value.text));
    }
    if (fills_space(plan.design)) check_range(entry, *row, key);
    plan.keys.push_back(std::move(key));
  }

  static SweptValue value_of(TomlValue const& item, CaseKey const& row) {
    if (std::holds_alternative<TomlValue::Other>(item.content))
      throw InputError(fmt::format("{} (must be a value) write a number, a text, true, false or a list", shown(item)));
    double const number = takes_number(row) ? number_of(item, row.dimension) : std::numeric_limits<double>::quiet_NaN();
    return {text_of(item), number, written(item)};
  }

  void check_range(TomlEntry const& entry, CaseKey const& row, SweptKey const& key) {
    bool const real = std::holds_alternative<Member<double>>(row.target) ||
                      std::holds_alternative<Member<std::optional<double>>>(row.target);
    if (!real) {
      report(entry.place, fmt::format("{} is no real number (a {} needs a range) use a grid or a list", entry.key,
                                      design_names()[static_cast<std::size_t>(plan.design)]));
    } else if (key.values.size() != 2 || !(key.values[0].value < key.values[1].value)) {
      report(entry.place, fmt::format("{} = {} (must be two values, the lower first, for a {})", entry.key,
                                      shown(entry.value), design_names()[static_cast<std::size_t>(plan.design)]));
    }
  }

  void check_lengths() {
    for (std::size_t k = 0; k < plan.keys.size(); ++k) {
      if (plan.keys[k].values.size() == plan.keys.front().values.size()) continue;
      auto const entry = std::ranges::find(varied_, plan.keys[k].name, &TomlEntry::key);
      report(entry->place,
             fmt::format("{} has {} values and {} has {} (in a list they go together) give as many", entry->key,
                         plan.keys[k].values.size(), plan.keys.front().name, plan.keys.front().values.size()));
    }
  }

  std::map<std::string, TomlEntry> settings_;
  std::vector<TomlEntry> varied_;
  Place place_;
  std::vector<Fault> faults_;
};

std::vector<std::vector<SweptValue>> grid_points(std::vector<SweptKey> const& keys) {
  std::vector<std::vector<SweptValue>> points{{}};
  for (SweptKey const& key : keys) {
    std::vector<std::vector<SweptValue>> wider;
    for (std::vector<SweptValue> const& point : points) {
      for (SweptValue const& value : key.values) (wider.emplace_back(point)).push_back(value);
    }
    points = std::move(wider);
  }
  return points;
}

std::vector<std::vector<SweptValue>> list_points(std::vector<SweptKey> const& keys) {
  std::vector<std::vector<SweptValue>> points(keys.front().values.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    for (SweptKey const& key : keys) points[k].push_back(key.values[k]);
  return points;
}

std::vector<std::vector<SweptValue>> filling_points(SweepReader const& read) {
  std::vector<SweptKey> const& keys = read.plan.keys;
  UnitPoints const unit = read.plan.design == SweepDesign::sobol ? sobol_points(read.wanted, keys.size(), read.seed)
                                                                 : latin_hypercube(read.wanted, keys.size(), read.seed);
  std::vector<std::vector<SweptValue>> points(unit.size());
  for (std::size_t k = 0; k < unit.size(); ++k) {
    for (std::size_t d = 0; d < keys.size(); ++d) {
      double const from = keys[d].values[0].value, to = keys[d].values[1].value;
      points[k].push_back(swept_number(from + (to - from) * unit[k][d]));
    }
  }
  return points;
}

std::vector<TomlEntry> entries_of(std::vector<std::string> const& overrides, std::vector<Fault>& faults) {
  std::vector<TomlEntry> entries;
  for (std::string const& option : overrides) {
    try {
      entries.push_back(parse_override(option));
    } catch (SyntaxFault const& fault) {
      faults.push_back(fault.fault);
    }
  }
  return entries;
}

std::string option_of(SweepPlan const& plan, std::vector<SweptValue> const& values, std::size_t key) {
  return fmt::format("{}={}", plan.keys[key].name, values[key].written);
}

/// What is wrong with a swept value stands in the file, not in an option.
std::string at_its_place(std::string message, SweepPlan const& plan, std::vector<SweptValue> const& values,
                         fs::path const& path) {
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    std::string const option = fmt::format("--set {}:", option_of(plan, values, k));
    Place const& place = plan.keys[k].place;
    if (std::size_t const at = message.find(option); at != std::string::npos)
      message.replace(at, option.size(), fmt::format("{}:{}:{}:", path.string(), place.line, place.column));
  }
  return message;
}

double points_of(SweepReader const& read) {
  if (fills_space(read.plan.design)) return static_cast<double>(read.wanted);
  if (read.plan.design == SweepDesign::list) return static_cast<double>(read.plan.keys.front().values.size());
  double points = 1;
  for (SweptKey const& key : read.plan.keys) points *= static_cast<double>(key.values.size());
  return points;
}

}  // namespace

SweptValue swept_number(double value) {
  std::string const digits = fmt::format("{}", value);
  return {digits, value, digits};
}

std::string words_of(SweepPlan const& plan, SweepCase const& one) {
  std::string words;
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    SweptValue const& value = one.values[k];
    bool const plain = plan.keys[k].is_number && std::isfinite(value.value);
    words += fmt::format("{}{} = {}", words.empty() ? "" : ", ", plan.keys[k].name,
                         plain ? format_quantity(value.value, plan.keys[k].dimension) : value.text);
  }
  return words;
}

void append_points(SweepPlan& plan, std::vector<std::vector<SweptValue>> const& points, fs::path const& path,
                   std::vector<std::string> const& overrides) {
  std::string const text = read_file(path);
  std::map<std::string, std::vector<std::int64_t>> faults;  // cases by what is wrong with them
  std::map<std::string, std::string> first;                 // settings of the first of them
  for (std::vector<SweptValue> const& values : points) {
    std::vector<std::string> set = overrides;
    for (std::size_t k = 0; k < plan.keys.size(); ++k) set.push_back(option_of(plan, values, k));
    SweepCase one{static_cast<std::int64_t>(plan.cases.size()) + 1, plan.points++, values, {}};
    try {
      one.checked = case_of_text(text, path, set, process_of(plan.verb));
      if (one.checked.run.replicates != 1)
        throw InputError(
            fmt::format("{}: run.replicates = {} (every seed of a sweep is a case) write replicates in "
                        "[sweep] instead",
                        path.string(), one.checked.run.replicates));
    } catch (InputError const& fault) {
      std::string const words = at_its_place(fault.what(), plan, values, path);
      faults[words].push_back(one.number);
      first.try_emplace(words, words_of(plan, one));
    }
    if (stop_requested()) throw StoppedBySignal("stopped by a signal before any case was run (as asked)");
    for (std::int64_t k = 0; k < plan.replicates; ++k) {
      plan.cases.push_back(one);
      plan.cases.back().number += k;
      plan.cases.back().checked.seed += static_cast<std::uint64_t>(k);
    }
  }
  std::string all;
  for (auto const& [message, cases] : faults)
    all += fmt::format("{}{}\n  in {} of {} points, the first with {}", all.empty() ? "" : "\n", message, cases.size(),
                       points.size(), first[message]);
  if (!all.empty()) throw InputError(all);
}

SweepPlan read_sweep(fs::path const& path, std::vector<std::string> const& overrides) {
  if (!fs::is_regular_file(path)) throw FileError(fmt::format("cannot read the sweep {} (not a file)", path.string()));
  std::vector<Fault> faults;
  std::vector<TomlEntry> const set = entries_of(overrides, faults);
  TomlContent content;
  try {
    content = parse_toml(read_file(path));
  } catch (SyntaxFault const& fault) {
    faults.push_back(fault.fault);
  }
  if (!faults.empty()) throw_faults(faults, path.string());
  if (!content.tables.contains("sweep"))
    throw InputError(
        fmt::format("{}:1:1: missing table [sweep] (it says which verb to run and with what) write verb "
                    "in [sweep] and what varies in [sweep.vary]",
                    path.string()));
  SweepReader read(content, set);
  if (!read.faults().empty()) throw_faults(read.faults(), path.string());
  SweepPlan plan = read.plan;
  if (double const n = points_of(read); n * static_cast<double>(plan.replicates) > most_cases)
    throw InputError(fmt::format("{}: {:.0f} points with {} seeds each (more than {} cases) vary less", path.string(),
                                 n, plan.replicates, most_cases));
  auto const points = plan.design == SweepDesign::grid   ? grid_points(plan.keys)
                      : plan.design == SweepDesign::list ? list_points(plan.keys)
                                                         : filling_points(read);
  append_points(plan, points, path, overrides);
  plan.name = plan.cases.front().checked.name;
  return plan;
}

}  // namespace layerloop::coupling
