#pragma once
#include "core/material.hpp"

namespace layerloop::thermal {

/// Effect `surface_losses`: radiation and convection from metal that faces gas,
///   q = emissivity sigma (T^4 - T_ambient^4) + h (T - T_ambient).
class SurfaceLosses {
 public:
  /// \param convection  h [W/(m^2 K)] \param strength  factor on both fluxes; 0: none
  SurfaceLosses(Material const& material, double ambient, double convection, double strength);

  double flux(double T) const;   ///< [W/m^2]
  double slope(double T) const;  ///< dq/dT [W/(m^2 K)]

 private:
  double ambient_;     ///< [K]
  double radiation_;   ///< [W/(m^2 K^4)]
  double convection_;  ///< [W/(m^2 K)]
};

}  // namespace layerloop::thermal
