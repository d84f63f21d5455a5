#include "coupling/transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace layerloop::coupling {
namespace {

/// Layers of cells above the plate that hold grains of the range or metal.
std::int64_t occupied_layers(SolidField const& solid, PowderBed const& bed, double x_from, double x_to) {
  auto const highest = std::find_if(solid.mass.rbegin(), solid.mass.rend(), [](double m) { return m > 0; });
  std::int64_t layers =
      highest == solid.mass.rend() ? 0 : solid.grid.coordinates(solid.mass.rend() - highest - 1)[2] + 1;
  for (std::size_t g = 0; g < bed.size(); ++g) {
    if (bed.x[g] + bed.radius[g] < x_from || bed.x[g] - bed.radius[g] > x_to) continue;
    layers = std::max(
        layers, static_cast<std::int64_t>(std::ceil((bed.z[g] + bed.radius[g] - solid.plate_top()) / solid.grid.cell)));
  }
  return layers;
}

VoxelGrid heat_grid(SolidField const& solid, PowderBed const& bed, Case const& checked, double x_from, double x_to) {
  VoxelGrid const& lattice = solid.grid;
  constexpr double slack = 1e-6;  // of a cell: a border that lies on the lattice stays there
  auto const first = std::clamp<std::int64_t>(
      std::llround(std::floor((x_from - lattice.origin.x()) / lattice.cell + slack)), 0, lattice.n[0]);
  auto const last = std::clamp<std::int64_t>(
      std::llround(std::ceil((x_to - lattice.origin.x()) / lattice.cell - slack)), 0, lattice.n[0]);
  if (first >= last) {
    throw InputError(fmt::format(
        "heat grid x = {:.6g} to {:.6g} m lies beside the deposition zone ({:.6g} to {:.6g} m); move the scan there",
        x_from, x_to, lattice.origin.x(), lattice.upper().x()));
  }
  auto const below = static_cast<std::int32_t>(std::ceil(checked.heat.substrate_depth / lattice.cell - slack));
  VoxelGrid grid;
  grid.cell = lattice.cell;
  grid.origin = lattice.origin + lattice.cell * Vec3(static_cast<double>(first), 0, -below);
  grid.n = {static_cast<std::int32_t>(last - first), lattice.n[1], below + 2};
  grid.n[2] += static_cast<std::int32_t>(occupied_layers(solid, bed, grid.origin.x(), grid.upper().x()));
  return grid;
}

void add_powder(CellContent& content, PowderBed const& bed, double width) {
  std::vector<double> largest(content.powder.size(), 0.0);
  double const cell_volume = content.grid.cell_volume();
  for (std::size_t g = 0; g < bed.size(); ++g) {
    double const reach = bed.radius[g];
    if (bed.x[g] + reach < content.grid.origin.x() || bed.x[g] - reach > content.grid.upper().x()) continue;
    for (GrainShare const& share : grain_shares(bed, g, content.grid, width)) {
      auto const c = static_cast<std::size_t>(share.cell);
      content.powder[c] += share.volume / cell_volume;
      if (share.volume <= largest[c]) continue;
      largest[c] = share.volume;
      content.grain[c] = static_cast<std::int32_t>(g);
    }
  }
  for (std::size_t c = 0; c < content.powder.size(); ++c) {
    content.powder[c] = std::min(content.powder[c], 1.0 - content.solid[c]);
    if (content.powder[c] <= 0) content.grain[c] = -1;
  }
}

}  // namespace

CellContent cell_content(SolidField const& solid, PowderBed const& bed, Case const& checked, double x_from,
                         double x_to) {
  CellContent content;
  content.grid = heat_grid(solid, bed, checked, x_from, x_to);
  auto const cells = static_cast<std::size_t>(content.grid.size());
  content.solid.assign(cells, 0.0);
  content.powder.assign(cells, 0.0);
  content.grain.assign(cells, -1);

  std::vector<double> const fill = fill_fraction(solid, checked.material.density);
  std::int64_t const first = std::llround((content.grid.origin.x() - solid.grid.origin.x()) / solid.grid.cell);
  std::int64_t const below = std::llround((solid.plate_top() - content.grid.origin.z()) / solid.grid.cell);
  for (std::int64_t cell = 0; cell < content.grid.size(); ++cell) {
    auto const [i, j, k] = content.grid.coordinates(cell);
    double& metal = content.solid[static_cast<std::size_t>(cell)];
    if (k < below) {
      metal = 1;
    } else if (k - below < solid.grid.n[2]) {
      metal = std::min(1.0, fill[static_cast<std::size_t>(solid.grid.index(i + first, j, k - below))]);
    }
  }
  add_powder(content, bed, checked.period_y());
  return content;
}

}  // namespace layerloop::coupling
