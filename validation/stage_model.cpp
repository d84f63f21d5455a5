#include "validation/stage_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "coupling/scan_path.hpp"
#include "validation/candidates.hpp"
#include "validation/condition_case.hpp"
#include "validation/error_model.hpp"
#include "validation/stage_run.hpp"

namespace layerloop::validation {
namespace {

/// One verb under one condition.
struct Job {
  std::size_t condition = 0;
  Verb verb = Verb::spread;
  std::vector<std::size_t> observables = {};
  std::set<std::pair<std::string, Spot>> places = {};
  std::vector<std::string> mesh = {};  ///< --set options that fix it
  bool on_plate = false;               ///< a bare one: the pool's discretisation error comes from a second grid
};

Spot spot_of(Observable const& o) { return {o.layer, o.x, o.y}; }
std::string name_in_run(Observable const& o) { return reading_name(o.quantity, spot_of(o)); }

/// Says of every fault which condition has it, but for those of the case file itself.
void add_faults(std::string const& faults, Condition const& condition, std::filesystem::path const& case_file,
                std::vector<std::string>& all) {
  for (std::size_t at = 0; at < faults.size();) {
    std::size_t const end = std::min(faults.find('\n', at), faults.size());
    std::string line = faults.substr(at, end - at);
    if (!line.starts_with(case_file.string())) line = fmt::format("condition \"{}\": {}", condition.id, line);
    if (std::ranges::find(all, line) == all.end()) all.push_back(line);
    at = end + 1;
  }
}

class StageModel final : public Model {
 public:
  StageModel(Study const& study, std::vector<Candidate> candidates, StageModelOptions const& options,
             Communicator const& comm)
      : study_(study),
        candidates_(std::move(candidates)),
        options_(options),
        comm_(comm),
        cases_(study_),
        cache_(options.cache, comm) {
    find_jobs();
    std::vector<std::string> faults;
    for (Job& job : jobs_) prepare(job, faults);
    if (!faults.empty()) throw InputError(fmt::format("{}", fmt::join(faults, "\n")));
  }

  Prediction predict(ModelPoint const& point) override {
    if (error_of_mesh_.empty()) find_error_of_mesh();
    Samples const samples = sample(point);
    Prediction prediction = mean_of(samples);
    pool_scatter(samples, prediction);
    apply_instruments(study_, candidates_, point.strengths, prediction.value);
    return prediction;
  }

  double passes() const override { return computed_ / static_cast<double>(runs_of_a_pass_); }
  std::vector<std::string> notes() const override { return notes_; }

 private:
  std::int64_t beds_of(Job const& job) const { return job.on_plate ? 1 : options_.beds; }

  /// Readings by observable, one a bed.
  using Samples = std::vector<std::vector<Reading>>;

  void find_jobs() {
    std::map<std::pair<std::size_t, Verb>, Job> jobs;
    std::set<std::size_t> whole_runs;  // conditions in which a part is made
    for (Observable const& o : study_.observables)
      if (verb_for(o, cases_.scans()) == Verb::run) whole_runs.insert(o.condition);
    for (std::size_t i = 0; i < study_.observables.size(); ++i) {
      Observable const& o = study_.observables[i];
      Verb verb = verb_for(o, cases_.scans());
      if (verb != Verb::calibrate && whole_runs.contains(o.condition)) verb = Verb::run;
      Job& job = jobs[{o.condition, verb}];
      job.condition = o.condition;
      job.verb = verb;
      job.observables.push_back(i);
      if (spot_of(o) != Spot{}) job.places.emplace(o.quantity, spot_of(o));
    }
    for (auto& [key, job] : jobs) jobs_.push_back(std::move(job));
  }

