#pragma once
#include <cstdint>
#include <vector>

#include "core/powder_bed.hpp"
#include "core/voxel_grid.hpp"

namespace layerloop {

/// What fills the cells of the heat grid before the laser comes. Shapes: every array has grid.size() entries, x
/// fastest. solid + powder <= 1; the rest of a cell is gas.
struct CellContent {
  VoxelGrid grid;
  std::vector<double> solid;        ///< volume fraction of consolidated metal, plate included
  std::vector<double> powder;       ///< volume fraction of grains
  std::vector<std::int32_t> grain;  ///< row in the bed of the grain that fills most of the cell; -1: none
};

/// One grain's share of one cell.
struct GrainShare {
  std::int64_t cell;
  double volume;  ///< [m^3]
};

/// Volume of one grain in each cell of the grid it touches, ascending by cell; y wraps with `period_y` when it is > 0.
/// Each column of cells is sampled with 8 x 8 vertical chords of the sphere (exact along z); what these miss of the
/// volume is shared out to the cut cells in proportion to f (1 - f), f being the filled fraction. So no share exceeds
/// its cell, and the shares of a grain that lies wholly inside the grid sum to its volume to round-off. Volume outside
/// the grid is left out. \pre period_y is a whole number of cells
std::vector<GrainShare> grain_shares(PowderBed const& bed, std::size_t row, VoxelGrid const& grid, double period_y);

}  // namespace layerloop
