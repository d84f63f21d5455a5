#pragma once
#include <cstdint>
#include <vector>

#include "core/area_map.hpp"

namespace layerloop {

/// One slice of the deposition zone along the recoating direction.
struct LayerBin {
  double x;                    ///< centre [m]
  double relative_density;     ///< grain mass / (density * bin area * real effective thickness of the bin)
  double effective_thickness;  ///< [m]
  double mean_diameter;        ///< number mean of grains with their centre in the bin [m]; 0 when empty
  std::int64_t grains;
};

/// What a spread layer looks like (definitions: dem/layer_metrics.hpp, and written into every summary).
struct LayerMetrics {
  double effective_thickness = 0;       ///< ELT [m]
  double real_effective_thickness = 0;  ///< RELT [m]
  double void_layer = 0;                ///< VL [m]
  double volume_fraction_nominal = 0;
  double volume_fraction_real = 0;
  double surface_coverage = 0;
  double roughness_sa = 0;           ///< [m]
  double d10 = 0, d50 = 0, d90 = 0;  ///< by volume [m]
  std::vector<LayerBin> bins;
  HeightMap surface;  ///< of the bed after spreading, over the deposition zone
};

}  // namespace layerloop
