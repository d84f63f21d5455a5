#include "validation/learning/learn_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/case_key.hpp"
#include "core/error.hpp"
#include "core/toml_entries.hpp"
#include "core/write_file.hpp"

namespace layerloop::validation {
namespace {

using coupling::SweepPlan;
using nlohmann::json;

/// Why nothing can be looked for between the values of a key; empty: it can.
std::string no_range(coupling::SweptKey const& key) {
  auto const [low, high] = std::ranges::minmax(key.values, {}, &coupling::SweptValue::value);
  if (!key.is_number || !(low.value < high.value))
    return "has no range (learning looks between the lowest and the highest value of a key) give it two numbers or set "
           "it outside of [sweep.vary]";
  if (std::holds_alternative<Member<std::int64_t>>(case_key(key.name)->target))
    return "is a whole number (learning looks at what lies between) set it outside of [sweep.vary]";
  return "";
}

/// Where the file or an option says how a key varies.
Place place_of(std::string const& key, std::filesystem::path const& path, std::vector<std::string> const& overrides) {
  Place found;
  for (TomlEntry const& entry : parse_toml(read_file(path)).entries)
    if (entry.table == "sweep.vary" && entry.key == key) found = entry.place;
  for (std::string const& option : overrides) {
    TomlEntry const entry = parse_override(option);
    if (entry.table == "sweep.vary" && entry.key == key) found = entry.place;
  }
  return found;
}

/// Lowest to highest value of every key of the start design.
InputBox box_of(SweepPlan const& plan, std::filesystem::path const& path, std::vector<std::string> const& overrides) {
  auto const n = static_cast<Eigen::Index>(plan.keys.size());
  InputBox box{Eigen::RowVectorXd(n), Eigen::RowVectorXd(n)};
  std::vector<Fault> faults;
  for (Eigen::Index k = 0; k < n; ++k) {
    coupling::SweptKey const& key = plan.keys[static_cast<std::size_t>(k)];
    auto const [low, high] = std::ranges::minmax(key.values, {}, &coupling::SweptValue::value);
    box.low[k] = low.value;
    box.high[k] = high.value;
    if (std::string const why = no_range(key); !why.empty())
      faults.push_back({place_of(key.name, path, overrides), key.name + " " + why});
  }
  if (!faults.empty()) throw_faults(faults, path.string());
  return box;
}

Eigen::RowVectorXd settings_of(coupling::SweepCase const& one) {
  Eigen::RowVectorXd place(static_cast<Eigen::Index>(one.values.size()));
  for (std::size_t k = 0; k < one.values.size(); ++k) place[static_cast<Eigen::Index>(k)] = one.values[k].value;
  return place;
}

void read_new_cases(LearnStudy& study, std::filesystem::path const& folder) {
  for (std::size_t k = study.trials.size(); k < study.plan.cases.size(); ++k) {
    coupling::SweepCase const& one = study.plan.cases[k];
    std::filesystem::path const own = folder / coupling::case_folder(one.number);
    bool const done = coupling::read_record(own).state == coupling::CaseState::done;
    study.summaries.push_back(done ? json::parse(read_file(own / "summary.json")) : json());
    study.trials.push_back({settings_of(one), output_of(study.summaries.back(), study.settings.output.key)});
  }
}

void check_start(LearnStudy const& study) {
  auto const finite =
      std::ranges::count_if(study.trials, [](Trial const& trial) { return std::isfinite(trial.value); });
  if (finite < 2)
    throw PhysicsError(
        fmt::format("{} of {} cases of the start design give {} (two at least are needed to learn from) "
                    "look at cases.csv, and choose an output that the verb {} has",
                    finite, study.trials.size(), study.settings.output.key, name_of(study.plan.verb)));
}

std::vector<coupling::SweptValue> values_at(Eigen::RowVectorXd const& place) {
  std::vector<coupling::SweptValue> values;
  for (double const value : place) values.push_back(coupling::swept_number(value));
  return values;
}

/// The next place to run; one that the case does not allow, in a corner of the box, counts as failed.
Eigen::RowVectorXd next_place(LearnStudy const& study) {
  std::vector<Trial> all = study.trials;
  all.insert(all.end(), study.refused.begin(), study.refused.end());
  return propose(all, study.search());
}

/// Adds a place to the plan, with seeds of its own: one that is proposed again must give a new reading. Returns why it
/// is no good case; empty: it is.
std::string add_place(LearnStudy& study, Eigen::RowVectorXd const& place, std::filesystem::path const& path,
                      std::vector<std::string> overrides) {
  auto const new_seeds = (study.plan.points - study.start + 1) * static_cast<std::size_t>(study.plan.replicates);
  overrides.push_back(fmt::format("case.seed={}", study.plan.cases.front().checked.seed + new_seeds));
  SweepPlan longer = study.plan;
  try {
    coupling::append_points(longer, {values_at(place)}, path, overrides);
  } catch (InputError const& fault) {
    study.refused.push_back({place, NAN});
    return fault.what();
  }
  study.plan = std::move(longer);
  return "";
}

std::string words_of_last(LearnStudy const& study) {
  return fmt::format("{}: {} = {:.4g}", words_of(study.plan, study.plan.cases.back()), study.settings.output.key,
                     study.trials.back().value);
}

}  // namespace

double output_of(json const& summary, std::string const& key) {
  if (!summary.is_object()) return NAN;
  auto const layers = summary.find("layers");
  return coupling::figure_in(layers != summary.end() && !layers->empty() ? layers->back() : summary, key);
}

LearnStudy read_learning(std::filesystem::path const& path, std::vector<std::string> const& overrides) {
  LearnStudy study{.settings = read_learn(path, overrides), .plan = coupling::read_sweep(path, overrides)};
  study.start = study.plan.points;
  study.box = box_of(study.plan, path, overrides);
  return study;
}

LearnStudy run_learning(std::filesystem::path const& path, std::vector<std::string> const& overrides,
                        coupling::SweepOptions const& options, Communicator const& comm) {
  LearnStudy study = read_learning(path, overrides);
  coupling::run_sweep(study.plan, options, comm);
  read_new_cases(study, options.folder);
  check_start(study);
  coupling::SweepOptions onward = options;
  onward.resume = onward.quiet = true;
  for (std::int64_t k = 0; k < study.settings.runs; ++k) {
    std::string const fault = add_place(study, next_place(study), path, overrides);
    if (fault.empty()) {
      coupling::run_sweep(study.plan, onward, comm);
      read_new_cases(study, options.folder);
    }
    if (comm.is_root() && !options.quiet)
      fmt::print("{} of {}: {}\n", k + 1, study.settings.runs, fault.empty() ? words_of_last(study) : fault);
  }
  return study;
}

}  // namespace layerloop::validation
