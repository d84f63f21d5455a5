#pragma once
#include <vector>

#include "core/case.hpp"
#include "core/user_effect.hpp"

namespace layerloop::dem {

/// Attraction between grains that a loaded library adds.
struct UserAttraction {
  PairAttraction const* effect;
  EffectValues values;
};

/// Those that are on in the case.
std::vector<UserAttraction> user_attractions(Case const& checked);

}  // namespace layerloop::dem
