#pragma once
#include "core/material.hpp"

namespace layerloop::thermal {

/// Effect `surface_losses`: radiation and convection from metal that faces gas,
///   q = emissivity sigma (T^4 - T_ambient^4) + h (T - T_ambient),  h = 20 W/(m^2 K)
/// (shielding gas drifting over a plate: published models use 10 to 80).
class SurfaceLosses {
 public:
  /// \param strength  factor on both fluxes; 0: none
  SurfaceLosses(Material const& material, double ambient, double strength);

  double flux(double T) const;   ///< [W/m^2]
  double slope(double T) const;  ///< dq/dT [W/(m^2 K)]

  static constexpr double convection = 20;  ///< [W/(m^2 K)]

 private:
  double ambient_;     ///< [K]
  double radiation_;   ///< [W/(m^2 K^4)]
  double convection_;  ///< [W/(m^2 K)]
};

}  // namespace layerloop::thermal
