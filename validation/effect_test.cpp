#include "validation/effect_test.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "coupling/layer_loop.hpp"
#include "coupling/melt_study.hpp"
#include "validation/candidates.hpp"

namespace layerloop::validation {
namespace {

using Settings = std::vector<std::string>;

/// What a run gave.
struct Outcome {
  std::string every_number;               ///< of its record, in an order
  std::map<std::string, double> figures;  ///< of its last layer
  double time = 0;                        ///< [s]
};

/// What could be measured of a layer.
std::map<std::string, double> figures_of(Case const& checked, coupling::RunRecord const& record) {
  nlohmann::json const summary = coupling::summary(checked, record, {});
  nlohmann::json const& last = summary.at("layers").back();
  std::map<std::string, double> figures;
  for (char const* name :
       {"volume_fraction_nominal", "effective_thickness", "surface_coverage", "roughness_sa", "settled_density", "d50",
        "absorptivity", "melted_mass", "part_relative_density", "peak_temperature", "start_temperature"})
    if (last.contains(name) && last.at(name).is_number()) figures[name] = last.at(name);
  if (last.contains("pool"))
    for (char const* size : {"width", "depth", "length"})
      if (last.at("pool").contains(size) && last.at("pool").at(size).is_number())
        figures[std::string("pool.") + size] = last.at("pool").at(size);
  return figures;
}

/// The layer loop, or one exposure of a bare plate. \return its numbers and figures
Outcome computed(Case const& checked, std::filesystem::path const& folder, Communicator const& comm) {
  Outcome outcome;
  coupling::RunRecord record;
  if (checked.process == Process::exposing) {
    coupling::MeltOptions options;
    options.folder = folder;
    options.quiet = true;
    coupling::MeltStudy const study = coupling::run_melt(checked, options, comm);
    record = study.build.record;
    for (float const T : study.melted.heat.melt.peak_temperature) outcome.every_number += fmt::format("{} ", T);
  } else {
    coupling::RunOptions options;
    options.folder = folder;
    options.quiet = true;
    record = coupling::run_layer_loop(checked, options, comm);
  }
  nlohmann::json numbers = record;
  numbers.erase("wall_time");
  outcome.every_number += numbers.dump();
  outcome.figures.merge(figures_of(checked, record));
  return outcome;
}

Outcome run(Case const& checked, Communicator const& comm) {
  std::filesystem::path const folder =
      std::filesystem::temp_directory_path() / fmt::format("layerloop-effect-{}", getpid());
  auto const begin = std::chrono::steady_clock::now();
  Outcome outcome = computed(checked, folder, comm);
  outcome.time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (comm.is_root()) std::filesystem::remove_all(folder);
  return outcome;
}

/// Mean and standard error of the mean; 0 for a single value.
struct Mean {
  double value = 0, u = 0;
};
Mean mean_of(std::vector<double> const& values) {
  Mean mean;
  auto const n = static_cast<double>(values.size());
  for (double const v : values) mean.value += v / n;
  for (double const v : values) mean.u += std::pow(v - mean.value, 2);
  mean.u = values.size() > 1 ? std::sqrt(mean.u / (n * (n - 1))) : 0;
  return mean;
}

class EffectTest {
 public:
  EffectTest(Effect const& effect, EffectTrial const& trial, Communicator const& comm)
      : effect_(effect), trial_(trial), comm_(comm), off_(read({})) {
    for (Candidate const& c : candidates_for(everything(), off_))
      if (c.name == effect.name) candidate_ = c;
    if (candidate_.name.empty()) throw std::invalid_argument("the trial of " + effect.name + " does not let it act");
  }

  EffectReport report() {
    EffectReport report;
    Outcome const off = run(off_, comm_), on = run(at(candidate_.prior_scale), comm_);
    null(off, report);
    probes(off, report);
    repeats(on, report);
    report.checks.push_back(
        {"cost", std::nullopt, fmt::format("{:.2f} s without it, {:.2f} s with it", off.time, on.time)});
    return report;
  }

 private:
  /// A study whose quantities see every stage of the trial.
  Study everything() const {
    Study study;
    study.conditions = {{.id = "trial"}};
    char const* const quantity = off_.process == Process::spreading  ? "bed.relative_density"
                                 : off_.process == Process::exposing ? "pool.depth"
                                                                     : "part.relative_density";
    study.observables.push_back({0, quantity});
    return study;
  }

  Case read(Settings settings) const {
    settings.insert(settings.begin(), "effects." + effect_.name + ".enabled=false");
    return trial_.read(settings);
  }
  Case at(double strength) const { return read(settings_of(candidate_, strength, off_)); }

