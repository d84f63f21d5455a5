#pragma once
#include <vector>

#include "core/case.hpp"
#include "core/powder_bed.hpp"
#include "coupling/part_surface_cgal.hpp"

namespace layerloop::coupling {

struct Clearance {
  std::vector<std::size_t> stuck;   ///< rows that found no free place; when there are any, no grain was moved
  std::int64_t grains_moved = 0;    ///< displaced by more than a thousandth of their radius
  double largest_displacement = 0;  ///< [m]
};

/// Moves grains so that none overlaps the part's surface (a gap of 1e-4 radii stays) and no pair overlaps by more than
/// before plus 1e-3 of the smaller radius. Projections out of surface, pit walls and one another, Gauss-Seidel in order
/// of id; grains that still find no place are lifted over what they touch. Contact springs of moved grains are dropped.
/// Deterministic. y is periodic; the surface must reach beyond y = 0 and y = width (see mesh_solid).
Clearance clear_grains(PowderBed& bed, SurfaceDistance const& surface, Case const& checked);

}  // namespace layerloop::coupling
