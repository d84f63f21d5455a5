#include "validation/learning/learn_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "core/error.hpp"
#include "core/spelling.hpp"
#include "core/toml_entries.hpp"
#include "core/write_file.hpp"
#include "coupling/verb.hpp"

namespace layerloop::validation {
namespace {

using coupling::Verb;

std::vector<std::string> const goals{"maximise", "minimise", "know"};
std::vector<std::string> const acquisitions{"expected_improvement", "upper_confidence_bound", "variance"};

/// Whether the last layer, or the summary, of a verb can have a figure.
bool gives(Verb verb, std::string const& key) {
  auto const one_of = [&](std::vector<std::string> const& keys) { return std::ranges::find(keys, key) != keys.end(); };
  auto const among = [&](std::vector<coupling::ShownQuantity> const& list) {
    return std::ranges::find(list, key, &coupling::ShownQuantity::key) != list.end();
  };
  bool const angle = one_of({"angle_of_repose", "slipping_angle"});
  switch (verb) {
    case Verb::spread:
      return among(coupling::layer_quantities()) && !one_of({"absorptivity", "melted_mass", "part_relative_density"});
    case Verb::run:
      return among(coupling::layer_quantities()) ||
             one_of({"mean_bounces", "peak_temperature", "pool.width", "pool.depth", "pool.length"});
    case Verb::calibrate:
      return angle;
    case Verb::absorb:
      return one_of({"absorptivity", "mean_bounces"});
    case Verb::melt:
      return among(coupling::exposure_quantities()) && !angle && key != "mean_bounces";
  }
  return false;
}

/// \param verb  none: of any
std::vector<coupling::ShownQuantity> outputs_of(std::optional<Verb> verb) {
  std::vector<coupling::ShownQuantity> all = coupling::layer_quantities();
  for (coupling::ShownQuantity const& quantity : coupling::exposure_quantities())
    if (std::ranges::find(all, quantity.key, &coupling::ShownQuantity::key) == all.end()) all.push_back(quantity);
  std::erase_if(all, [&](coupling::ShownQuantity const& quantity) { return verb && !gives(*verb, quantity.key); });
  return all;
}

class LearnReader {
 public:
  LearnReader(TomlContent const& content, std::vector<TomlEntry> const& overrides) {
    for (auto const* list : {&content.entries, &overrides})
      for (TomlEntry const& entry : *list)
        if (entry.table == "learn") entries_.insert_or_assign(entry.key, entry);
    for (auto const* list : {&content.entries, &overrides})
      for (TomlEntry const& entry : *list)
        if (entry.table == "sweep" && entry.key == "verb") verb_ = verb_of(entry.value);
    if (auto const table = content.tables.find("learn"); table != content.tables.end()) place_ = table->second;
    std::vector<std::string> const known{"output", "goal", "acquisition", "runs", "seed"};
    for (auto const& [key, entry] : entries_)
      if (std::ranges::find(known, key) == known.end())
        report(entry.place, fmt::format("unknown key \"{}\" in [learn] (known: {}){}", key, fmt::join(known, ", "),
                                        did_you_mean(key, known)));
    read();
  }

  LearnSettings settings;
  std::vector<Fault> faults;

 private:
  void report(Place const& place, std::string const& message) { faults.push_back({place, message}); }

  /// None: read_sweep says what is wrong with it.
  static std::optional<Verb> verb_of(TomlValue const& value) {
    auto const* const text = std::get_if<std::string>(&value.content);
    return text ? coupling::verb_named(*text) : std::nullopt;
  }

