#pragma once

namespace layerloop::coupling {

/// Cross-section of the melt pool of every track, and how tracks and layers follow one another. SI.
///
/// Heights are those of solid metal. `layer_thickness` is what a layer adds to the part, in the steady state the step
/// of the platform: the powder lies deeper than that, thickness over packing density, but melts down to it. `depth` is
/// counted from the top of the layer that is being melted, once solid: the depth of a track on a bare plate, or, of a
/// track on powder, the depth below the surface that the powder lay on plus the layer thickness.
struct PoolArray {
  double width = 0, depth = 0;  ///< of the pool; 0: nothing melts
  double hatch_spacing = 0;     ///< > 0
  double layer_thickness = 0;   ///< > 0
};

/// Where the tracks of a layer lie beside those of the layer below: over them, half a hatch beside them, or anywhere
/// (turned from layer to layer by an angle that does not come back: every phase is equally likely, in each layer
/// independently of the others).
enum class HatchPattern { aligned, shifted, rotated };

/// Q = (hatch / width)^2 + (layer / depth)^2: at most 1 where neighbouring pools, half ellipses, meet below the bottom
/// of their layer, so that nothing stays unmelted whatever the pattern. Infinite without a pool. Source: Tang,
/// Pistorius & Beuth, Addit. Manuf. 14 (2017) 39, eq. 6.
double overlap_number(PoolArray const& array);

/// Share of the cross-section that no pool reaches, of pools that are half ellipses, flat side up, also of layers
/// above: 0 where Q <= 1, and only there when aligned or rotated (shifted tracks reach under the joints of the layer
/// below); 1 without a pool.
///
/// At the height s below its top a pool is w(s) = width sqrt(1 - (s / depth)^2) wide; the layer m steps above is met at
/// s + m layer_thickness. With c_m = w(s + m layer_thickness) / hatch_spacing the share that stays at s is
///   aligned 1 - c_0,   shifted 1 - c_0 - c_1,   rotated (1 - c_0) (1 - c_1) (1 - c_2) ...,   each factor >= 0,
/// and its mean over 0 < s < layer_thickness is returned: exact when aligned, by quadrature to 1e-9 otherwise.
double unmelted_share(PoolArray const& array, HatchPattern pattern);

/// 1 - unmelted_share: the relative density of the part if what stays unmelted counts as empty. It speaks of lack of
/// fusion alone; keyhole and gas pores come on top, and grains that stay in the gaps make it denser.
inline double relative_density(PoolArray const& array, HatchPattern pattern) {
  return 1 - unmelted_share(array, pattern);
}

}  // namespace layerloop::coupling
