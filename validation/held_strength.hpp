#pragma once
#include "core/effect_catalogue.hpp"

namespace layerloop::validation {

/// Strength from which that of a candidate counts. A compliant blade yields without the effect, by its own stiffness.
inline double held_strength(Effect const& effect, Case const& base) {
  bool const own_spring = effect.name == "blade_compliance" && base.machine.recoater == RecoaterKind::compliant_blade;
  double const strength = base.effect_strength(effect.name);
  return own_spring && strength == 0 ? 1.0 : strength;
}

}  // namespace layerloop::validation