  void read() {
    std::vector<coupling::ShownQuantity> const outputs = outputs_of(verb_);
    std::vector<std::string> names;
    for (coupling::ShownQuantity const& output : outputs) names.push_back(output.key);
    std::string const choice = fmt::format(
        "a figure of {}: {}", verb_ ? "the verb " + coupling::name_of(*verb_) : "a verb", fmt::join(names, ", "));
    settings.output = outputs[word("output", names, choice, 0, true)];
    settings.goal = static_cast<Goal>(word("goal", goals, fmt::format("one of {}", fmt::join(goals, ", ")), 0, true));
    settings.acquisition = static_cast<Acquisition>(
        word("acquisition", acquisitions, fmt::format("one of {}", fmt::join(acquisitions, ", ")), 0, false));
    settings.runs = whole("runs", -1, 100000);
    settings.seed = static_cast<std::uint64_t>(whole("seed", 1, std::numeric_limits<std::int64_t>::max()));
    auto const acquisition = entries_.find("acquisition");
    if (settings.goal == Goal::know && acquisition != entries_.end() && settings.acquisition != Acquisition::variance)
      report(acquisition->second.place, fmt::format("acquisition = \"{}\" with goal = \"know\" (it looks for a largest "
                                                    "value) write \"variance\" or leave it out",
                                                    name_of(settings.acquisition)));
    if (settings.goal == Goal::know) settings.acquisition = Acquisition::variance;
  }

  /// Place of a word in its list. \param choice  the list, for messages
  std::size_t word(std::string const& key, std::vector<std::string> const& words, std::string const& choice,
                   std::size_t fallback, bool needed) {
    auto const entry = entries_.find(key);
    if (entry == entries_.end()) {
      if (needed) report(place_, fmt::format("missing key \"{}\" in [learn] ({})", key, choice));
      return fallback;
    }
    auto const* const text = std::get_if<std::string>(&entry->second.value.content);
    auto const found = text ? std::ranges::find(words, *text) : words.end();
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    report(entry->second.place, fmt::format("{} = {} (must be {}){}", key, shown(entry->second.value), choice,
                                            text ? did_you_mean(*text, words) : ""));
    return fallback;
  }

  /// \param fallback  negative: the key is needed
  std::int64_t whole(std::string const& key, std::int64_t fallback, std::int64_t most) {
    auto const entry = entries_.find(key);
    if (entry == entries_.end()) {
      if (fallback < 0) report(place_, fmt::format("missing key \"{}\" in [learn] (a whole number)", key));
      return std::max<std::int64_t>(0, fallback);
    }
    auto const* const number = std::get_if<std::int64_t>(&entry->second.value.content);
    if (number && *number >= 0 && *number <= most) return *number;
    report(entry->second.place,
           fmt::format("{} = {} (must be a whole number from 0 to {})", key, shown(entry->second.value), most));
    return std::max<std::int64_t>(0, fallback);
  }

  std::map<std::string, TomlEntry> entries_;
  std::optional<Verb> verb_;
  Place place_;
};

}  // namespace

std::string const& name_of(Goal goal) { return goals.at(static_cast<std::size_t>(goal)); }

std::string const& name_of(Acquisition acquisition) { return acquisitions.at(static_cast<std::size_t>(acquisition)); }

std::string plain_unit(coupling::ShownQuantity const& quantity) {
  std::string const column = coupling::column_unit(quantity);  // " [um]"
  return column.empty() ? "" : column.substr(2, column.size() - 3);
}

LearnSettings read_learn(std::filesystem::path const& path, std::vector<std::string> const& overrides) {
  std::vector<Fault> faults;
  TomlContent content;
  std::vector<TomlEntry> set;
  try {
    content = parse_toml(read_file(path));
    for (std::string const& option : overrides) set.push_back(parse_override(option));
  } catch (SyntaxFault const& fault) {
    throw_faults({fault.fault}, path.string());
  }
  if (!content.tables.contains("learn"))
    throw InputError(
        fmt::format("{}:1:1: missing table [learn] (it says what is looked for) write output, goal and runs in [learn]",
                    path.string()));
  LearnReader read(content, set);
  if (!read.faults.empty()) throw_faults(read.faults, path.string());
  return read.settings;
}

}  // namespace layerloop::validation
