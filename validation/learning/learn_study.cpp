#include "validation/learning/learn_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop::validation {
namespace {

using coupling::SweepPlan;
using nlohmann::json;

/// Lowest to highest value of every key of the start design.
InputBox box_of(SweepPlan const& plan, std::filesystem::path const& path) {
  auto const n = static_cast<Eigen::Index>(plan.keys.size());
  InputBox box{Eigen::RowVectorXd(n), Eigen::RowVectorXd(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    coupling::SweptKey const& key = plan.keys[static_cast<std::size_t>(k)];
    auto const [low, high] = std::ranges::minmax(key.values, {}, &coupling::SweptValue::value);
    if (!key.is_number || !(low.value < high.value))
      throw InputError(
          fmt::format("{}: {} of [sweep.vary] has no range (learning looks between the lowest and the highest value of "
                      "a key) give it two numbers or set it outside of [sweep.vary]",
                      path.string(), key.name));
    box.low[k] = low.value;
    box.high[k] = high.value;
  }
  return box;
}

Eigen::RowVectorXd place_of(coupling::SweepCase const& one) {
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
    study.trials.push_back({place_of(one), output_of(study.summaries.back(), study.settings.output.key)});
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

void tell(LearnStudy const& study, std::int64_t place) {
  fmt::print("{} of {}: {}: {} = {:.4g}\n", place, study.settings.runs, words_of(study.plan, study.plan.cases.back()),
             study.settings.output.key, study.trials.back().value);
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
  study.box = box_of(study.plan, path);
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
  std::uint64_t const first_seed = study.plan.cases.front().checked.seed;
  for (std::int64_t k = 0; k < study.settings.runs; ++k) {
    // Seeds of its own: a place that is proposed again must give a new reading.
    std::vector<std::string> own = overrides;
    own.push_back(
        fmt::format("case.seed={}", first_seed + static_cast<std::uint64_t>((k + 1) * study.plan.replicates)));
    coupling::append_points(study.plan, {values_at(propose(study.trials, study.search()))}, path, own);
    coupling::run_sweep(study.plan, onward, comm);
    read_new_cases(study, options.folder);
    if (comm.is_root() && !options.quiet) tell(study, k + 1);
  }
  return study;
}

}  // namespace layerloop::validation
