#pragma once
#include <map>
#include <string>

#include "core/case.hpp"

namespace layerloop::thermal {

using Effects = std::map<std::string, EffectSettings>;

/// Strength of an effect; 0, its null value, when it is switched off or not named.
inline double effect_strength(Effects const& effects, std::string const& name) {
  auto const found = effects.find(name);
  return found != effects.end() && found->second.enabled ? found->second.strength : 0.0;
}

}  // namespace layerloop::thermal