  void null(Outcome const& off, EffectReport& report) const {
    std::string const table = "effects." + effect_.name;
    Outcome const null = run(trial_.read({table + ".enabled=true", table + ".strength=0"}), comm_);
    bool const same = null.every_number == off.every_number;
    report.checks.push_back(
        {"null", same,
         same ? fmt::format("strength 0 leaves {} characters of the run's record as they are", off.every_number.size())
              : "strength 0 changes the run"});
  }

  void probes(Outcome const& first, EffectReport& report) const {
    report.strengths = {0.1 * candidate_.prior_scale, 0.5 * candidate_.prior_scale, candidate_.prior_scale};
    std::map<std::string, std::vector<double>> base;
    std::map<std::string, std::vector<std::vector<double>>> change;  // by strength, seed
    for (int seed = 0; seed < trial_.seeds; ++seed) {
      auto const with_seed = [&](Case checked) {
        checked.seed += static_cast<std::uint64_t>(seed);
        return checked;
      };
      Outcome const off = seed == 0 ? first : run(with_seed(off_), comm_);
      for (auto const& [name, value] : off.figures) base[name].push_back(value);
      for (std::size_t s = 0; s < report.strengths.size(); ++s) {
        Outcome const on = run(with_seed(at(report.strengths[s])), comm_);
        for (auto const& [name, value] : off.figures) {
          if (!on.figures.contains(name)) continue;
          change[name].resize(report.strengths.size());
          change[name][s].push_back(on.figures.at(name) - value);
        }
      }
    }
    for (auto const& [name, by_strength] : change) {
      Mean const before = mean_of(base[name]);
      ProbedFigure figure{name, before.value, before.u, {}, {}};
      for (auto const& by_seed : by_strength) {
        Mean const mean = mean_of(by_seed);
        figure.change.push_back(mean.value);
        figure.u.push_back(mean.u);
      }
      if (figure.change.back() != 0) report.figures.push_back(figure);
    }
    std::ranges::stable_sort(report.figures, std::greater{}, significance);
    judge(report);
  }

  /// Relative change over its scatter from seed to seed, where there is one.
  static double significance(ProbedFigure const& f) {
    double const relative = std::abs(f.change.back() / f.base);
    return f.u.back() > 0 ? std::abs(f.change.back()) / f.u.back() * std::min(1.0, 100 * relative) : relative;
  }

  static void judge(EffectReport& report) {
    if (report.figures.empty()) {
      report.checks.push_back({"probe", false, "nothing that can be measured changes"});
      return;
    }
    ProbedFigure const& f = report.figures.front();
    double const full = f.change[2], half = f.change[1], tenth = f.change[0];
    bool const monotone = std::abs(full) + 2 * std::hypot(f.u[1], f.u[2]) >= std::abs(half) &&
                          half * full >= -4 * f.u[1] * std::abs(full);
    report.checks.push_back(
        {"probe", std::abs(full) > 2 * f.u[2],
         fmt::format("{} {:+.3g} +- {:.2g} on {:.4g} ({:+.2f} %)", f.name, full, f.u[2], f.base, 100 * full / f.base)});
    report.checks.push_back({"monotone", monotone,
                             fmt::format("{} {:+.3g}, {:+.3g}, {:+.3g} at strengths {:g}, {:g}, {:g}", f.name, tenth,
                                         half, full, report.strengths[0], report.strengths[1], report.strengths[2])});
    double const ratio = 10 * tenth / full, u = 10 * f.u[0] / std::abs(full);
    bool const linear = std::abs(ratio - 1) < 2.0 / 3 + 2 * u;
    report.checks.push_back({"derivative", std::nullopt,
                             fmt::format("over a tenth of the probe {:.2f} +- {:.2f} of that over all of it{}", ratio,
                                         u, linear ? "" : ": far from linear, probes must be large")});
  }

  void repeats(Outcome const& on, EffectReport& report) const {
    Case const checked = at(candidate_.prior_scale);
    bool const again = run(checked, comm_).every_number == on.every_number;
    report.checks.push_back({"repeat", again, again ? "the same run twice, to the bit" : "two runs differ"});
    int const threads = omp_get_max_threads(), other = threads == 1 ? 2 : 1;
    omp_set_num_threads(other);
    bool const same = run(checked, comm_).every_number == on.every_number;
    omp_set_num_threads(threads);
    report.checks.push_back(
        {"threads", same, fmt::format("{} and {} threads {}", threads, other, same ? "agree to the bit" : "differ")});
  }

  Effect effect_;
  EffectTrial trial_;
  Communicator const& comm_;
  Case off_;
  Candidate candidate_;
};

}  // namespace

bool EffectReport::passed() const {
  return std::ranges::all_of(checks, [](EffectCheck const& check) { return check.passed.value_or(true); });
}

EffectReport test_effect(Effect const& effect, EffectTrial const& trial, Communicator const& comm) {
  return EffectTest(effect, trial, comm).report();
}

}  // namespace layerloop::validation
