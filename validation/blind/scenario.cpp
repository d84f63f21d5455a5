#include "validation/blind/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/random.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/blind/separation.hpp"
#include "validation/condition_case.hpp"
#include "validation/truth/readings.hpp"

namespace layerloop::validation {
namespace {

enum class Visible { faintly_too, clearly };

/// Draws one scenario step by step.
class Draw {
 public:
  Draw(World const& world, ScenarioClass kind, std::string const& id, std::uint64_t secret)
      : world_(world), secret_(secret), candidates_() {
    scenario_.study = world.design(secret);
    scenario_.study.name = id;
    scenario_.answer.id = id, scenario_.answer.kind = kind;
    candidates_ = world.candidates(scenario_.study);
    train_ = part_of(scenario_.study, Role::train);
    draw_calibration(kind == ScenarioClass::wrong_calibration);
    errors_.heavy_tails = uniform() < 0.3;
  }

  Scenario finish() {
    Answer& answer = scenario_.answer;
    Eigen::VectorXd const truth = world_.truth(scenario_.study, calibration_, answer.causes, secret_);
    take_readings(scenario_.study, truth, errors_, secret_);
    std::erase_if(scenario_.study.observations, [](Observation const& row) { return !(row.value > 0); });
    for (Observation const& row : scenario_.study.observations) answer.truth[row.id] = truth[index(row.observable)];
    answer.calibration.assign(calibration_.begin(), calibration_.end());
    if (errors_.heavy_tails) answer.text += "; noise with heavy tails";
    return std::move(scenario_);
  }

  double uniform() { return uniform4(secret_, RandomStream::blind_truth, 0, draws_++)[0]; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
  double sign() { return uniform() < 0.5 ? -1 : 1; }
  template <class T>
  T const& one_of(std::vector<T> const& all) {
    return all[std::min(all.size() - 1, static_cast<std::size_t>(uniform() * static_cast<double>(all.size())))];
  }

  std::vector<Candidate> candidates_of(EffectClass kind) const {
    std::vector<Candidate> some;
    std::ranges::copy_if(candidates_, std::back_inserter(some), [&](auto const& c) { return c.kind == kind; });
    return some;
  }

  std::vector<Candidate> hidden_effects() const {
    std::vector<std::string> const names = world_.hidden_effects();
    std::vector<Candidate> some;
    std::ranges::copy_if(candidates_, std::back_inserter(some),
                         [&](auto const& c) { return std::ranges::find(names, c.name) != names.end(); });
    return some;
  }

  void hide_candidate(Candidate const& candidate, Visible visible) {
    constexpr double share_of_other_forms = 0.7;
    HiddenCause cause{candidate.name, (candidate.two_sided ? sign() : 1) * candidate.prior_scale};
    cause.other_form = world_.has_other_form(candidate.name) && uniform() < share_of_other_forms;
    hide(cause, candidate.largest, visible);
  }

  /// Adds a cause, as strong as a drawn visibility wants it and its bound allows.
  void hide(HiddenCause cause, double largest, Visible visible) {
    double const least = visible == Visible::faintly_too ? 2 : world_.effort() == Effort::free ? 5 : 8;
    double const wanted = log_uniform(least, 30);
    int const trials = world_.effort() == Effort::free ? 4 : 2;
    for (int trial = 0; trial < trials; ++trial) {
      double const factor = wanted / visibility_of({cause});
      if (!(std::abs(factor - 1) > 0.1)) break;
      double const magnitude = std::abs(cause.strength) * std::clamp(factor, 0.02, 20.0);
      cause.strength = std::copysign(std::min(magnitude, 0.9 * largest), cause.strength);
    }
    add(cause);
  }

  void add(HiddenCause const& cause) {
    Answer& answer = scenario_.answer;
    Eigen::VectorXd const change = change_of({cause});
    answer.causes.push_back(cause);
    answer.visibilities.push_back(separation().visibility(change));
    bool const as_catalogued = world_.effort() == Effort::dear && !cause.other_form;
    answer.strengths.push_back(as_catalogued ? cause.strength : separation().equivalent_strength(cause.name, change));
    if (answer.causes.size() > 1) return;
    auto const nearest = separation().nearest(change, {cause.name});
    answer.nearest = nearest.name, answer.largest_cosine = nearest.cosine;
  }

  Separation::Nearest nearest_to(Candidate const& candidate) {
    return separation().nearest(change_of({{candidate.name, candidate.prior_scale}}), {candidate.name});
  }

  World const& world() const { return world_; }
  Answer& answer() { return scenario_.answer; }
  ReadingErrors& errors() { return errors_; }
  std::vector<std::string>& withheld() { return scenario_.withheld; }
  std::vector<Candidate> const& candidates() const { return candidates_; }
  Study& study() { return scenario_.study; }

 private:
  void draw_calibration(bool wrong) {
    auto const& numbers = scenario_.study.calibration;
    calibration_.resize(index(numbers.size()));
    std::size_t const many = wrong ? 1 + static_cast<std::size_t>(uniform() * 4.999) : 0;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      double const pull = standard_normal_at(secret_, k, 2000);
      calibration_[index(k)] = numbers[k].mean + numbers[k].sd * std::clamp(pull, -2.5, 2.5);
    }
    std::size_t const first = static_cast<std::size_t>(uniform() * static_cast<double>(numbers.size()));
    for (std::size_t j = 0; j < std::min(many, numbers.size()); ++j) {
      std::size_t const k = (first + j) % numbers.size();
      double const pull = sign() * uniform(2, 4);
      calibration_[index(k)] = numbers[k].mean + numbers[k].sd * pull;
      scenario_.answer.text +=
          fmt::format("{}{} is {:+.1f} prior deviations off", j ? ", " : "", numbers[k].name, pull);
    }
  }

