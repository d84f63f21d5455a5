#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/area_map.hpp"
#include "core/case.hpp"
#include "core/layer_metrics.hpp"
#include "core/powder_bed.hpp"

namespace layerloop::dem {

/// Height of bed and base seen from above, on the pixels of `base`: the top of the highest grain (a spherical cap) over
/// a pixel's centre, or the base where that is higher or bare. \pre the map spans one period along y
HeightMap height_map(PowderBed const& bed, HeightMap const& base);

/// The deposition zone before the blade comes.
struct LayerBase {
  HeightMap surface;                 ///< bed and solid
  std::vector<std::int64_t> grains;  ///< ids of those with their centre in the zone, ascending
  std::vector<double> volume;        ///< of those grains in the interior, then in each bin [m^3]
};

/// \param solid  height of plate and part over the deposition zone: x from deposition_begin to deposition_end, y in [0,
/// width)
LayerBase layer_base(PowderBed const& bed, HeightMap const& solid, Case const& checked);

/// What the blade left, by definitions(). \param before  of the same layer, after the plate went down
LayerMetrics measure_layer(PowderBed const& bed, HeightMap const& solid, LayerBase const& before, Case const& checked);

/// Quantity -> how it is measured; goes into every summary.
std::map<std::string, std::string> definitions();

}  // namespace layerloop::dem
