#pragma once
#include <vector>

#include "core/case.hpp"
#include "core/powder_bed.hpp"

namespace layerloop::dem {

/// Grains with their centre in the accumulation zone.
struct Reservoir {
  double surface = 0;        ///< mean height of the feed's surface, without the outer 100 um of the zone [m]
  double height = 0;         ///< of that surface over the zone's floor [m]
  double density = 0;        ///< grain volume over the zone's area times that height
  double mean_diameter = 0;  ///< by number [m]; not a number when empty
  double volume = 0;         ///< of the grains [m^3]
  std::vector<double> volume_of_material;  ///< the same, by PowderBed::material
};

Reservoir measure_reservoir(PowderBed const& bed, MachineSettings const& machine);

}  // namespace layerloop::dem
