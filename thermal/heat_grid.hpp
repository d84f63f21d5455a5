#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "core/voxel_grid.hpp"

struct _p_DM;

namespace layerloop::thermal {

/// The cells of one rank: a box of the grid, stored with one layer of neighbours all around (x fastest).
/// Local coordinates run from 0 to n - 1; -1 and n are the neighbours' layer.
struct LocalBox {
  std::array<std::int32_t, 3> begin{};  ///< first own cell in the grid
  std::array<std::int32_t, 3> n{};      ///< own cells

  std::int64_t stride_y() const { return n[0] + 2; }
  std::int64_t stride_z() const { return std::int64_t{n[0] + 2} * (n[1] + 2); }
  std::int64_t size() const { return stride_z() * (n[2] + 2); }
  std::int64_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return (i + 1) + stride_y() * (j + 1) + stride_z() * (k + 1);
  }
  /// Local index of a cell of the grid; -1 when another rank owns it.
  std::int64_t own(std::array<std::int32_t, 3> const& cell) const;
};

/// The grid shared out over the ranks by a PETSc DMDA (one unknown, star stencil, columns along z stay whole when there
/// are enough of them: the gas above the bed would unbalance a cut).
class HeatGrid {
 public:
  HeatGrid(VoxelGrid const& grid, bool periodic_y, Communicator const& comm);
  ~HeatGrid();
  HeatGrid(HeatGrid const&) = delete;
  HeatGrid& operator=(HeatGrid const&) = delete;

  LocalBox const& box() const { return box_; }
  _p_DM* petsc() const { return da_; }

  /// Refreshes the faces of the neighbours' layer from their owners (edges and corners are nobody's neighbours). Shape:
  /// box().size(). \note Collective
  void exchange(std::span<double> values) const;

  std::array<std::int32_t, 3> const& cells() const { return cells_; }  ///< of the whole grid
  bool periodic_y() const { return periodic_y_; }
  bool any(bool here) const;  ///< true on some rank \note Collective
  /// Pairs of begin and end: the smallest begin and the largest end over the ranks. \note Collective
  void unite(std::span<std::int32_t> stretches) const;

 private:
  _p_DM* da_ = nullptr;
  LocalBox box_;
  std::array<std::int32_t, 3> cells_;
  bool periodic_y_;
  bool alone_;                                     ///< one rank
  std::array<std::array<int, 2>, 3> neighbour_{};  ///< ranks below and above along each axis
};

}  // namespace layerloop::thermal
