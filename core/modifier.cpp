#include "core/modifier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/error.hpp"

namespace layerloop {
namespace {

constexpr char const *conductivity = "material.conductivity", *specific_heat = "material.specific_heat",
                     *absorbed_power = "laser.absorbed_power";

std::map<std::string, std::vector<std::string>> const& targets() {
  static std::map<std::string, std::vector<std::string>> const all{
      {conductivity, {"k", "s", "T"}},
      {specific_heat, {"c", "s", "T"}},
      {absorbed_power, {"absorbed", "s", "incident", "t", "v", "x", "y"}},
  };
  return all;
}

bool is_on(ModifierSettings const& modifier) { return modifier.enabled && modifier.strength != 0; }

/// Where a table is taken when something changes it.
std::vector<double> temperatures_of(PropertyTable const& table) {
  std::set<double> all(table.temperature.begin(), table.temperature.end());
  for (double T = 250; T <= 5000; T += 25) all.insert(T);
  return {all.begin(), all.end()};
}

template <class Change>
void change(PropertyTable& table, std::string const& what, Change const& value_at) {
  PropertyTable changed{temperatures_of(table), {}};
  for (double const T : changed.temperature) {
    double const value = value_at(table(T), T);
    if (!(value > 0))
      throw InputError(fmt::format("{} is {:g} at {:g} K (it must be positive) lower the strength", what, value, T));
    changed.value.push_back(value);
  }
  table = std::move(changed);
}

void apply(std::string const& name, ModifierSettings const& modifier, Material& metal) {
  if (modifier.target == absorbed_power) return;
  Expression const formula(modifier.expression, variables_of(modifier.target));
  change(modifier.target == conductivity ? metal.conductivity : metal.specific_heat,
         fmt::format("modifiers.{}: {}", name, modifier.target), [&](double value, double T) {
           return formula({value, modifier.strength, T});
         });
}

}  // namespace

std::vector<std::string> const& variables_of(std::string const& target) {
  static std::vector<std::string> const none;
  auto const found = targets().find(target);
  return found == targets().end() ? none : found->second;
}

std::vector<std::string> const& modifier_targets() {
  static std::vector<std::string> const names{conductivity, specific_heat, absorbed_power};
  return names;
}

EffectStage stage_of_target(std::string const& target) {
  return target == absorbed_power ? EffectStage::laser : EffectStage::heat;
}

Material modified_material(Case const& checked) {
  Material metal = checked.material;
  for (auto const& [name, modifier] : checked.modifiers)
    if (is_on(modifier)) apply(name, modifier, metal);
  for (ActiveUserEffect const& active : active_user_effects(checked.effects)) {
    auto const* const effect = dynamic_cast<MetalProperties const*>(active.effect);
    if (!effect) continue;
    change(metal.conductivity, "conductivity",
           [&](double k, double T) { return effect->conductivity(k, T, active.values); });
    change(metal.specific_heat, "specific heat",
           [&](double c, double T) { return effect->specific_heat(c, T, active.values); });
  }
  return metal;
}

ModifiedAbsorption::ModifiedAbsorption(Case const& checked) {
  for (auto const& [name, modifier] : checked.modifiers)
    if (is_on(modifier) && modifier.target == absorbed_power)
      formulas_.push_back({name, modifier.strength, Expression(modifier.expression, variables_of(absorbed_power))});
  for (ActiveUserEffect const& active : active_user_effects(checked.effects))
    if (dynamic_cast<AbsorbedPowerEffect const*>(active.effect)) effects_.push_back(active);
}

double ModifiedAbsorption::operator()(BeamMoment beam) const {
  for (Formula const& f : formulas_)
    beam.absorbed = f.expression(
        {beam.absorbed, f.strength, beam.incident, beam.time, beam.speed, beam.position.x(), beam.position.y()});
  for (ActiveUserEffect const& active : effects_)
    beam.absorbed = dynamic_cast<AbsorbedPowerEffect const&>(*active.effect).absorbed(beam, active.values);
  if (beam.absorbed >= 0 && beam.absorbed <= beam.incident) return beam.absorbed;
  throw InputError(
      fmt::format("the absorbed power would be {:g} W of {:g} W (by a modifier or an effect of a library) "
                  "keep it between none and all",
                  beam.absorbed, beam.incident));
}

}  // namespace layerloop