  /// Fixes the mesh and refuses what does not make a good case.
  void prepare(Job& job, std::vector<std::string>& faults) {
    try {
      Eigen::VectorXd const means = prior_means(study_);
      Case const base = cases_.make(cases_.settings(job.condition, means), job.verb);
      if (base.process == Process::exposing && base.melt.bed == MeltedBed::file)
        throw InputError("melt.bed = \"file\" (a study names no file of grains) use \"plate\" or \"spread\"");
      job.on_plate = job.verb == Verb::melt && base.melt.bed == MeltedBed::plate;
      if (job.verb == Verb::melt) job.mesh = mesh_settings(base, with_each_candidate(job, base));
      if (job.verb == Verb::melt) {
        Case const meshed = case_at(job, means, Eigen::VectorXd::Zero(index(candidates_.size())));
        coupling::scan_path(coupling::with_plate(meshed, coupling::estimate_pool(meshed)), 1);
      }
      bool const new_bed = spreads_first(job.verb, base) && with_bed_.insert(job.condition).second;
      runs_of_a_pass_ += ((new_bed ? 1 : 0) + (job.verb == Verb::spread ? 0 : 1)) * beds_of(job);
    } catch (InputError const& error) {
      add_faults(error.what(), study_.conditions[job.condition], study_.case_file, faults);
    }
  }

  /// The condition with one candidate at a time, at the strength that it may well have.
  std::vector<Case> with_each_candidate(Job const& job, Case const& base) const {
    std::vector<Case> all;
    for (Candidate const& candidate : candidates_) {
      std::vector<std::string> settings = cases_.settings(job.condition, prior_means(study_));
      std::vector<std::string> const own = settings_of(candidate, candidate.prior_scale, base);
      if (own.empty()) continue;
      settings.insert(settings.end(), own.begin(), own.end());
      try {
        all.push_back(cases_.make(settings, job.verb));
      } catch (InputError const&) {
        // This candidate cannot have that strength here; a prediction will say so.
      }
    }
    return all;
  }

  Case case_at(Job const& job, Eigen::VectorXd const& calibration, Eigen::VectorXd const& strengths) const {
    std::vector<std::string> settings = cases_.settings(job.condition, calibration);
    settings.insert(settings.end(), job.mesh.begin(), job.mesh.end());
    if (strengths.isZero(0)) return cases_.make(settings, job.verb);
    Case const base = cases_.make(settings, job.verb);
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      std::vector<std::string> const own = settings_of(candidates_[c], strengths[index(c)], base);
      settings.insert(settings.end(), own.begin(), own.end());
    }
    return cases_.make(settings, job.verb);
  }

  /// \param second_grid  for the discretisation error of pool and absorptivity; the figures are the same either way
  RunReadings run(Job const& job, Case checked, bool second_grid) {
    checked.melt.two_grids = second_grid && job.verb == Verb::melt && coupling::second_cell(checked);
    try {
      StageRun const done = run_stage(job.verb, checked, job.places, cache_, comm_);
      computed_ += done.computed;
      return done.readings;
    } catch (StoppedBySignal const&) {
      throw_stopped();  // the verb's own words speak of its output folder
    }
  }

  [[noreturn]] static void throw_stopped() {
    throw StoppedBySignal("stopped by a signal (as asked) what was computed is in the cache: run it again to go on");
  }

  ModelPoint base_point() const { return {prior_means(study_), Eigen::VectorXd::Zero(index(candidates_.size())), 0}; }

  /// Whether this is where the error of the mesh is taken, which every other point shares.
  bool is_base(ModelPoint const& point) const {
    ModelPoint const base = base_point();
    return point.calibration == base.calibration && point.strengths == base.strengths && point.seeds == base.seeds;
  }

  Samples sample(ModelPoint const& point) {
    Samples samples(study_.observables.size());
    Progress progress("conditions", static_cast<double>(jobs_.size()), comm_.is_root() && !options_.quiet);
    for (std::size_t j = 0; j < jobs_.size(); ++j) {
      Job const& job = jobs_[j];
      for (std::int64_t bed = 0; bed < beds_of(job); ++bed) {
        RunReadings const readings = readings_of(job, point, static_cast<std::uint64_t>(bed));
        for (std::size_t const i : job.observables) {
          auto const found = readings.readings.find(name_in_run(study_.observables[i]));
          samples[i].push_back(found == readings.readings.end() ? Reading{std::nan("")} : found->second);
        }
      }
      if (comm_.any(stop_requested())) throw_stopped();
      progress.update(static_cast<double>(j + 1));
    }
    return samples;
  }