  Separation& separation() {
    if (!separation_) {
      probed_ = world_.effort() == Effort::free ? calibration_ : prior_means(train_);
      model_ = world_.model(train_, candidates_);
      separation_ = std::make_unique<Separation>(train_, *model_, candidates_, probed_, world_.effort());
      plain_ = expected({});
    }
    return *separation_;
  }

  /// Over seeds of all scenarios, so that they share what was computed.
  Eigen::VectorXd expected(std::vector<HiddenCause> const& causes) const {
    int const count = world_.truths_averaged();
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(index(train_.observables.size()));
    for (int seed = 1; seed <= count; ++seed)
      sum += world_.truth(train_, probed_, causes, static_cast<std::uint64_t>(seed));
    return sum / count;
  }

  Eigen::VectorXd change_of(std::vector<HiddenCause> const& causes) {
    separation();
    Eigen::VectorXd const change = expected(causes) - plain_;
    return change.array().isFinite().select(change, 0);  // where nothing melts, nobody measures a pool
  }
  double visibility_of(std::vector<HiddenCause> const& causes) {
    Eigen::VectorXd const change = change_of(causes);
    return separation().visibility(change);
  }

  World const& world_;
  std::uint64_t secret_;
  std::uint32_t draws_ = 0;
  std::vector<Candidate> candidates_;
  Scenario scenario_;
  Study train_;
  Eigen::VectorXd calibration_;
  Eigen::VectorXd probed_, plain_;  ///< calibration where visibilities are judged, and the truth there without a cause
  std::unique_ptr<Model> model_;
  std::unique_ptr<Separation> separation_;
  ReadingErrors errors_;
};

std::string told(Answer const& answer) {
  std::string text;
  for (std::size_t j = 0; j < answer.causes.size(); ++j)
    text += fmt::format("{}{} of strength {:.3g} (lambda {:.1f})", j ? " and " : "", answer.causes[j].name,
                        answer.causes[j].strength, answer.visibilities[j]);
  return text;
}

/// Where a scenario is dear, none is spent on what can hardly be seen.
void hide_one_effect(Draw& draw) {
  Visible const how = draw.world().effort() == Effort::dear ? Visible::clearly : Visible::faintly_too;
  draw.hide_candidate(draw.one_of(draw.hidden_effects()), how);
}

void hide_withheld_effect(Draw& draw) {
  draw.hide_candidate(draw.one_of(draw.hidden_effects()), Visible::clearly);
  draw.withheld() = {draw.answer().causes.front().name};
}

void hide_foreign_cause(Draw& draw) {
  ForeignCause const cause = draw.one_of(draw.world().foreign_causes());
  draw.hide({cause.name, 1}, cause.largest, Visible::clearly);
  draw.answer().variables = cause.variables, draw.answer().quantities = cause.quantities;
}

void hide_two_effects(Draw& draw) {
  auto const physics = draw.hidden_effects();
  Candidate const first = draw.one_of(physics);
  Candidate second = draw.one_of(physics);
  while (second.name == first.name || draw.nearest_to(first).name == second.name) second = draw.one_of(physics);
  draw.hide_candidate(first, Visible::clearly);
  draw.hide_candidate(second, Visible::clearly);
}

/// One effect of those that have a twin in this design.
void hide_twins(Draw& draw) {
  auto const physics = draw.hidden_effects();
  std::vector<Candidate> with_twin;
  std::ranges::copy_if(physics, std::back_inserter(with_twin),
                       [&](Candidate const& c) { return draw.nearest_to(c).cosine > 0.97; });
  draw.hide_candidate(draw.one_of(with_twin.empty() ? physics : with_twin), Visible::clearly);
}

void hide_bad_noise(Draw& draw) {
  std::size_t const which = static_cast<std::size_t>(draw.uniform() * 2.999);
  if (which == 0) {
    draw.errors().outlier_share = draw.uniform(0.03, 0.05);
    draw.answer().text = fmt::format("{:.1f} % of the rows are outliers", 100 * draw.errors().outlier_share);
  } else if (which == 1) {
    draw.errors().noise_factor = 1.5;
    draw.answer().text = "the noise is 1.5 times what is stated";
  } else {
    std::vector<std::string> groups;
    for (Observation const& row : draw.study().observations)
      if (std::ranges::find(groups, row.sys_group) == groups.end()) groups.push_back(row.sys_group);
    draw.errors().omitted_group = draw.one_of(groups);
    draw.answer().text =
        fmt::format("the shared error of {} is twice as large and not stated", draw.errors().omitted_group);
  }
}

void hide_not_physics(Draw& draw) {
  auto causes = draw.candidates_of(EffectClass::numerics);
  for (Candidate const& other : draw.candidates_of(EffectClass::instrument)) causes.push_back(other);
  draw.hide_candidate(draw.one_of(causes), Visible::clearly);
}

void hide_real_life(Draw& draw) {
  Answer& answer = draw.answer();
  auto const which = static_cast<std::size_t>(draw.uniform() * 3.999);
  if (which == 0) {
    draw.errors().noise_factor = draw.log_uniform(0.5, 3);
    answer.text = fmt::format("the noise is {:.2f} times what is stated", draw.errors().noise_factor);
  } else if (which < 3) {
    std::vector<ForeignCause> const jumps = draw.world().jumps();
    ForeignCause const& jump = jumps[which % jumps.size()];
    draw.hide({jump.name, draw.sign(), draw.uniform(0.25, 0.75)}, jump.largest, Visible::faintly_too);
    answer.text = "an unlabelled change: " + told(answer);
  } else {
    std::string const machine = draw.uniform() < 0.5 ? "" : "B";
    draw.add(
        {"error of " + draw.one_of(draw.world().biased_inputs()), draw.sign() * draw.uniform(0.05, 0.10), 0, machine});
    answer.text = "a biased input" + std::string(machine.empty() ? ": " : " of machine B: ") + told(answer);
  }
}

}  // namespace

Scenario draw_scenario(World const& world, ScenarioClass kind, std::string const& id, std::uint64_t secret) {
  using enum ScenarioClass;
  Draw draw(world, kind, id, secret);
  switch (kind) {
    case one_effect:
      hide_one_effect(draw);
      break;
    case withheld_effect:
      hide_withheld_effect(draw);
      break;
    case foreign_cause:
      hide_foreign_cause(draw);
      break;
    case nothing:
      draw.answer().text = "nothing";
      break;
    case wrong_calibration:
      break;  // drawn with the calibration
    case two_effects:
      hide_two_effects(draw);
      break;
    case twins:
      hide_twins(draw);
      break;
    case bad_noise:
      hide_bad_noise(draw);
      break;
    case not_physics:
      hide_not_physics(draw);
      break;
    case real_life:
      hide_real_life(draw);
      break;
  }
  if (draw.answer().text.empty()) draw.answer().text = told(draw.answer());
  return draw.finish();
}

}  // namespace layerloop::validation
