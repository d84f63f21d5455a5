#pragma once
#include "core/material.hpp"

namespace layerloop::thermal {

/// Effect `variable_conductivity`: k follows the temperature instead of staying at its value at the solidus.
/// \param strength  share of the departure from that value; 0: constant, 1: the material's table
inline void apply_variable_conductivity(Material& material, double strength) {
  double const constant = material.conductivity(material.solidus);
  if (strength == 0) {
    material.conductivity = {{material.solidus}, {constant}};
    return;
  }
  for (double& k : material.conductivity.value) k = constant + strength * (k - constant);
}

}  // namespace layerloop::thermal
