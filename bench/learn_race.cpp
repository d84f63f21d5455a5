// Does a search that learns find the best settings with fewer runs than a Latin hypercube? On an emulated truth: the
// surrogate of runs that were made, plus their noise.
//   learn_race SUMMARY.json maximise|minimise OUTPUT START RUNS SEEDS
// SUMMARY.json: of a sweep or of `learn`. Every seed starts from START runs of a Latin hypercube and adds RUNS; beside
// it stand Latin hypercubes of as many runs in all, of twice and of four times as many. Regret: how far below the top
// of the truth the place lies that the surrogate of the runs calls best.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/write_file.hpp"
#include "coupling/sweep/space_filling.hpp"
#include "validation/largest_null.hpp"
#include "validation/learning/learn_study.hpp"

namespace layerloop::validation {
namespace {

/// The largest of a truth is looked for; where the smallest was wanted, the truth is turned over.
struct Race {
  Surrogate truth;
  InputBox box;
  double top;
};

/// Every case of a summary that gives the output.
std::vector<LearnedRun> trials_of(nlohmann::json const& summary, std::string const& output) {
  std::vector<LearnedRun> trials;
  for (nlohmann::json const& one : summary["cases"]) {
    std::vector<double> settings;
    for (auto const& [key, value] : one["settings"].items()) settings.push_back(value.get<double>());
    double const value = output_of(one, output);
    if (std::isfinite(value))
      trials.push_back({Eigen::Map<Eigen::RowVectorXd const>(settings.data(), std::ssize(settings)), value});
  }
  return trials;
}

Race race_on(std::vector<LearnedRun> const& trials, Goal goal) {
  Surrogate truth = surrogate_of(trials, goal);
  InputBox const box{truth.places().colwise().minCoeff(), truth.places().colwise().maxCoeff()};
  double top = -INFINITY;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) top = std::max(top, truth(highest_mean(truth, box, seed)).mean);
  return {std::move(truth), box, top};
}

double reading(Race const& race, Eigen::RowVectorXd const& place, std::uint64_t seed, std::size_t number) {
  return race.truth(place).mean + race.truth.noise_sd() * standard_normal(1, seed, number)[0];
}

std::vector<LearnedRun> hypercube(Race const& race, std::int64_t runs, std::uint64_t seed) {
  auto const inputs = race.box.low.size();
  std::vector<LearnedRun> trials;
  for (auto const& point : coupling::latin_hypercube(runs, static_cast<std::size_t>(inputs), seed)) {
    Eigen::RowVectorXd const place = race.box.at(Eigen::Map<Eigen::RowVectorXd const>(point.data(), inputs));
    trials.push_back({place, reading(race, place, seed, trials.size())});
  }
  return trials;
}

constexpr Eigen::Index map_places = 400;

struct Verdict {
  double regret, error, map;
};

Verdict verdict_of(Race const& race, std::vector<LearnedRun> const& trials) {
  Surrogate const learnt = surrogate_of(trials, Goal::maximise);
  Eigen::RowVectorXd const place = highest_mean(learnt, race.box, 77);
  double const there = race.truth(place).mean;
  double square = 0;
  Eigen::MatrixXd const all = uniform_places(race.box, map_places, 3);
  for (Eigen::Index i = 0; i < map_places; ++i)
    square += std::pow(learnt(all.row(i)).mean - race.truth(all.row(i)).mean, 2);
  return {race.top - there, std::abs(learnt(place).mean - there), std::sqrt(square / map_places)};
}

double median(std::vector<Verdict> const& verdicts, double Verdict::*figure) {
  std::vector<double> values;
  for (Verdict const& one : verdicts) values.push_back(one.*figure);
  std::ranges::sort(values);
  return values[values.size() / 2];
}

std::string wins(std::vector<Verdict> const& verdicts, std::vector<Verdict> const& other, double Verdict::*figure) {
  double wins = 0;
  for (std::size_t k = 0; k < verdicts.size(); ++k) wins += verdicts[k].*figure < other[k].*figure ? 1 : 0;
  auto const [low, high] = share_interval(wins, static_cast<double>(verdicts.size()));
  return fmt::format("{:3.0f} % ({:.0f} to {:.0f})", 100 * wins / static_cast<double>(verdicts.size()),
                     100 * std::max(0.0, low), 100 * high);
}

void tell(std::string const& name, std::vector<Verdict> const& verdicts, std::vector<Verdict> const& hypercube) {
  fmt::print(
      "{:<31} regret {:.3g}, smaller than the hypercube's in {}; error {:.3g}, smaller in {}; map {:.3g}, smaller in "
      "{}\n",
      name, median(verdicts, &Verdict::regret), wins(verdicts, hypercube, &Verdict::regret),
      median(verdicts, &Verdict::error), wins(verdicts, hypercube, &Verdict::error), median(verdicts, &Verdict::map),
      wins(verdicts, hypercube, &Verdict::map));
}

void run(nlohmann::json const& summary, Goal goal, std::string const& output, std::int64_t start, std::int64_t runs,
         std::uint64_t seeds) {
  Race const race = race_on(trials_of(summary, output), goal);
  double const sign = goal == Goal::minimise ? -1 : 1;
  fmt::print("{}: truth from {} runs, best {:.4g}, noise of a run {:.3g}; {} + {} runs, {} seeds, medians\n", output,
             race.truth.values().size(), sign * race.top, race.truth.noise_sd(), start, runs, seeds);
  std::vector<Verdict> same, twice, four_times;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    same.push_back(verdict_of(race, hypercube(race, start + runs, 5000 + seed)));
    twice.push_back(verdict_of(race, hypercube(race, 2 * (start + runs), 6000 + seed)));
    four_times.push_back(verdict_of(race, hypercube(race, 4 * (start + runs), 7000 + seed)));
  }
  for (Acquisition const acquisition :
       {Acquisition::expected_improvement, Acquisition::upper_confidence_bound, Acquisition::variance}) {
    std::vector<Verdict> verdicts;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      std::vector<LearnedRun> trials = hypercube(race, start, seed);
      LearnPlan const plan{.box = race.box, .acquisition = acquisition, .seed = 1000 * seed};
      learn(trials, plan, runs, [&](Eigen::RowVectorXd const& place) {
        return std::vector<double>{reading(race, place, seed, trials.size())};
      });
      verdicts.push_back(verdict_of(race, trials));
    }
    tell(name_of(acquisition), verdicts, same);
  }
  tell("Latin hypercube", same, same);
  tell("Latin hypercube, twice the runs", twice, same);
  tell("Latin hypercube, four times", four_times, same);
}

}  // namespace
}  // namespace layerloop::validation

int main(int argc, char** argv) {
  using namespace layerloop::validation;
  if (argc != 7) {
    fmt::print(stderr, "learn_race SUMMARY.json maximise|minimise OUTPUT START RUNS SEEDS\n");
    return 2;
  }
  Goal const goal = std::string(argv[2]) == name_of(Goal::minimise) ? Goal::minimise : Goal::maximise;
  run(nlohmann::json::parse(layerloop::read_file(argv[1])), goal, argv[3], std::atoll(argv[4]), std::atoll(argv[5]),
      std::strtoull(argv[6], nullptr, 10));
  return 0;
}
