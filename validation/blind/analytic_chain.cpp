#include "validation/blind/analytic_chain.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "core/error.hpp"

namespace layerloop::validation {
namespace {

using enum EffectStage;
using enum EffectClass;

struct KnownEffect {
  ChainEffect effect;
  Candidate candidate;
};

/// One row an effect.
std::vector<KnownEffect> const& known_effects() {
  using E = ChainEffect;
  static std::vector<KnownEffect> const effects{
      {E::cohesion, {"cohesion", dem, physics, 1, 8}},
      {E::rolling_resistance, {"rolling_resistance", dem, physics, 1, 8}},
      {E::wall_friction, {"wall_friction", dem, physics, 1, 5}},
      {E::wall_cohesion, {"wall_cohesion", dem, physics, 1, 20}},
      {E::capillary_bridge, {"capillary_bridge", dem, physics, 1, 6}},
      {E::electrostatic_charge, {"electrostatic_charge", dem, physics, 1, 6}},
      {E::gas_drag, {"gas_drag", dem, physics, 1, 5}},
      {E::blade_vibration, {"blade_vibration", dem, physics, 1, 20}},
      {E::blade_compliance, {"blade_compliance", dem, physics, 1, 5}},
      {E::surface_oxide, {"surface_oxide", laser, physics, 1, 6}},
      {E::diffuse_scattering, {"diffuse_scattering", laser, physics, 1, 6}},
      {E::optical_temperature, {"optical_temperature", laser, physics, 1, 6}},
      {E::plume_attenuation, {"plume_attenuation", laser, physics, 1, 10}},
      {E::spot_drift, {"spot_drift", laser, physics, 1, 5}},
      {E::marangoni, {"marangoni", heat, physics, 1, 10}},
      {E::latent_heat, {"latent_heat", heat, physics, 0.3, 2, true}},
      {E::variable_conductivity, {"variable_conductivity", heat, physics, 1, 5}},
      {E::evaporation, {"evaporation", heat, physics, 1, 10}},
      {E::keyhole, {"keyhole", heat, physics, 0.5, 10}},
      {E::powder_conductivity, {"powder_conductivity", heat, physics, 1, 4}},
      {E::heat_accumulation, {"heat_accumulation", heat, physics, 1, 4}},
      {E::surface_losses, {"surface_losses", heat, physics, 1, 4}},
      {E::denudation, {"denudation", solid, physics, 0.5, 1.2}},
      {E::shrinkage, {"shrinkage", solid, physics, 1, 3}},
      {E::heat_cell_size, {"heat.cell_size", heat, numerics, 1, 10}},
      {E::youngs_modulus, {"contact.youngs_modulus", dem, numerics, 1, 10}},
  };
  return effects;
}

struct KnownReading {
  std::string quantity;
  EffectStage stage;
  double unit;          ///< of an offset [SI]
  double largest = 10;  ///< of those; a share of the surface must not pass 1
};

std::vector<KnownReading> const& known_readings() {
  static std::vector<KnownReading> const readings{{"pool.width", heat, 4e-6},
                                                  {"pool.depth", heat, 4e-6},
                                                  {"absorptivity", laser, 0.02},
                                                  {"bed.relative_density", dem, 0.02},
                                                  {"bed.surface_coverage", dem, 0.02, 4}};
  return readings;
}

[[noreturn]] void unknown(std::string const& what, std::string const& name) {
  throw InputError("the analytic chain knows no " + what + " \"" + name + "\"");
}

/// "error of laser.power" -> "laser.power"; empty: something else.
std::string after(std::string const& prefix, std::string const& text) {
  return text.starts_with(prefix) ? text.substr(prefix.size()) : "";
}

/// Share of the conditions of its build that came before: the time that the optics had to warm up.
std::vector<double> beam_times(Study const& study) {
  std::map<std::string, double> size, seen;
  auto const build = [](Condition const& condition) {
    auto const label = condition.labels.find("build");
    return label == condition.labels.end() ? std::string() : label->second;
  };
  for (Condition const& condition : study.conditions) size[build(condition)] += 1;
  std::vector<double> times;
  for (Condition const& condition : study.conditions)
    times.push_back(seen[build(condition)]++ / size[build(condition)]);
  return times;
}

}  // namespace

AnalyticChain::AnalyticChain(Study const& study, std::vector<Candidate> const& candidates) {
  std::vector<double> const times = beam_times(study);
  for (Observable const& observable : study.observables) {
    if (!chain_quantity(observable.quantity)) unknown("quantity", observable.quantity);
    ChainInputs inputs;
    for (auto const& [key, value] : study.conditions[observable.condition].inputs)
      if (auto const member = chain_input(key)) inputs.*member = value;
    inputs.layer = observable.layer.value_or(1);
    inputs.beam_time = times[observable.condition];
    quantities_.push_back(observable.quantity);
    conditions_.push_back(observable.condition);
    inputs_.push_back(inputs);
  }
  for (CalibrationParameter const& parameter : study.calibration) {
    if (!chain_input(parameter.key)) unknown("calibration key", parameter.key);
    calibration_.push_back({chain_input(parameter.key), parameter.relative, parameter.acts_on});
  }
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    std::string const& name = candidates[c].name;
    auto const effect = std::ranges::find(known_effects(), name, [](KnownEffect const& e) { return e.candidate.name; });
    if (effect != known_effects().end()) {
      effects_.emplace_back(index(c), effect->effect);
    } else if (auto const member = chain_input(after("error of ", name))) {
      input_errors_.emplace_back(index(c), InputChange{member, true, {}});
    } else {
      std::string const offset = after("offset of ", name),
                        quantity = offset.empty() ? after("scale of ", name) : offset;
      auto const reading = std::ranges::find(known_readings(), quantity, &KnownReading::quantity);
      if (reading == known_readings().end()) unknown("candidate", name);
      readings_.push_back({index(c), quantity, offset.empty(), reading->unit});
    }
  }
}

