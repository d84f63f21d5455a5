#pragma once
#include <cstdint>
#include <vector>

#include "core/area_map.hpp"

namespace layerloop {

/// A spread layer over a slice of the deposition zone along x and the full width. Not a number: nothing to measure.
/// Definitions: dem/layer_definitions.cpp, and written into every summary.
struct ZoneMetrics {
  double effective_thickness = 0, effective_thickness_u_num = 0;            ///< ELT [m]
  double real_effective_thickness = 0, real_effective_thickness_u_num = 0;  ///< RELT [m]
  double void_layer = 0;                                                    ///< VL [m]
  double volume_fraction_nominal = 0;
  double volume_fraction_real = 0, volume_fraction_real_u_num = 0;  ///< relative density of the slice
  double surface_coverage = 0;
  double roughness_sa_u_num = 0;
  double roughness_sa = 0, roughness_sq = 0, roughness_sz = 0;       ///< [m]
  double d10 = 0, d50 = 0, d90 = 0;                                  ///< by volume [m]
  double d10_number = 0, d50_number = 0, d90_number = 0;             ///< by number [m]
  double mean_diameter = 0, sauter_diameter = 0, mass_diameter = 0;  ///< D[1,0], D[3,2], D[4,3] [m]
  double coordination_number = 0, rattler_fraction = 0;
  std::int64_t grains = 0;  ///< that were not in the deposition zone before
};

/// One of `run.bins` slices of the deposition zone along the recoating direction.
struct LayerBin : ZoneMetrics {
  double x = 0;  ///< centre [m]
};

/// What a spread layer looks like: the zone is the interior of the deposition zone.
struct LayerMetrics : ZoneMetrics {
  double segregation_index = 0, lacey_index = 0;
  std::vector<LayerBin> bins;
  HeightMap surface;  ///< of the bed after spreading, over the deposition zone
};

/// Feed, heap and blade of one stroke.
struct StrokeMetrics {
  double settled_height = 0, settled_density = 0;                          ///< of the feed before the stroke; [m]
  double reservoir_mean_diameter_before = 0, reservoir_mean_diameter = 0;  ///< number mean [m]
  double reservoir_mass_ratio = 0;                                         ///< mass in the zone after over before
  double heap_angle_accumulation = 0, heap_angle_accumulation_u_num = 0;   ///< [deg]
  double heap_angle_deposition = 0, heap_angle_deposition_u_num = 0;       ///< [deg]
  double blade_force = 0, mean_blade_force = 0;  ///< against the stroke: largest, and mean over it [N]
  double bond_number = 0;                        ///< of the median grain: pull-off force over weight
  double steps_per_contact = 0;                  ///< of the smallest grain at the recoating speed
  double largest_overlap = 0;                    ///< over the smaller grain's diameter
};

}  // namespace layerloop
