#pragma once
#include <cstdint>
#include <vector>

#include "core/case.hpp"
#include "core/voxel_grid.hpp"

namespace layerloop::coupling {

/// The consolidated metal above the plate, over the whole deposition zone; y is periodic. grid.origin.z() is the
/// plate's top, so plate and solid go down together. Cells never hold more than density * cell volume.
struct SolidField {
  VoxelGrid grid;
  std::vector<double> mass;  ///< metal per cell [kg], shape grid.size()

  double plate_top() const { return grid.origin.z(); }
  std::int64_t columns() const { return std::int64_t{grid.n[0]} * grid.n[1]; }
};

/// Nothing solidified yet; the plate's top is level with the platforms (z = 0): lower it before the first layer.
SolidField empty_solid(Case const& checked);

/// Plate and solid move down by dz.
void lower(SolidField& solid, double dz);

/// Makes room for at least `cells` layers of cells; what is there stays.
void grow(SolidField& solid, std::int32_t cells);

/// Compensated sum of the metal [kg].
double metal_mass(SolidField const& solid);

/// Volume fraction of metal per cell, shape grid.size().
std::vector<double> fill_fraction(SolidField const& solid, double density);

/// Adds metal to cells: `share[c]` is the volume wanted in `cell[c]`, in cells. What a cell has no room for rises in
/// its column to the next room above, as if the column were pushed up. Mass-conserving; grows the field when needed.
struct CellVolume {
  std::int64_t cell;
  double volume;  ///< [cells]
};
void add_metal(SolidField& solid, std::vector<CellVolume> const& metal, double density);

/// Metal / (metal + voids) of the part so far, plate left out. A column's top is its highest cell that is at least half
/// full; the voids are all room under it, down to the plate, whether open sideways or not (lack of fusion, powder that
/// an overhang roofs, trapped grains' pores). Room in or above the top cell is open surface and does not count. 1 when
/// there is no part.
double part_relative_density(SolidField const& solid, double density);

/// One layer of cells of the part.
struct DensitySlice {
  double height = 0;            ///< of the cells' middle above the plate's top [m]
  std::int64_t columns = 0;     ///< that reach higher than the slice
  double relative_density = 0;  ///< metal over the volume of their cells here
};

/// The same density by height, from the plate up, of the columns whose middle lies in a rectangle (a section through
/// the part leaves its rim out): a column counts below its top cell. Ends where no column reaches higher. \param from,
/// to  opposite corners of the rectangle; z has no meaning
std::vector<DensitySlice> density_by_height(SolidField const& solid, double density, Vec3 const& from, Vec3 const& to);

}  // namespace layerloop::coupling
