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

HeatGrid::HeatGrid(VoxelGrid const& grid, bool periodic_y, Communicator const& comm)
    : cells_(grid.n), periodic_y_(periodic_y), alone_(comm.size() == 1) {
  bool const enough_columns = std::int64_t{grid.n[0]} * grid.n[1] >= 64 * comm.size();
  check_petsc(DMDACreate3d(comm.handle(), DM_BOUNDARY_GHOSTED, periodic_y ? DM_BOUNDARY_PERIODIC : DM_BOUNDARY_GHOSTED,
                           DM_BOUNDARY_GHOSTED, DMDA_STENCIL_STAR, grid.n[0], grid.n[1], grid.n[2], PETSC_DECIDE,
                           PETSC_DECIDE, enough_columns ? 1 : PETSC_DECIDE, 1, 1, nullptr, nullptr, nullptr, &da_));
  check_petsc(DMSetUp(da_));
  check_petsc(DMDAGetCorners(da_, &box_.begin[0], &box_.begin[1], &box_.begin[2], &box_.n[0], &box_.n[1], &box_.n[2]));
  PetscMPIInt const* around;  // 27 ranks, x fastest, this one in the middle; negative: outside
  check_petsc(DMDAGetNeighbors(da_, &around));
  int step = 1;
  for (auto& sides : neighbour_) {
    for (int const s : {0, 1}) {
      int const rank = around[13 + (s == 0 ? -step : step)];
      sides[static_cast<std::size_t>(s)] = rank < 0 ? MPI_PROC_NULL : rank;
    }
    step *= 3;
  }
}

HeatGrid::~HeatGrid() { DMDestroy(&da_); }

bool HeatGrid::any(bool here) const {
  if (alone_) return here;
  int value = here;
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_LOR, PetscObjectComm(reinterpret_cast<PetscObject>(da_)));
  return value != 0;
}

void HeatGrid::unite(std::span<std::int32_t> stretches) const {
  if (alone_) return;
  for (std::size_t i = 1; i < stretches.size(); i += 2) stretches[i] = -stretches[i];
  MPI_Allreduce(MPI_IN_PLACE, stretches.data(), static_cast<int>(stretches.size()), MPI_INT32_T, MPI_MIN,
                PetscObjectComm(reinterpret_cast<PetscObject>(da_)));
  for (std::size_t i = 1; i < stretches.size(); i += 2) stretches[i] = -stretches[i];
}

namespace {

/// Calls f(index) for the own cells' columns of one layer across an axis.
template <class F>
void for_layer(LocalBox const& box, std::size_t axis, std::int32_t at, F const& f) {
  std::array<std::int32_t, 3> first{0, 0, 0}, last = box.n;
  first[axis] = at, last[axis] = at + 1;
  for (std::int32_t k = first[2]; k < last[2]; ++k) {
    for (std::int32_t j = first[1]; j < last[1]; ++j) {
      for (std::int32_t i = first[0]; i < last[0]; ++i) f(box.index(i, j, k));
    }
  }
}

}  // namespace

void HeatGrid::exchange(std::span<double> values) const {
  MPI_Comm const comm = PetscObjectComm(reinterpret_cast<PetscObject>(da_));
  std::vector<double> sent, received;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t side : {0, 1}) {
      int const to = neighbour_[axis][side], from = neighbour_[axis][1 - side];
      if (to == MPI_PROC_NULL && from == MPI_PROC_NULL) continue;
      sent.clear();
      for_layer(box_, axis, side == 0 ? 0 : box_.n[axis] - 1, [&](std::int64_t c) { sent.push_back(values[c]); });
      received.resize(sent.size());
      auto const count = static_cast<int>(sent.size());
      MPI_Sendrecv(sent.data(), count, MPI_DOUBLE, to, 0, received.data(), count, MPI_DOUBLE, from, 0, comm,
                   MPI_STATUS_IGNORE);
      if (from == MPI_PROC_NULL) continue;
      auto next = received.begin();
      for_layer(box_, axis, side == 0 ? box_.n[axis] : -1, [&](std::int64_t c) { values[c] = *next++; });
    }
  }
}

}  // namespace layerloop::thermal
