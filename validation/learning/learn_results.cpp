#include "validation/learning/learn_results.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace layerloop::validation {
namespace {

constexpr int slice_points = 41;

/// Outputs of which the models of layers are compared.
std::vector<std::string> const layer_outputs{"surface_coverage",
                                             "volume_fraction_nominal",
                                             "volume_fraction_real",
                                             "effective_thickness",
                                             "real_effective_thickness",
                                             "roughness_sa",
                                             "d50"};
/// What thickness, speed, dose and Bond number of the models of layers stand for.
std::set<std::string> const grouped_keys{"machine.layer_thickness", "machine.recoating_speed", "machine.dose_factor",
                                         "contact.cohesion_energy_density", "contact.surface_energy"};

std::vector<coupling::ShownQuantity> outputs_of(LearnStudy const& study) {
  std::vector<coupling::ShownQuantity> all{study.settings.output};
  for (auto const& list : {coupling::layer_quantities(), coupling::exposure_quantities()})
    for (coupling::ShownQuantity const& quantity : list)
      if (std::ranges::find(all, quantity.key, &coupling::ShownQuantity::key) == all.end()) all.push_back(quantity);
  return all;
}

std::vector<LearnedRun> trials_of(LearnStudy const& study, std::string const& key) {
  std::vector<LearnedRun> trials = study.trials;
  for (std::size_t k = 0; k < trials.size(); ++k) trials[k].value = output_of(study.summaries[k], key);
  std::erase_if(trials, [](LearnedRun const& trial) { return !std::isfinite(trial.value); });
  return trials;
}

/// By more than rounding.
bool vary(std::vector<LearnedRun> const& trials) {
  auto const [least, most] = std::ranges::minmax(trials, {}, &LearnedRun::value);
  return most.value - least.value > 1e-9 * std::max(std::abs(most.value), std::abs(least.value));
}

std::vector<OutputSkill> surrogates_of(LearnStudy const& study) {
  std::vector<OutputSkill> all;
  for (coupling::ShownQuantity const& output : outputs_of(study)) {
    std::vector<LearnedRun> const trials = trials_of(study, output.key);
    if (trials.size() < 3 || !vary(trials)) continue;
    Surrogate const surrogate = surrogate_of(trials, Goal::know);
    all.push_back({output, skill_of(surrogate.values(), surrogate.left_out(groups_of(surrogate.places()))),
                   surrogate.noise_sd()});
  }
  return all;
}

std::vector<LayerSkill> layer_models_of(LearnStudy const& study) {
  std::vector<LayeredRun> runs;
  for (std::size_t k = 0; k < study.summaries.size(); ++k) {
    nlohmann::json const& summary = study.summaries[k];
    if (!summary.is_object() || !summary.contains("layers") || summary["layers"].size() < 2) continue;
    coupling::SweepCase const& one = study.plan.cases[k];
    LayeredRun run{.point = one.point, .checked = &one.checked, .layers = &summary["layers"]};
    for (std::size_t d = 0; d < study.plan.keys.size(); ++d)
      if (!grouped_keys.contains(study.plan.keys[d].name)) run.others.push_back(one.values[d].value);
    runs.push_back(std::move(run));
  }
  return runs.size() < 3 ? std::vector<LayerSkill>{} : compare_layer_models(runs, layer_outputs);
}

/// \param cases  the first so many
Believed believed_after(LearnStudy const& study, std::size_t cases) {
  std::vector<LearnedRun> trials(study.trials.begin(), study.trials.begin() + static_cast<std::ptrdiff_t>(cases));
  double const sign = study.settings.goal == Goal::minimise ? -1 : 1;
  Believed found{.cases = cases, .points = study.plan.cases[cases - 1].point + 1, .best = -INFINITY, .optimum = {}};
  for (LearnedRun const& trial : trials)
    if (std::isfinite(trial.value)) found.best = std::max(found.best, sign * trial.value);
  found.best *= sign;
  Surrogate const surrogate = surrogate_of(trials, study.settings.goal);
  trials.insert(trials.end(), study.refused.begin(), study.refused.end());
  found.optimum = surrogate(highest_mean(surrogate, study.box, study.settings.seed, runnable(trials, study.box)));
  found.optimum.mean *= sign;
  return found;
}

Slice slice_along(Eigen::Index key, Surrogate const& surrogate, InputBox const& box, Eigen::RowVectorXd place) {
  Slice slice;
  for (int i = 0; i < slice_points; ++i) {
    place[key] = std::lerp(box.low[key], box.high[key], i / (slice_points - 1.0));
    Estimate const at = surrogate(place);
    slice.x.push_back(place[key]);
    slice.mean.push_back(at.mean);
    slice.sd.push_back(at.sd);
  }
  return slice;
}

}  // namespace

LearnResults results_of(LearnStudy const& study) {
  LearnResults found;
  for (std::size_t k = 0; k < study.trials.size(); ++k)
    if (std::isfinite(study.trials[k].value)) found.used.push_back(k);
  Surrogate const surrogate = surrogate_of(study.trials, Goal::know);
  found.values = surrogate.values();
  found.left_out = surrogate.left_out(groups_of(surrogate.places()));
  found.optimum = optimum_of(study.known(), study.search());
  found.surrogates = surrogates_of(study);
  found.layer_models = layer_models_of(study);
  auto const seeds = static_cast<std::size_t>(study.plan.replicates);
  for (std::size_t points = study.start; points <= study.plan.points; ++points)
    found.history.push_back(believed_after(study, points * seeds));
  for (Eigen::Index key = 0; key < study.box.low.size(); ++key)
    found.slices.push_back(slice_along(key, surrogate, study.box, found.optimum.place));
  return found;
}

}  // namespace layerloop::validation
