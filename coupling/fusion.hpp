#pragma once
#include <optional>
#include <vector>

#include "core/cell_content.hpp"
#include "core/heat_source.hpp"
#include "core/melt_record.hpp"

namespace layerloop::coupling {

/// How well the tracks of a patch join, between the outermost of their lines and over the middle half of their length.
struct Fusion {
  std::optional<double> unmelted_powder;  ///< share of the powder's volume there that never melted; none: no powder
  double unmelted_surface = 0;        ///< share of the area there where the surface that the powder lay on never melted
  double overlap_depth = 0;           ///< smallest melted depth below that surface on any line between the tracks [m]
  double elliptic_overlap_depth = 0;  ///< that of half ellipses as wide and deep as the pool, the hatch apart [m]
};

/// Nothing for a single track, or tracks that are not parallel. \param melt, content  on the same grid \param isotherm
/// [K] Source of the ellipses: Tang, Pistorius & Beuth, Addit. Manuf. 14 (2017) 39.
std::optional<Fusion> fusion_of(MeltRecord const& melt, CellContent const& content, std::vector<Track> const& tracks,
                                double isotherm);

}  // namespace layerloop::coupling
