#pragma once
#include "core/case.hpp"

namespace layerloop::coupling {

/// Effect `spot_drift`: optics that warm up move the focus, and the spot on the bed grows while a build goes on,
///   D = D0 sqrt(1 + ((f + dz) / zR)^2),  dz = strength min(rate t, limit),
/// with f the case's own laser.focus_offset, t the time that the beam has been on since the build began and zR
/// laser.rayleigh_length or, without, pi w0^2 / (M2 wavelength) (Siegman, Lasers (1986), 17.1). The focus of a thermal
/// lens moves by about a Rayleigh length within seconds to minutes and returns as slowly (Bitharas et al., J. Mater.
/// Process. Technol. 264 (2019) 1, and the sources therein); that it cools while powder is spread is left out.
/// \param beam_on_time  t [s] \return the case's laser; exactly that with the effect off
LaserSettings drifted_laser(Case const& checked, double beam_on_time);

}  // namespace layerloop::coupling
