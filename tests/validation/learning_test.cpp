// Surrogates, acquisition and the search for an optimum against closed forms and functions whose top is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "coupling/sweep/space_filling.hpp"
#include "validation/largest_null.hpp"
#include "validation/learning/layer_models.hpp"
#include "validation/learning/learner.hpp"

namespace layerloop::validation {
namespace {

InputBox unit_box(Eigen::Index inputs) { return {Eigen::RowVectorXd::Zero(inputs), Eigen::RowVectorXd::Ones(inputs)}; }

/// The design of a sweep.
Eigen::MatrixXd latin_hypercube(Eigen::Index n, Eigen::Index inputs, std::uint64_t seed) {
  coupling::UnitPoints const points = coupling::latin_hypercube(n, static_cast<std::size_t>(inputs), seed);
  Eigen::MatrixXd places(n, inputs);
  for (Eigen::Index i = 0; i < n; ++i)
    places.row(i) = Eigen::Map<Eigen::RowVectorXd const>(points[static_cast<std::size_t>(i)].data(), inputs);
  return places;
}

double branin(Eigen::RowVectorXd const& u) {  // of the unit square; smallest 0.397887 in three places
  double const x = 15 * u[0] - 5, y = 15 * u[1], pi = std::numbers::pi;
  return std::pow(y - 5.1 / (4 * pi * pi) * x * x + 5 / pi * x - 6, 2) + 10 * (1 - 1 / (8 * pi)) * std::cos(x) + 10;
}

double hartmann3(Eigen::RowVectorXd const& u) {  // largest 3.86278 at (0.1146, 0.5556, 0.8525)
  Eigen::Matrix<double, 4, 3> a, p;
  a << 3, 10, 30, 0.1, 10, 35, 3, 10, 30, 0.1, 10, 35;
  p << 0.3689, 0.1170, 0.2673, 0.4699, 0.4387, 0.7470, 0.1091, 0.8732, 0.5547, 0.0381, 0.5743, 0.8828;
  Eigen::Vector4d const weight(1, 1.2, 3, 3.2);
  double sum = 0;
  for (Eigen::Index i = 0; i < 4; ++i)
    sum += weight[i] * std::exp(-(a.row(i).array() * (u - p.row(i)).array().square()).sum());
  return sum;
}

struct Problem {
  char const* name;
  Eigen::Index inputs;
  double (*function)(Eigen::RowVectorXd const&);
  double top;    ///< largest value
  double noise;  ///< standard deviation of a run
  int start, runs;
};

/// How far below the top the place lies that the surrogate calls best.
double regret(std::vector<LearnedRun> const& trials, Problem const& problem, std::uint64_t seed) {
  return problem.top -
         problem.function(highest_mean(surrogate_of(trials, Goal::maximise), unit_box(problem.inputs), 7000 + seed));
}

std::vector<LearnedRun> run_all(Eigen::MatrixXd const& places, Problem const& problem, std::uint64_t seed) {
  std::vector<LearnedRun> trials;
  for (Eigen::Index i = 0; i < places.rows(); ++i)
    trials.push_back({places.row(i), problem.function(places.row(i)) +
                                         problem.noise * standard_normal(1, seed, static_cast<std::uint64_t>(i))[0]});
  return trials;
}

struct Race {
  int wins = 0;
  std::vector<double> active, passive;
};

/// Equal numbers of runs, the same surrogate at the end: only where the runs are differs.
Race race(Problem const& problem, Acquisition acquisition, int seeds) {
  Race found;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
    std::vector<LearnedRun> active = run_all(latin_hypercube(problem.start, problem.inputs, seed), problem, 100 + seed);
    LearnPlan const plan{.box = unit_box(problem.inputs), .acquisition = acquisition, .seed = 1000 * seed};
    learn(active, plan, problem.runs, [&](Eigen::RowVectorXd const& place) {
      double const noise = problem.noise * standard_normal(1, 100 + seed, active.size())[0];
      return std::vector<double>{problem.function(place) + noise};
    });
    std::vector<LearnedRun> const passive =
        run_all(latin_hypercube(problem.start + problem.runs, problem.inputs, 500 + seed), problem, 300 + seed);
    found.active.push_back(regret(active, problem, seed));
    found.passive.push_back(regret(passive, problem, seed));
    found.wins += found.active.back() < found.passive.back();
  }
  return found;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

TEST(Surrogate, finds_the_noise_that_replicates_show) {
  Eigen::MatrixXd const base = latin_hypercube(8, 2, 3);
  double const noise = 0.3;
  Eigen::MatrixXd places(32, 2);
  Eigen::VectorXd values = noise * standard_normal(32, 5, 0);
  double pooled = 0;
  for (Eigen::Index i = 0; i < 8; ++i) {
    for (Eigen::Index k = 0; k < 4; ++k) places.row(4 * i + k) = base.row(i);
    auto const own = values.segment<4>(4 * i).array();
    pooled += (own - own.mean()).square().sum() / 24;
    values.segment<4>(4 * i).array() += std::sin(4 * base(i, 0)) + base(i, 1);
  }
  // 24 degrees of freedom tell a standard deviation to 14 %: prior and function may not move it further than that.
  EXPECT_NEAR(Surrogate(places, values).noise_sd() / std::sqrt(pooled), 1, 0.14);
}

TEST(Surrogate, learns_its_kernel_from_some_of_many_rows_and_predicts_from_all) {
  Eigen::MatrixXd const places = uniform_places(unit_box(1), 700, 4);
  Eigen::VectorXd const values = (6 * places.array()).sin().matrix() + 0.1 * standard_normal(700, 9, 0);
  Surrogate const surrogate(places, values);
  EXPECT_NEAR(surrogate.noise_sd(), 0.1, 0.012);  // of 300 rows: known to 4 %, three times that
  Estimate const at = surrogate(Eigen::RowVectorXd::Constant(1, 0.5));
  EXPECT_NEAR(at.mean, std::sin(3), 3 * at.sd);
  EXPECT_LT(at.sd, 0.02);
}

TEST(Surrogate, knows_how_well_it_predicts_what_was_left_out) {
  // Functions drawn from a known process, read with noise: 95 % intervals must hold 95 %.
  double hits = 0, n = 0, excess = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Eigen::MatrixXd const places = latin_hypercube(30, 2, seed);
    Eigen::MatrixXd const covariance = Matern{1, Eigen::Vector2d(0.5, 1)}(places, places);
    Eigen::VectorXd const values =
        Eigen::MatrixXd(covariance.llt().matrixL()) * standard_normal(30, seed, 0) + 0.1 * standard_normal(30, seed, 1);
    Surrogate const surrogate(10 * places, 7 + 2 * values.array());
    Skill const skill = skill_of(surrogate.values(), surrogate.left_out(groups_of(surrogate.places())));
    hits += skill.coverage * 30, n += 30;
    excess += 1 - skill.q2;
  }
  auto const [low, high] = share_interval(hits, n);
  EXPECT_LT(low, 0.95);
  EXPECT_GT(high, 0.92);  // the kernel comes from the same values: a little too sure of itself
  EXPECT_LT(excess / 30, 0.5);
}

/// Runs of three layers whose outputs are known functions.
struct LayeredRuns {
  std::vector<Case> cases;
  std::vector<nlohmann::json> layers;
  std::vector<LayeredRun> runs;

