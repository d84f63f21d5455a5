#include "thermal/heat_grid.hpp"

#include <petscdmda.h>

#include "thermal/petsc_check.hpp"

namespace layerloop::thermal {

std::int64_t LocalBox::own(std::array<std::int32_t, 3> const& cell) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (cell[a] < begin[a] || cell[a] >= begin[a] + n[a]) return -1;
  }
  return index(cell[0] - begin[0], cell[1] - begin[1], cell[2] - begin[2]);
}

HeatGrid::HeatGrid(VoxelGrid const& grid, bool periodic_y, Communicator const& comm) {
  bool const enough_columns = std::int64_t{grid.n[0]} * grid.n[1] >= 64 * comm.size();
  check_petsc(DMDACreate3d(comm.handle(), DM_BOUNDARY_GHOSTED, periodic_y ? DM_BOUNDARY_PERIODIC : DM_BOUNDARY_GHOSTED,
                           DM_BOUNDARY_GHOSTED, DMDA_STENCIL_STAR, grid.n[0], grid.n[1], grid.n[2], PETSC_DECIDE,
                           PETSC_DECIDE, enough_columns ? 1 : PETSC_DECIDE, 1, 1, nullptr, nullptr, nullptr, &da_));
  check_petsc(DMSetUp(da_));
  check_petsc(DMDAGetCorners(da_, &box_.begin[0], &box_.begin[1], &box_.begin[2], &box_.n[0], &box_.n[1], &box_.n[2]));
  check_petsc(DMCreateLocalVector(da_, &local_));
}

HeatGrid::~HeatGrid() {
  VecDestroy(&local_);
  DMDestroy(&da_);
}

void HeatGrid::exchange(std::vector<double>& values) const {
  check_petsc(VecPlaceArray(local_, values.data()));
  check_petsc(DMLocalToLocalBegin(da_, local_, INSERT_VALUES, local_));
  check_petsc(DMLocalToLocalEnd(da_, local_, INSERT_VALUES, local_));
  check_petsc(VecResetArray(local_));
}

}  // namespace layerloop::thermal
