#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/area_map.hpp"
#include "core/case.hpp"
#include "core/vec3.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// Which room inside the part its outer surface ignores.
enum class Voids {
  enclosed,   ///< gas that is not connected to the gas above through cells less than half full
  under_top,  ///< everything under a column's highest metal: the surface is a height map (thesis sect. 3.5)
};

/// Outer surface of plate and part as the level 0.5 of a field, trilinear between cell centres; coordinates in cells
/// from the solid's grid.origin. The level is the metal fraction averaged over two cells along z, metal lying at the
/// bottom of part-filled cells: so the level crosses 0.5 exactly at the height of every column that is filled from
/// below.
struct SurfaceLevel {
  std::array<std::int64_t, 3> first{};  ///< cell of the first node; nodes sit at cell centres
  std::array<std::int64_t, 3> n{};
  std::vector<double> level;  ///< shape n, x fastest
  double metal_cells = 0;     ///< metal and ignored voids above the plate that the nodes stand for [cells]

  double at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return level[static_cast<std::size_t>(i - first[0] + n[0] * (j - first[1] + n[1] * (k - first[2])))];
  }
  double operator()(Vec3 const& p) const;            ///< trilinear; nodes at the rim go on outwards
  double top(std::int64_t i, std::int64_t j) const;  ///< height of the surface on a column's axis [cells]
};

/// \param margin_y  cells by which the part is continued periodically beyond y = 0 and y = width; one blank cell
/// follows
SurfaceLevel surface_level(SolidField const& solid, double density, Voids voids, std::int64_t margin_y);

Voids ignored_voids(Case const& checked);

/// Height of the solid's outer surface (plate where nothing solidified) over the deposition zone; pixels are the cells.
HeightMap top_of_solid(SolidField const& solid, Case const& checked);

}  // namespace layerloop::coupling
