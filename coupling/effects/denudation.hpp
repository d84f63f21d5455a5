#pragma once
#include <cstdint>
#include <vector>

#include "core/case.hpp"
#include "core/heat_source.hpp"
#include "core/powder_bed.hpp"

namespace layerloop::coupling {

/// Grains that the gas drew away, and their mass [kg].
struct Denuded {
  std::int64_t grains = 0;
  double mass = 0;
};

/// Effect `denudation`: beside a track the jet of vapour sucks gas, and with it grains, into its foot; what it takes is
/// gone from the bed (Matthews et al., Acta Mater. 114 (2016) 33; Bidare et al., Acta Mater. 142 (2018) 107: zones
/// of 1.5 to 2.5 spots in argon at 1 atm).
///
/// A grain that no pool has taken and whose centre lies a distance r from the axis of a track, seen from above, is lost
/// with a probability of strength (1 - r / reach), reach = width_factor laser.spot_diameter; every track draws anew. It
/// acts once a layer, after melting: on the bed that the next layer is spread on. That the second of two neighbouring
/// tracks finds less powder is left out, for the heat grid holds its metal while a layer is exposed. Which grains go is
/// drawn by seed, layer, track and grain id alone. y is periodic across machine.width.
Denuded denude(PowderBed& bed, std::vector<Track> const& tracks, Case const& checked, std::int32_t layer);

}  // namespace layerloop::coupling
