#include "validation/learning/learn_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/case_key.hpp"
#include "core/error.hpp"
#include "core/toml_entries.hpp"
#include "core/write_file.hpp"
#include "validation/stage_run.hpp"

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

/// What every proposal follows from, besides the cases.
json search_json(LearnSettings const& settings) {
  return {{"output", settings.output.key},
          {"goal", name_of(settings.goal)},
          {"acquisition", name_of(settings.acquisition)},
          {"seed", settings.seed}};
}

void refuse_another_search(LearnSettings const& settings, std::filesystem::path const& folder) {
  std::filesystem::path const path = folder / "learn.json";
  if (!std::filesystem::is_regular_file(path)) return;
  json const before = json::parse(read_file(path), nullptr, false), now = search_json(settings);
  std::string differs;
  for (auto const& [key, value] : now.items()) {
    json const there = before.is_object() ? before.value(key, json()) : json();
    if (there != value)
      differs +=
          fmt::format("{}{} is {} there and {} here", differs.empty() ? "" : ", ", key, there.dump(), value.dump());
  }
  if (!differs.empty())
    throw InputError(fmt::format("{} holds another search ({}) choose another folder", folder.string(), differs));
}

/// Whether every case of the plan has ended and the folder holds one more: it was proposed after them.
bool holds_next(LearnStudy const& study, std::filesystem::path const& folder) {
  auto const state = [&](std::size_t k) {
    return coupling::read_record(folder / coupling::case_folder(static_cast<std::int64_t>(k) + 1)).state;
  };
  std::size_t const cases = study.plan.cases.size();
  for (std::size_t k = study.trials.size(); k < cases; ++k)
    if (state(k) != coupling::CaseState::done && state(k) != coupling::CaseState::failed) return false;
  return state(cases) != coupling::CaseState::waiting;
}

void check_start(LearnStudy const& study) {
  auto const finite =
      std::ranges::count_if(study.trials, [](LearnedRun const& trial) { return std::isfinite(trial.value); });
  if (finite < 2)
    throw PhysicsError(
        fmt::format("{} of {} cases of the start design give {} (two at least are needed to learn from) "
                    "cases.csv says why: vary less, or choose another output",
                    finite, study.trials.size(), study.settings.output.key));
}

std::vector<coupling::SweptValue> values_at(Eigen::RowVectorXd const& place) {
  std::vector<coupling::SweptValue> values;
  for (double const value : place) values.push_back(coupling::swept_number(value));
  return values;
}

/// The next place to run; one that the case does not allow, in a corner of the box, counts as failed.
Eigen::RowVectorXd next_place(LearnStudy const& study) { return propose(study.known(), study.search()); }

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
  coupling::ShownQuantity const& output = study.settings.output;
  std::string const where = words_of(study.plan, study.plan.cases.back());
  double const value = study.trials.back().value;
  if (!std::isfinite(value)) return fmt::format("{}: failed, no {}", where, output.key);
  std::string const unit = plain_unit(output);
  return fmt::format("{}: {} = {:.4g}{}", where, output.key, output.scale * value, unit.empty() ? "" : " " + unit);
}

/// Adds the places that the folder holds to the plan, as they were proposed. Returns how many, with those refused.
std::int64_t recall(LearnStudy& study, std::filesystem::path const& path, std::vector<std::string> const& overrides,
                    std::filesystem::path const& folder) {
  std::int64_t proposed = 0;
  for (; holds_next(study, folder); ++proposed) {
    read_new_cases(study, folder);
    check_start(study);
    add_place(study, next_place(study), path, overrides);
  }
  return proposed;
}

}  // namespace

LearnPlan LearnStudy::search() const {
  auto const drawn = [&](coupling::SweepCase const& one) { return depends_on_seed(plan.verb, one.checked); };
  return {box, settings.goal, settings.acquisition, settings.seed,
          std::ranges::any_of(plan.cases, drawn) ? Readings::noisy : Readings::exact};
}

std::vector<LearnedRun> LearnStudy::known() const {
  std::vector<LearnedRun> all = trials;
  all.insert(all.end(), refused.begin(), refused.end());
  return all;
}

std::size_t failed_runs(LearnStudy const& study) {
  return static_cast<std::size_t>(
      std::ranges::count_if(study.trials, [](LearnedRun const& trial) { return !std::isfinite(trial.value); }));
}

double output_of(json const& summary, std::string const& key) {
  if (!summary.is_object()) return NAN;
  auto const layers = summary.find("layers");
  return coupling::figure_in(layers != summary.end() && !layers->empty() ? layers->back() : summary, key);
}

LearnStudy read_learning(std::filesystem::path const& path, std::vector<std::string> const& overrides) {
  LearnStudy study;
  std::string faults;
  auto const collect = [&](auto const& read) {
    try {
      read();
    } catch (InputError const& fault) {
      if (faults != fault.what()) faults += (faults.empty() ? "" : "\n") + std::string(fault.what());
    }
  };
  collect([&] { study.plan = coupling::read_sweep(path, overrides); });
  collect([&] { study.settings = read_learn(path, overrides); });
  if (!faults.empty()) throw InputError(faults);
  study.start = study.plan.points;
  study.box = box_of(study.plan, path, overrides);
  return study;
}

LearnStudy run_learning(std::filesystem::path const& path, std::vector<std::string> const& overrides,
                        coupling::SweepOptions const& options, Communicator const& comm) {
  LearnStudy study = read_learning(path, overrides);
  std::int64_t proposed = 0;
  if (options.resume) {
    refuse_another_search(study.settings, options.folder);
    proposed = recall(study, path, overrides, options.folder);
  }
  coupling::run_sweep(study.plan, options, comm);
  read_new_cases(study, options.folder);
  check_start(study);
  if (comm.is_root()) write_file(options.folder / "learn.json", search_json(study.settings).dump(1) + "\n");
  bool const talks = comm.is_root() && !options.quiet;
  if (talks && proposed < study.settings.runs)
    fmt::print("now the search: {} of {} places\n", study.settings.runs - proposed, study.settings.runs);
  coupling::SweepOptions onward = options;
  onward.resume = onward.quiet = true;
  for (; proposed < study.settings.runs; ++proposed) {
    std::string const fault = add_place(study, next_place(study), path, overrides);
    if (fault.empty()) {
      coupling::run_sweep(study.plan, onward, comm);
      read_new_cases(study, options.folder);
    }
    if (talks)
      fmt::print("{} of {}: {}\n", proposed + 1, study.settings.runs, fault.empty() ? words_of_last(study) : fault);
  }
  return study;
}

}  // namespace layerloop::validation
