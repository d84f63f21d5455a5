#pragma once
#include "core/material.hpp"

namespace layerloop::thermal {

/// Effect `latent_heat`: heat taken up by melting and returned on freezing, spread over solidus to liquidus.
/// \param strength  share of the material's latent heat that acts; 0: none, 1: all of it
inline void apply_latent_heat(Material& material, double strength) { material.latent_heat *= strength; }

}  // namespace layerloop::thermal