  LayeredRuns() {
    Eigen::MatrixXd const at = latin_hypercube(25, 3, 7);
    Eigen::VectorXd const luck = standard_normal(25, 8, 0);
    for (Eigen::Index i = 0; i < 25; ++i) {
      Case& of = cases.emplace_back();
      of.powder = {.material = "IN718", .diameters = {30e-6}, .fractions = {1}};
      of.machine.layer_thickness = 30e-6 + 40e-6 * at(i, 0);
      of.machine.recoating_speed = 0.04 + 0.08 * at(i, 1);
      of.machine.dose_factor = 1 + at(i, 2);
      nlohmann::json all = nlohmann::json::array();
      double below = 0;
      for (int n = 1; n <= 3; ++n) {
        double const void_layer = of.machine.layer_thickness * (1 + 0.3 * n * at(i, 1));
        double const roughness = 1e-6 * (5 + 3 * n * at(i, 0));
        all.push_back({{"bond_number", 0.5},
                       {"effective_thickness", 0.0},
                       {"roughness_sa", roughness},
                       {"void_layer", void_layer},
                       {"of_state", 1e5 * void_layer + std::sin(2e5 * below)},
                       {"of_settings", at(i, 1) * at(i, 1) + at(i, 2) + 0.3 * n},
                       {"of_luck", luck[i]}});
        below = roughness;
      }
      layers.push_back(all);
    }
    for (std::size_t i = 0; i < 25; ++i) runs.push_back({.point = i, .checked = &cases[i], .layers = &layers[i]});
  }
};

TEST(LayerModels, each_predicts_what_depends_on_its_inputs_and_none_what_only_the_run_knows) {
  LayeredRuns const sample;
  for (LayerSkill const& skill : compare_layer_models(sample.runs, {"of_state", "of_settings", "of_luck"})) {
    bool const by_settings = skill.model == LayerModel::settings || skill.model == LayerModel::settings_and_layer;
    double const q2 = skill.all.n > 0 ? skill.all.q2 : skill.last.q2;
    if (skill.output == "of_state" && skill.model == LayerModel::layer_wise) {
      EXPECT_GT(q2, 0.99);
    }
    if (skill.output == "of_settings" && by_settings) {
      EXPECT_GT(q2, 0.95) << words_of(skill.model);
    }
    if (skill.output == "of_settings" && skill.model == LayerModel::layer_wise) {
      EXPECT_LT(q2, 0.7);
    }
    // Layers of one run share their luck: whoever leaves out layers instead of runs would "predict" it.
    if (skill.output == "of_luck") {
      EXPECT_LT(q2, 0.2) << words_of(skill.model);
    }
  }
}

TEST(Acquisition, expected_improvement_is_the_integral_over_the_gain) {
  for (double const mean : {-9.0, -3.0, 0.0, 0.7, 2.0}) {
    Estimate const at{mean, 0.8};
    double const best = 0.5;
    double integral = 0;
    double const step = 1e-4;
    for (double gain = step / 2; gain < 9; gain += step)
      integral += gain * step / (at.sd * std::sqrt(2 * std::numbers::pi)) *
                  std::exp(-0.5 * std::pow((best + gain - mean) / at.sd, 2));
    EXPECT_NEAR(log_expected_improvement(at, best) / std::log(integral), 1, mean < -8 ? 1e-3 : 1e-6) << mean;
  }
}

TEST(Learning, leaves_a_region_where_runs_fail) {
  // Rises to the right, but beyond 0.7 no run succeeds: the best that can be run is just before.
  std::vector<LearnedRun> trials;
  for (double const x : {0.1, 0.3, 0.55, 0.9})
    trials.push_back({Eigen::RowVectorXd::Constant(1, x), x > 0.7 ? NAN : x});
  learn(trials, {.box = unit_box(1)}, 12,
        [](Eigen::RowVectorXd const& place) { return std::vector<double>{place[0] > 0.7 ? NAN : place[0]}; });
  double best = 0;
  int failed = 0;
  for (LearnedRun const& trial : trials) std::isfinite(trial.value) ? best = std::max(best, trial.value) : failed += 1;
  EXPECT_GT(best, 0.65);
  EXPECT_LE(failed, 8);
}

TEST(Learning, takes_no_exact_reading_twice) {
  // A flat top, where a search that believes in noise reads again and again.
  for (Readings const readings : {Readings::noisy, Readings::exact}) {
    std::vector<LearnedRun> trials;
    auto const top = [](Eigen::RowVectorXd const& place) { return std::vector<double>{-std::pow(place[0] - 0.5, 4)}; };
    for (double const x : {0.0, 0.3, 0.5, 0.7, 1.0})
      trials.push_back({Eigen::RowVectorXd::Constant(1, x), top(Eigen::RowVectorXd::Constant(1, x)).front()});
    learn(trials, {.box = unit_box(1), .readings = readings}, 8, top);
    double nearest = 1;
    for (std::size_t i = 0; i < trials.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        nearest = std::min(nearest, std::abs(trials[i].place[0] - trials[k].place[0]));
    EXPECT_EQ(nearest < 0.001, readings == Readings::noisy) << nearest;
  }
}

TEST(Optimum, lies_where_runs_do_not_fail) {
  // Grows with the input as far as runs succeed; the nearest that failed lies twice as far.
  std::vector<LearnedRun> trials;
  for (double const x : {0.05, 0.1, 0.15, 0.2, 0.3, 0.6, 0.8, 1.0})
    trials.push_back({Eigen::RowVectorXd::Constant(1, x), x > 0.3 ? NAN : x});
  Optimum const found = optimum_of(trials, {.box = unit_box(1), .seed = 7});
  EXPECT_LE(found.place_high[0], 0.45);
  EXPECT_GT(found.place[0], 0.4);
  EXPECT_NEAR(found.value.mean, found.place[0], 3 * found.value.sd);
  EXPECT_LT(found.value_high, 0.6);
  trials.push_back({Eigen::RowVectorXd::Constant(1, 0.6), 0.6});  // another seed succeeds
  EXPECT_GT(optimum_of(trials, {.box = unit_box(1), .seed = 7}).place[0], 0.6);
}

TEST(Optimum, intervals_hold_the_true_top) {
  // Functions drawn from a known process and read with noise: 95 % intervals of place and value must hold the truth.
  int place_hits = 0, value_hits = 0, seeds = 40;
  Eigen::Index const grid = 200, runs = 20;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
    Eigen::MatrixXd places(grid + runs, 1);
    places << Eigen::VectorXd::LinSpaced(grid, 0, 1), latin_hypercube(runs, 1, seed);
    Eigen::MatrixXd covariance = Matern{1, Eigen::VectorXd::Constant(1, 0.4)}(places, places);
    covariance.diagonal().array() += 1e-9;
    Eigen::VectorXd const function = covariance.llt().matrixL() * standard_normal(grid + runs, seed, 0);
    Eigen::VectorXd const noise = 0.1 * standard_normal(runs, seed, 1);
    std::vector<LearnedRun> trials;
    for (Eigen::Index i = 0; i < runs; ++i) trials.push_back({places.row(grid + i), function[grid + i] + noise[i]});
    Optimum const found = find_optimum(surrogate_of(trials, Goal::maximise), unit_box(1), 7000 + seed);
    Eigen::Index at = 0;
    double const value = function.head(grid).maxCoeff(&at);
    place_hits += found.place_low[0] - 0.003 <= places(at, 0) && places(at, 0) <= found.place_high[0] + 0.003;  // grid
    value_hits += found.value_low <= value && value <= found.value_high;
  }
  EXPECT_GT(share_interval(place_hits, seeds).second, 0.95) << place_hits;
  EXPECT_GT(share_interval(value_hits, seeds).second, 0.95) << value_hits;
}

TEST(Optimum, says_that_an_input_does_not_matter_where_the_top_lies_on_a_limit) {
  // Falls with the first input, whose best is its lower limit; the second does nothing.
  Problem const slope{"slope", 2, [](Eigen::RowVectorXd const& u) { return 1 - u[0]; }, 1, 0.02, 20, 0};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::vector<LearnedRun> const trials = run_all(latin_hypercube(20, 2, seed), slope, seed);
    Optimum const found = find_optimum(surrogate_of(trials, Goal::maximise), unit_box(2), 7000 + seed);
    EXPECT_LT(found.place_high[0], 0.1);
    EXPECT_GT(found.place_high[1] - found.place_low[1], 0.3) << found.place_low[1] << " to " << found.place_high[1];
  }
}

TEST(Learning, active_runs_beat_a_latin_hypercube_of_as_many) {
  Problem const problems[] = {
      {"branin", 2, [](Eigen::RowVectorXd const& u) { return -branin(u); }, -0.397887, 1.0, 8, 12},
      {"hartmann3", 3, hartmann3, 3.86278, 0.05, 10, 15}};
  for (Problem const& problem : problems)
    for (Acquisition const acquisition : {Acquisition::expected_improvement, Acquisition::upper_confidence_bound}) {
      int const seeds = 20;
      Race const found = race(problem, acquisition, seeds);
      EXPECT_GT(share_interval(found.wins, seeds).first, 0.5) << problem.name << ": " << found.wins;
      EXPECT_LT(median(found.active), 0.5 * median(found.passive)) << problem.name;
    }
}

}  // namespace
}  // namespace layerloop::validation
