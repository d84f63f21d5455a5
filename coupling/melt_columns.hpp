#pragma once
#include <vector>

#include "core/voxel_grid.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// What fills the cells of the solid's grid while the melt is liquid, as volume fractions; shape grid.size().
struct MeltColumns {
  VoxelGrid grid;
  std::vector<double> solid;       ///< metal that did not melt
  std::vector<double> grains;      ///< grains that stay
  std::vector<double> liquid;      ///< where it melted, as frozen volume: may exceed the room there
  std::vector<char> molten_plate;  ///< per column (i + nx * j): the plate's top melted, so that melt may flow in
  double expansion = 1;            ///< volume of the liquid over that which it freezes to
};

struct SettledMelt {
  std::vector<CellVolume> metal;  ///< where the liquid freezes; the same volume in all
  double mean_height_change = 0;  ///< mean over the levelled columns of |surface after - before levelling| [m]
};

/// Melt sinks, then levels.
///
/// Sinks: a cell blocks the melt when metal and staying grains fill at least half of it. The melt of a column between
/// two blocking cells fills the room from the lower one (its own room included) upwards; what finds no room goes on
/// above the next. So melt rests on grains that stay, and the void below them stays: lack of fusion.
///
/// Levels: surface tension flattens a melt of viscosity mu and surface tension gamma over a length lambda within
/// mu lambda / (2 pi gamma) (Lamb, Hydrodynamics, sect. 349, strongly damped), microseconds for metals and tens of
/// micrometres, far sooner than it freezes. The height h of the melt in columns that are open to the top diffuses
/// between neighbours that both hold melt or stand on molten plate: q = 0.2 (h_a - h_b) times the smaller free share of
/// the two surface cells, at most a quarter of the melt of the giving column, in as many sweeps as spread a bump over
/// `length` (standard deviation, sqrt(2 * 0.2 * sweeps) cells). Nothing flows into a column that did not melt, so the
/// pool's rim is pinned. Conservative, independent of the order of cells.
SettledMelt settle_melt(MeltColumns const& melt, double length);

}  // namespace layerloop::coupling
