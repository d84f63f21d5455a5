#pragma once
#include <functional>
#include <vector>

#include "plate.hpp"
#include "thermal/heat_system.hpp"

namespace layerloop::thermal {

/// A block of metal that is stepped directly, so that a test sees every temperature in double precision.
class HeatedBlock {
 public:
  HeatedBlock(CellContent const& content, Material const& metal, FarField const& far = {infinite, infinite},
              double contact_conductivity = 0, SideY side_y = SideY::adiabatic, double top = 5000)
      : table(metal, 298, top),
        cells(make_heat_cells(content, side_y)),
        grid(cells.grid, side_y == SideY::periodic, Communicator()),
        system(make_heat_system(
            table, grid,
            make_conduction(cells, grid.box(), far, metal.conductivity(metal.solidus), contact_conductivity), {})) {}

  std::int64_t local(std::int32_t i, std::int32_t j, std::int32_t k) const { return grid.box().index(i, j, k); }
  double& enthalpy(std::int32_t i, std::int32_t j, std::int32_t k) {
    return system.enthalpy[static_cast<std::size_t>(local(i, j, k))];
  }
  double temperature(std::int32_t i, std::int32_t j, std::int32_t k) { return table.temperature(enthalpy(i, j, k)); }
  /// Calls f(i, j, k, centre) for every cell, x fastest.
  void for_cells(std::function<void(std::int32_t, std::int32_t, std::int32_t, Vec3 const&)> const& f) const {
    VoxelGrid const& voxels = cells.grid;
    for (std::int32_t k = 0; k < voxels.n[2]; ++k) {
      for (std::int32_t j = 0; j < voxels.n[1]; ++j) {
        for (std::int32_t i = 0; i < voxels.n[0]; ++i) f(i, j, k, voxels.centre(i, j, k));
      }
    }
  }

  EnthalpyTable table;
  HeatCells cells;
  HeatGrid grid;
  HeatSystem system;
};

}  // namespace layerloop::thermal