ChainInputs AnalyticChain::inputs_at(std::size_t observable, ModelPoint const& point) const {
  ChainInputs inputs = inputs_[observable];
  auto const apply = [&](InputChange const& change, double value) {
    if (!change.acts_on.empty() && !change.acts_on[conditions_[observable]]) return;
    double& input = inputs.*change.input;
    input = change.relative ? input * (1 + value) : value;
  };
  for (std::size_t k = 0; k < calibration_.size(); ++k) apply(calibration_[k], point.calibration[index(k)]);
  for (auto const& [candidate, change] : input_errors_) apply(change, point.strengths[candidate]);
  return inputs;
}

Prediction AnalyticChain::predict(ModelPoint const& point) {
  ChainStrengths strengths;
  for (auto const& [candidate, effect] : effects_)
    strengths.values[static_cast<std::size_t>(effect)] = point.strengths[candidate];
  Eigen::Index const n = index(quantities_.size());
  Prediction prediction{Eigen::VectorXd(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  ChainState state;
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    bool const same = i > 0 && conditions_[i] == conditions_[i - 1] && inputs_[i].layer == inputs_[i - 1].layer;
    if (!same) state = chain_state(inputs_at(i, point), strengths);
    double& value = prediction.value[index(i)];
    value = state.*chain_quantity(quantities_[i]);
    for (Reading const& reading : readings_) {
      double const strength = point.strengths[reading.candidate];
      if (strength == 0 || reading.quantity != quantities_[i]) continue;
      value = reading.relative ? value * (1 + strength) : value + strength * reading.unit;
    }
  }
  std::vector<double> inside(point.calibration.begin(), point.calibration.end());
  for (auto const& [candidate, effect] : effects_) inside.push_back(point.strengths[candidate]);
  for (auto const& [candidate, change] : input_errors_) inside.push_back(point.strengths[candidate]);
  computed_.insert(std::move(inside));
  return prediction;
}

std::vector<Candidate> analytic_candidates() {
  std::vector<Candidate> candidates;
  for (KnownEffect const& known : known_effects()) candidates.push_back(known.candidate);
  for (auto const& [key, stage] : {std::pair{"laser.power", laser}, std::pair{"scan.scan_speed", laser}})
    candidates.push_back({std::string("error of ") + key, stage, calibration, 0.05, 0.4, true, "", {}, true});
  for (KnownReading const& known : known_readings()) {
    candidates.push_back(
        {"offset of " + known.quantity, known.stage, instrument, 1, known.largest, true, "", {known.quantity}, true});
    candidates.push_back({"scale of " + known.quantity,
                          known.stage,
                          instrument,
                          0.05,
                          0.025 * known.largest,
                          true,
                          "",
                          {known.quantity},
                          true});
  }
  return candidates;
}

}  // namespace layerloop::validation
