#include "dem/user_attraction.hpp"

namespace layerloop::dem {

std::vector<UserAttraction> user_attractions(Case const& checked) {
  std::vector<UserAttraction> all;
  for (ActiveUserEffect const& active : active_user_effects(checked.effects))
    if (auto const* const effect = dynamic_cast<PairAttraction const*>(active.effect))
      all.push_back({effect, active.values});
  return all;
}

}  // namespace layerloop::dem
