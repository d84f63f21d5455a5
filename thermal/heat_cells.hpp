#pragma once
#include <cstdint>
#include <vector>

#include "core/cell_content.hpp"

namespace layerloop::thermal {

/// What closes the two y sides of the grid.
enum class SideY { periodic, far_field, adiabatic };

/// The cells that carry an unknown, and which of them stands for every other cell. Shapes: grid.size().
///
/// A cell that holds less metal than `least_fill` of its volume has no unknown of its own: the small mass would
/// overheat under the power that its surface catches, and would ask for short steps. Its metal, and the power that
/// lands in it, belong to a neighbour: of its own body first, then the nearest of the 26 around it, then the best
/// filled. Mass and power are exact; what is lost is the shape of the surface below a cell. Power that lands in a cell
/// without metal goes to the nearest cell with an unknown.
struct HeatCells {
  static constexpr double least_fill = 0.35;

  VoxelGrid grid;
  SideY side_y;
  std::vector<double> fill;        ///< metal volume that the unknown carries / cell volume; 0: no unknown; may exceed 1
  std::vector<std::int32_t> body;  ///< row of the grain it belongs to; -1: consolidated metal or no metal
  std::vector<std::int64_t> host;  ///< cell whose unknown takes the power of this cell
  std::vector<char> metal;         ///< 1: the cell itself holds metal, in its own unknown or in a neighbour's
  std::int64_t unknowns = 0;

  /// Cell next to c along an axis (0, 1, 2), step -1 or +1; -1 outside. y wraps when periodic.
  std::int64_t neighbour(std::array<std::int32_t, 3> c, int axis, int step) const;
};

/// \throws InputError  arrays of the wrong size, fractions outside [0, 1], no metal at all
HeatCells make_heat_cells(CellContent const& content, SideY side_y);

/// Surface that a cell turns to gas, in units of a cell's face: sqrt(nx^2 + ny^2 + nz^2) with n the open faces along
/// each axis. Exact for planes along the axes and at 45 degrees, where counting faces would overstate a staircase by
/// sqrt(2). The top of the grid is open, its other sides are not.
double open_area(HeatCells const& cells, std::int64_t cell);

}  // namespace layerloop::thermal
