#pragma once
#include "thermal/conduction.hpp"

namespace layerloop::thermal {

/// Effect `marangoni`: what the flow of the melt, which surface tension drives outwards, adds to its conduction. The
/// liquid's conductivity is multiplied by 1 + strength (factor - 1), along x and y by another factor than along z.
/// Source: enhanced conductivity of laser melt pools, about 2.5: Lampa et al., Int. J. Heat Mass Transf. 40 (1997)
/// 1239. \param strength  0: the liquid conducts as its table says
inline LiquidConductivity marangoni(EnthalpyTable const& table, double strength, double lateral, double vertical) {
  return {1 + strength * (lateral - 1), 1 + strength * (vertical - 1), table.conductivity_integral(table.liquidus())};
}

}  // namespace layerloop::thermal
