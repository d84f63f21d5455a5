#pragma once
#include "core/case.hpp"
#include "core/vec3.hpp"

namespace layerloop::coupling {

/// Effect `plume_attenuation`: what the vapour above the pool takes from the beam before it reaches the bed.
///
/// Beer-Lambert, exp(-tau), with an optical depth in proportion to the metal that stands in the beam,
///   tau = strength m / m1 (1 + asymmetry cos(angle between scan and gas flow)),
/// where m is the mass rate of evaporation (effect `evaporation`), averaged exponentially over the time that a plume
/// takes to rise out of the beam, and m1 the rate at which the optical depth is 1. Vapour itself is clear at 1 um; what
/// scatters and absorbs are droplets of 10 to 100 nm that condense in it (Shcheglov et al., Laser Phys. Lett. 8 (2011)
/// 475). As Rayleigh absorbers of iron, 0.7 m^2/g, a tenth of the vapour condensed, rising at 100 m/s in a plume 0.4 mm
/// wide and 5 mm high, they give m1 = 36 mg/s; 1 to 3 mg/s of vapour then take 3 to 10 %, the range that is seen in
/// argon. Gas that flows across bends the plume into the beam or out of it: the asymmetry is its first harmonic.
class Plume {
 public:
  /// Clear where the effect is off.
  Plume() = default;
  explicit Plume(Case const& checked);

  /// \param vapour_rate  [kg/s], mean over the `duration` [s] that has passed
  void feed(double vapour_rate, double duration);

  /// Share of the beam that passes; exactly 1 without plume. \param along  direction of the scan, of length 1
  double transmission(Vec3 const& along) const;

 private:
  double depth_per_rate_ = 0;   ///< strength / m1 [s/kg]
  double relaxation_time_ = 0;  ///< [s]
  double asymmetry_ = 0;
  Vec3 flow_ = Vec3::UnitX();
  double rate_ = 0;  ///< m [kg/s]
};

}  // namespace layerloop::coupling
