#include "validation/candidates.hpp"

#include <algorithm>
#include <set>

#include "core/modifier.hpp"
#include "core/optical_constants.hpp"
#include "core/user_effect.hpp"
#include "validation/held_strength.hpp"

namespace layerloop::validation {
namespace {

/// What of the layer loop stands behind a study's quantities.
struct Reach {
  bool grains = false;    ///< grains move
  bool recoater = false;  ///< and are spread
  bool light = false;     ///< falls on metal
  bool traced = false;    ///< by rays, not by a given absorptivity
  bool heat = false;
  bool powder = false;  ///< lies under the beam
  bool layers = false;  ///< one is made on another
};

bool any_starts_with(std::set<std::string> const& names, char const* prefix) {
  return std::ranges::any_of(names, [&](std::string const& name) { return name.starts_with(prefix); });
}

std::set<std::string> quantities_of(Study const& study) {
  std::set<std::string> names;
  for (Observable const& observable : study.observables) names.insert(observable.quantity);
  return names;
}

/// Whether some condition, or else the case, has this word for a key.
bool says(Study const& study, std::string const& key, std::string const& word, bool base_says) {
  return std::ranges::any_of(study.conditions, [&](Condition const& condition) {
    auto const own = condition.words.find(key);
    return own == condition.words.end() ? base_says : own->second == word;
  });
}

/// Whether an input of some condition, or a number that is calibrated, stands in for one of the case.
bool is_given(Study const& study, std::string const& key) {
  return std::ranges::any_of(study.conditions, [&](Condition const& c) { return c.inputs.contains(key); }) ||
         std::ranges::any_of(study.calibration, [&](CalibrationParameter const& p) { return p.key == key; });
}

Reach reach_of(Study const& study, Case const& base) {
  std::set<std::string> const names = quantities_of(study);
  bool const part = any_starts_with(names, "part."), absorbs = names.contains("absorptivity");
  bool const melts = any_starts_with(names, "pool.") || any_starts_with(names, "track.") || part ||
                     (absorbs && base.scan.scan_speed > 0);
  bool const automatic_bed = base.melt.bed == MeltedBed::automatic && base.machine.deposition_length > 0;
  bool const spread_to_melt =
      melts && (part || says(study, "melt.bed", "spread", base.melt.bed == MeltedBed::spread || automatic_bed));
  bool const spread_to_absorb =
      absorbs && !melts && says(study, "absorb.bed", "spread", base.absorb.bed == AbsorbingBed::spread);
  bool const settled =
      absorbs && !melts && says(study, "absorb.bed", "settled", base.absorb.bed == AbsorbingBed::settled);
  Reach reach;
  reach.recoater =
      any_starts_with(names, "bed.") || any_starts_with(names, "heap.") || spread_to_melt || spread_to_absorb;
  reach.grains = reach.recoater || settled || any_starts_with(names, "pile.") || any_starts_with(names, "plate.");
  reach.light = melts || absorbs;
  reach.traced = reach.light && !base.laser.absorptivity && !is_given(study, "laser.absorptivity");
  reach.heat = melts;
  reach.powder = spread_to_melt || (melts && says(study, "melt.bed", "file", base.melt.bed == MeltedBed::file)) ||
                 (absorbs && !melts);
  reach.layers = part;
  return reach;
}

std::string not_seen(EffectStage stage) {
  switch (stage) {
    case EffectStage::dem:
      return "no quantity of the study comes from grains that move";
    case EffectStage::laser:
      return "no quantity of the study depends on light";
    case EffectStage::heat:
      return "no quantity of the study depends on heat";
    case EffectStage::solid:
      return "no quantity of the study depends on a layer below";
  }
  return {};
}

bool sees(Reach const& reach, EffectStage stage) {
  switch (stage) {
    case EffectStage::dem:
      return reach.grains;
    case EffectStage::laser:
      return reach.light;
    case EffectStage::heat:
      return reach.heat;
    case EffectStage::solid:
      return reach.layers;
  }
  return false;
}

std::string why_not_grains(Effect const& effect, Reach const& reach, Case const& base) {
  bool const cohesive = base.contact.cohesion != Cohesion::none && base.effect_strength("cohesion") > 0;
  if (effect.name.starts_with("blade_") && !reach.recoater) return "no quantity of the study comes from a spread bed";
  if (effect.name == "wall_cohesion" && !cohesive)
    return "it is a share of the cohesion between grains, and there is none";
  if (effect.name == "blade_vibration" && base.machine.blade_clearance == 0)
    return "the recoater would strike the platforms: machine.blade_clearance is 0";
  return {};
}

std::string why_not_light(Effect const& effect, Reach const& reach, Case const& base) {
  std::string const& name = effect.name;
  if (name == "plume_attenuation")
    return base.effect_strength("evaporation") > 0 ? "" : "nothing evaporates: the case has evaporation switched off";
  if (name == "spot_drift") return reach.layers ? "" : "the beam is on for too short a time";
  if (!reach.traced) return "laser.absorptivity is given as a number, so that no light is traced";
  if (base.optics.grey_reflectance) return "optics.grey_reflectance is given as a number";
  std::string const& data = base.material.optical_data;
  if (name == "surface_oxide" && !base.optics.oxide_index && oxide_data_name(data).empty())
    return "no oxide of the metal is known: give optics.oxide_index";
  if (name == "optical_temperature" && (!free_electrons(data) || base.material.conductivity.value.empty()))
    return "how the index of the metal changes with temperature is not known";
  if (name == "diffuse_scattering" && !reach.powder && base.effect_strength("keyhole") == 0)
    return "light that leaves a flat plate does not come back, however it is scattered";
  return {};
}

std::string why_not_heat(Effect const& effect, Reach const& reach, Case const& base) {
  std::string const& name = effect.name;
  if (name == "powder_conductivity" && !reach.powder) return "no powder lies under the beam";
  if (name == "heat_accumulation") {
    bool const earlier = effect_parameter(base.effects, name, "earlier_layers") > 0 &&
                         effect_parameter(base.effects, name, "layer_energy") > 0;
    if (!reach.layers && !earlier) return "no layer of the study is made after another";
    if (base.scan.hatch_spacing == 0) return "scan.hatch_spacing is not given";
  }
  return {};
}

/// What a loaded library does to readings; null where it is none of that.
ReadingEffect const* reading_effect(std::string const& name) {
  bool const of_library = std::ranges::find(user_effects(), name, &Effect::name) != user_effects().end();
  return of_library ? dynamic_cast<ReadingEffect const*>(&user_effect(name)) : nullptr;
}

/// Whether the case has the effect on and what it acts with.
bool is_in(Effect const& effect, Case const& base) {
  std::string const& name = effect.name;
  if (name == "blade_compliance" && base.machine.recoater == RecoaterKind::compliant_blade) return true;
  if (base.effect_strength(name) == 0) return false;
  if (name == "cohesion" || name == "wall_cohesion") return base.contact.cohesion != Cohesion::none;
  if (name == "rolling_resistance") return base.contact.rolling_friction > 0;
  if (name == "wall_friction") return base.contact.wall_friction != base.contact.sliding_friction;
  if (name == "surface_oxide") return base.optics.oxide_thickness > 0;
  if (name == "diffuse_scattering") return base.optics.diffuse_share > 0;
  if (name == "optical_temperature") return base.optics.temperature != 300;
  return true;
}

bool has_all_of_it(Effect const& effect, Case const& base) {
  double const strength = base.effect_strength(effect.name);
  if (effect.name == "diffuse_scattering") return base.optics.diffuse_share * strength >= 1;
  return is_in(effect, base) && strength >= effect.largest_strength;
}

/// Empty: it can be tested.
std::string why_not(Effect const& effect, Reach const& reach, Case const& base) {
  if (reading_effect(effect.name)) return {};
  if (!sees(reach, effect.stage)) return not_seen(effect.stage);
  if (has_all_of_it(effect, base)) return "the case has all of it already";
  switch (effect.stage) {
    case EffectStage::dem:
      return why_not_grains(effect, reach, base);
    case EffectStage::laser:
      return why_not_light(effect, reach, base);
    case EffectStage::heat:
      return why_not_heat(effect, reach, base);
    case EffectStage::solid:
      return effect.name == "shrinkage" && base.material.liquid_density.value.empty()
                 ? "how dense the liquid is is not known: give material.NAME.liquid_density"
                 : "";
  }
  return {};
}

Candidate candidate_of(Effect const& effect, Case const& base) {
  Candidate c{effect.name, effect.stage,   effect.kind, effect.prior_scale, effect.largest_strength,
              false,       effect.sentence};
  if (is_in(effect, base)) {
    double const held = held_strength(effect, base);
    if (effect.kind == EffectClass::physics) c.kind = EffectClass::calibration;
    c.two_sided = true;
    c.largest = std::min(held, effect.largest_strength - held);
  }
  if (effect.name == "wall_friction" && !is_in(effect, base)) {
    c.two_sided = true;  // walls may be smoother than grains
    c.largest = 1;
  }
  if (effect.name == "diffuse_scattering")
    c.largest = 1 - base.optics.diffuse_share * base.effect_strength(effect.name);
  if (effect.name == "blade_vibration")
    c.largest = std::min(c.largest,
                         base.machine.blade_clearance / effect_parameter(base.effects, "blade_vibration", "amplitude"));
  c.prior_scale = std::min(c.prior_scale, c.largest);
  if (ReadingEffect const* const reading = reading_effect(effect.name)) c.quantities = reading->quantities();
  return c;
}

/// Effects that the case writes as formulas.
std::vector<Candidate> modifiers(Case const& base, Reach const& reach) {
  std::vector<Candidate> all;
  for (auto const& [name, modifier] : base.modifiers) {
    if (!reach.heat) continue;
    double const held = modifier.enabled ? modifier.strength : 0;
    Candidate c{name,
                stage_of_target(modifier.target),
                EffectClass::physics,
                modifier.prior_scale,
                modifier.largest_strength,
                false,
                modifier.target + " = " + modifier.expression};
    if (held != 0) {
      c.kind = EffectClass::calibration;
      c.two_sided = true;
    }
    all.push_back(c);
  }
  return all;
}

std::vector<Candidate> numerics(Reach const& reach) {
  using enum EffectStage;
  using enum EffectClass;
  std::vector<Candidate> all;
  if (reach.grains) {
    all.push_back(
        {"contact.youngs_modulus", dem, numerics, 1, 4, true,
         "Stiffness of the grains, softened for speed; strength 1: twice as stiff, at the same pull-off force."});
    all.push_back({"contact.time_step_fraction", dem, numerics, 1, 3, false,
                   "Time step of the grains; strength 1: 0.7 times as long."});
  }
  if (reach.traced && reach.heat)
    all.push_back({"optics.rays", laser, numerics, 1, 3, false, "Number of rays; strength 1: four times as many."});
  if (reach.heat)
    all.push_back({"heat.cell_size", heat, numerics, 1, 2, true,
                   "Cells of the heat grid; strength 1: 1.5 times as large, -1: 1.5 times finer."});
  return all;
}

/// Common errors of what power, speed and spot are known by, where the study does not let them vary already.
std::vector<Candidate> input_errors(Study const& study, Case const& base, Reach const& reach) {
  struct Input {
    char const* key;
    double prior_scale;
    char const* sentence;
    bool acts;
  };
  bool const has_spot = base.laser.profile != SpotProfile::file;
  bool const has_speed = base.scan.kind != ScanKind::file;
  std::vector<Candidate> all;
  for (Input const& input : {
           Input{"laser.power", 0.05, "All powers are off by a factor 1 + strength.", reach.heat},
           Input{"laser.spot_diameter", 0.1, "All spots are off by a factor 1 + strength.", reach.heat && has_spot},
           Input{"scan.scan_speed", 0.05, "All scan speeds are off by a factor 1 + strength.", reach.heat && has_speed},
       }) {
    bool const calibrated = std::ranges::any_of(study.calibration, [&](auto const& p) { return p.key == input.key; });
    if (input.acts && !calibrated)
      all.push_back({input.key,
                     input.key[0] == 's' ? EffectStage::heat : EffectStage::laser,
                     EffectClass::calibration,
                     input.prior_scale,
                     0.5,
                     true,
                     input.sentence,
                     {},
                     true});
  }
  return all;
}

std::map<std::string, double> parameters_of(std::string const& effect) {
  std::map<std::string, double> values;
  auto const row = std::ranges::find(effect_catalogue(), effect, &Effect::name);
  for (EffectParameter const& p : row->parameters) values[p.name] = effect_parameter({}, effect, p.name);
  return values;
}

EffectStage stage_of(std::string const& quantity) {
  if (quantity == "absorptivity") return EffectStage::laser;
  if (quantity.starts_with("pool.") || quantity.starts_with("track.")) return EffectStage::heat;
  return quantity.starts_with("part.") ? EffectStage::solid : EffectStage::dem;
}

/// What an instrument may be off by, in the quantity's own unit, and in words.
struct Offset {
  double unit;
  char const* words;
};
Offset offset_of(std::string const& quantity) {
  if (quantity.find("angle") != std::string::npos) return {0.01745329251994329577, "1 degree"};
  if (quantity == "absorptivity" || quantity.find("density") != std::string::npos ||
      quantity.find("coverage") != std::string::npos)
    return {0.02, "0.02"};
  return {4e-6, "4 um"};
}

constexpr double scale_unit = 0.05;
constexpr char const *offset_name = "offset of ", *scale_name = "scale of ";

std::vector<Candidate> instruments(Study const& study) {
  std::vector<Candidate> all;
  for (std::string const& quantity : quantities_of(study)) {
    if (quantity == "track.regime") continue;
    for (bool const offset : {true, false}) {
      std::string const size = offset ? offset_of(quantity).words : "5 %";
      all.push_back({(offset ? offset_name : scale_name) + quantity,
                     stage_of(quantity),
                     EffectClass::instrument,
                     1,
                     10,
                     true,
                     quantity + " is read too high by strength times " + size + ".",
                     {quantity},
                     true});
    }
  }
  return all;
}

}  // namespace

std::vector<Candidate> candidates_for(Study const& study, Case const& base) {
  Reach const reach = reach_of(study, base);
  std::vector<Candidate> all;
  for (Effect const& effect : effect_catalogue())
    if (why_not(effect, reach, base).empty()) all.push_back(candidate_of(effect, base));
  for (auto const& more :
       {modifiers(base, reach), numerics(reach), input_errors(study, base, reach), instruments(study)})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::vector<Untestable> untestable_effects(Study const& study, Case const& base) {
  Reach const reach = reach_of(study, base);
  std::vector<Untestable> all;
  for (Effect const& effect : effect_catalogue())
    if (std::string const why = why_not(effect, reach, base); !why.empty()) all.push_back({effect.name, why});
  return all;
}

void apply_instruments(Study const& study, std::vector<Candidate> const& candidates, Eigen::VectorXd const& strengths,
                       Eigen::VectorXd& values) {
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    Candidate const& candidate = candidates[c];
    double const strength = strengths[static_cast<Eigen::Index>(c)];
    if (candidate.quantities.empty() || strength == 0) continue;
    bool const offset = candidate.name.starts_with(offset_name);
    ReadingEffect const* const own = reading_effect(candidate.name);
    EffectValues with{strength, {}};
    if (own) with.parameters = parameters_of(candidate.name);
    for (std::size_t o = 0; o < study.observables.size(); ++o) {
      std::string const& quantity = study.observables[o].quantity;
      if (std::ranges::find(candidate.quantities, quantity) == candidate.quantities.end()) continue;
      double& value = values[static_cast<Eigen::Index>(o)];
      value = own      ? own->reading(value, with)
              : offset ? value + strength * offset_of(quantity).unit
                       : value * (1 + scale_unit * strength);
    }
  }
}

}  // namespace layerloop::validation
