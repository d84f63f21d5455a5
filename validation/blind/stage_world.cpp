#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/write_file.hpp"
#include "validation/blind/stage_design.hpp"
#include "validation/stage_model.hpp"
#include "validation/study_setup.hpp"
#include "validation/truth/readings.hpp"
#include "validation/truth/stage_truth.hpp"

namespace layerloop::validation {
namespace {

/// Counts every point that was asked, known to the cache or not: what an analysis by itself would compute.
class CountedStages final : public Model {
 public:
  explicit CountedStages(std::unique_ptr<Model> stages) : stages_(std::move(stages)) {}
  Prediction predict(ModelPoint const& point) override {
    auto const same = [&](ModelPoint const& other) {
      return other.seeds == point.seeds && other.calibration == point.calibration && other.strengths == point.strengths;
    };
    if (std::ranges::none_of(asked_, same)) asked_.push_back(point);
    return stages_->predict(point);
  }
  double passes() const override { return static_cast<double>(asked_.size()); }
  std::vector<std::string> notes() const override { return stages_->notes(); }

 private:
  std::unique_ptr<Model> stages_;
  std::vector<ModelPoint> asked_;
};

/// Numbers from 0 in the order of a seed; `what` keeps its uses apart.
std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed, std::uint32_t what) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::size_t i) { return uniform4(seed, RandomStream::blind_design, i, what)[0]; });
  return order;
}

class StageWorld final : public World {
 public:
  StageWorld(StageDesign const& design, std::filesystem::path const& folder)
      : design_(design), case_file_(folder / "case.toml"), cache_(folder / "cache") {
    std::filesystem::create_directories(folder);
    write_file(case_file_, design.case_text);
  }

  std::string name() const override { return design_.name; }
  Effort effort() const override { return Effort::dear; }
  int truths_averaged() const override { return design_.measured_beds > 1 ? 2 : 1; }
  std::string case_text() const override { return design_.case_text; }
  std::vector<ScenarioClass> classes() const override { return design_.classes; }
  std::vector<std::string> hidden_effects() const override { return design_.hidden_effects; }
  std::vector<ForeignCause> foreign_causes() const override { return design_.foreign_causes; }
  std::vector<ForeignCause> jumps() const override { return design_.jumps; }
  std::vector<std::string> biased_inputs() const override { return design_.biased_inputs; }
  bool has_other_form(std::string const& effect) const override { return has_other_stage_form(effect); }

  /// The conditions in random order, on two machines in four builds from two lots.
  Study design(std::uint64_t seed) const override {
    Study study;
    study.name = fmt::format("{} {}", design_.name, seed), study.case_file = case_file_;
    study.calibration = design_.calibration;
    std::size_t const count = design_.conditions.size();
    auto const order = shuffled(count, seed, 30), machine = shuffled(count, seed, 31);
    for (std::size_t c = 0; c < count; ++c) {
      std::size_t const build = c * 4 / count;
      study.conditions.push_back({.id = fmt::format("c{:02}", c + 1),
                                  .inputs = design_.conditions[order[c]],
                                  .labels = {{"machine", machine[c] % 2 ? "B" : "A"},
                                             {"build", fmt::format("b{}", build + 1)},
                                             {"lot", build % 2 ? "L2" : "L1"}}});
    }
    std::vector<std::string> seen;
    for (std::size_t c = 0; c < count; ++c) {
      std::string const bed = bed_of(study.conditions[c]);
      bool const first = std::ranges::find(seen, bed) == seen.end();
      if (first) seen.push_back(bed);
      Role const role = order[c] >= count - design_.held_out ? Role::holdout : Role::train;
      for (StageInstrument const& how : design_.instruments)
        if (first || !how.once_a_bed) add_rows(study, c, bed, how, role);
    }
    return study;
  }

  std::vector<Candidate> candidates(Study const& study) const override {
    return candidates_for(study, first_case(study));
  }
  std::unique_ptr<Model> model(Study const& study, std::vector<Candidate> const& candidates) const override {
    return std::make_unique<CountedStages>(
        stage_model(study, candidates, {.cache = cache_, .beds = design_.beds, .quiet = true}, comm_));
  }
  Eigen::VectorXd truth(Study const& study, Eigen::VectorXd const& calibration, std::vector<HiddenCause> const& causes,
                        std::uint64_t seed) const override {
    StageTruth const how{cache_, design_.true_resolution, design_.measured_beds};
    constexpr std::uint64_t first = 10, last = 1'000'000'000'000;  // the model's own seeds are below the first
    return stage_truth(how, study, candidates(study), calibration, causes, first + seed % last);
  }

 private:
  std::string bed_of(Condition const& condition) const {
    std::string name;
    for (std::string const& key : design_.bed_keys) name += fmt::format("{:.3g} ", 1e6 * condition.inputs.at(key));
    return name;
  }

  void add_rows(Study& study, std::size_t c, std::string const& bed, StageInstrument const& how, Role role) const {
    std::size_t const observable = study.observables.size();
    study.observables.push_back({c, how.quantity});
    for (int r = 0; r < how.replicates; ++r) {
      Observation row{.id = fmt::format("m{:03}", study.observations.size() + 1),
                      .condition = c,
                      .observable = observable,
                      .quantity = how.quantity};
      row.u_stat = how.u_stat, row.u_sys_rel = how.u_sys_rel, row.sys_group = how.group;
      if (how.u_bed > 0) {
        row.u_sys_abs = how.u_bed / std::sqrt(static_cast<double>(design_.measured_beds));
        row.sys_group = fmt::format("{}{}of {}", group_of_beds, bed, how.quantity);
      }
      row.role = role, row.oper = "direct", row.instrument = how.quantity;
      row.rep_id = fmt::format("{}", r + 1);
      study.observations.push_back(row);
    }
  }

  StageDesign const& design_;
  std::filesystem::path case_file_, cache_;
  Communicator comm_;
};

}  // namespace

std::unique_ptr<World> stage_world(std::string const& name, std::filesystem::path const& folder) {
  auto const design = std::ranges::find(stage_designs(), name, &StageDesign::name);
  if (design == stage_designs().end())
    throw InputError(
        fmt::format("no world \"{}\" for a blind test (there are {})", name, fmt::join(world_names(), ", ")));
  return std::make_unique<StageWorld>(*design, folder);
}

std::vector<std::string> world_names() {
  std::vector<std::string> names{"analytic"};
  for (StageDesign const& design : stage_designs()) names.push_back(design.name);
  return names;
}

std::unique_ptr<World> world_of(std::string const& name, std::filesystem::path const& folder) {
  return name == "analytic" ? analytic_world() : stage_world(name, folder);
}

}  // namespace layerloop::validation
