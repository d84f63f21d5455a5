#pragma once
#include "core/material.hpp"

namespace layerloop::thermal {

/// Effect `evaporation`: heat that leaves with the vapour of a free surface.
///
/// Hertz-Knudsen with the share that returns to the surface taken off (0.82: Knight, AIAA J. 17 (1979) 519) and the
/// vapour pressure of Clausius-Clapeyron through the boiling point at 1 atm:
///   q = 0.82 L p(T) sqrt(M / (2 pi R T)),  p = p0 exp(L M / R (1/Tb - 1/T)).
/// The vapour is booked with its heat of vaporisation alone; the cell keeps its mass (a track loses below 1 %).
class Evaporation {
 public:
  /// \param strength  factor on the flux; 0: no evaporation
  Evaporation(Material const& material, double strength);

  double flux(double T) const;                     ///< [W/m^2]
  double slope(double T, double flux_at_T) const;  ///< dq/dT [W/(m^2 K)]
  double heat_of_vaporisation() const { return heat_; }

 private:
  double heat_;     ///< [J/kg]
  double boiling_;  ///< [K]
  double onset_;    ///< L M / R [K]
  double factor_;   ///< strength * 0.82 L p0 sqrt(M / (2 pi R)) [W K^(1/2) / m^2]
};

}  // namespace layerloop::thermal