  RunReadings readings_of(Job const& job, ModelPoint const& point, std::uint64_t bed) {
    try {
      Case checked = case_at(job, point.calibration, point.strengths);
      checked.seed += 1000 * point.seeds + bed;
      RunReadings const readings = run(job, checked, is_base(point));
      if (!readings.stopped.empty()) note(job, readings.stopped);
      return readings;
    } catch (InputError const& error) {
      note(job, error.what());  // a number of this point lies beyond what a case may hold
      return {};
    }
  }

  void note(Job const& job, std::string const& why) {
    std::string const words = fmt::format("condition \"{}\": {}", study_.conditions[job.condition].id, why);
    if (std::ranges::find(notes_, words) == notes_.end()) notes_.push_back(words);
  }

  /// Of every observable that light and heat give, from two grids at the base point, over beds the root mean square;
  /// not a number: it has none there.
  void find_error_of_mesh() {
    error_of_mesh_.assign(study_.observables.size(), std::nan(""));
    auto const melts = [](Job const& job) { return job.verb == Verb::melt; };
    if (std::ranges::none_of(jobs_, melts)) return;
    Samples const base = sample(base_point());
    for (Job const& job : jobs_) {
      if (!melts(job)) continue;
      for (std::size_t const i : job.observables) {
        double squares = 0, count = 0;
        for (Reading const& bed : base[i])
          if (std::isfinite(bed.value)) squares += bed.u_numerical * bed.u_numerical, ++count;
        if (count > 0) error_of_mesh_[i] = std::sqrt(squares / count);
      }
    }
  }

  Prediction mean_of(Samples const& samples) const {
    Eigen::Index const n = index(samples.size());
    Prediction all{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    for (Eigen::Index i = 0; i < n; ++i) {
      auto const& beds = samples[static_cast<std::size_t>(i)];
      double const count = static_cast<double>(beds.size());
      double within = 0, numerical = 0;
      for (Reading const& bed : beds) {
        all.value[i] += bed.value / count;
        within += bed.u_sampling * bed.u_sampling;
        numerical = std::max(numerical, bed.u_numerical);
      }
      all.u_sampling[i] = std::sqrt(within) / count;
      double const shared = error_of_mesh_[static_cast<std::size_t>(i)];
      all.u_numerical[i] = std::isnan(shared) ? numerical : shared;
    }
    return all;
  }

  /// With several beds: the scatter from bed to bed, pooled over the conditions as a share of the value.
  void pool_scatter(Samples const& samples, Prediction& prediction) const {
    struct Pool {
      double squares = 0, dof = 0;
    };
    std::map<std::string, Pool> pools;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      double const mean = prediction.value[index(i)];
      if (samples[i].size() < 2 || !std::isfinite(mean) || mean == 0) continue;
      Pool& pool = pools[study_.observables[i].quantity];
      for (Reading const& bed : samples[i]) pool.squares += std::pow(bed.value / mean - 1, 2);
      pool.dof += static_cast<double>(samples[i].size()) - 1;
    }
    for (std::size_t i = 0; i < samples.size(); ++i) {
      auto const pool = pools.find(study_.observables[i].quantity);
      if (samples[i].size() < 2 || pool == pools.end()) continue;
      double const sd = std::abs(prediction.value[index(i)]) * std::sqrt(pool->second.squares / pool->second.dof);
      prediction.u_sampling[index(i)] = sd / std::sqrt(static_cast<double>(samples[i].size()));
    }
  }

  Study study_;
  std::vector<Candidate> candidates_;
  StageModelOptions options_;
  Communicator const& comm_;
  ConditionCases cases_;
  StageCache cache_;
  std::vector<Job> jobs_;
  std::set<std::size_t> with_bed_;  ///< conditions in which one is spread
  std::int64_t runs_of_a_pass_ = 0;
  double computed_ = 0;
  std::vector<double> error_of_mesh_;  ///< by observable
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<Model> stage_model(Study const& study, std::vector<Candidate> const& candidates,
                                   StageModelOptions const& options, Communicator const& comm) {
  return std::make_unique<StageModel>(study, candidates, options, comm);
}

}  // namespace layerloop::validation
