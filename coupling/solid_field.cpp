#include "coupling/solid_field.hpp"

#include <algorithm>
#include <cmath>

#include "core/compensated_sum.hpp"

namespace layerloop::coupling {
namespace {

std::int32_t cells_along(double length, double cell) { return static_cast<std::int32_t>(std::llround(length / cell)); }

/// Highest cell of a column that is at least half full; -1 if none is.
std::int64_t top_cell(SolidField const& solid, std::vector<double> const& fill, std::int64_t column) {
  std::int64_t top = solid.grid.n[2] - 1;
  while (top >= 0 && fill[static_cast<std::size_t>(column + top * solid.columns())] < 0.5) --top;
  return top;
}

}  // namespace

SolidField empty_solid(Case const& checked) {
  MachineSettings const& machine = checked.machine;
  double const cell = checked.heat.cell_size;
  double const height = static_cast<double>(checked.run.layers) * machine.layer_thickness;
  SolidField solid;
  solid.grid.origin = Vec3(machine.deposition_begin(), 0, 0);
  solid.grid.cell = cell;
  solid.grid.n = {cells_along(machine.deposition_length, cell), cells_along(machine.width, cell),
                  static_cast<std::int32_t>(std::ceil(height / cell)) + 4};
  solid.mass.assign(static_cast<std::size_t>(solid.grid.size()), 0.0);
  return solid;
}

void lower(SolidField& solid, double dz) { solid.grid.origin.z() -= dz; }

void grow(SolidField& solid, std::int32_t cells) {
  if (cells <= solid.grid.n[2]) return;
  solid.grid.n[2] = cells;
  solid.mass.resize(static_cast<std::size_t>(solid.grid.size()), 0.0);
}

double metal_mass(SolidField const& solid) {
  CompensatedSum sum;
  for (double m : solid.mass) sum.add(m);
  return sum.value();
}

std::vector<double> fill_fraction(SolidField const& solid, double density) {
  double const full = density * solid.grid.cell_volume();
  std::vector<double> fill(solid.mass.size());
  std::transform(solid.mass.begin(), solid.mass.end(), fill.begin(), [&](double m) { return m / full; });
  return fill;
}

void add_metal(SolidField& solid, std::vector<CellVolume> const& metal, double density) {
  double const full = density * solid.grid.cell_volume();
  for (CellVolume const& share : metal) {
    double left = share.volume * full;
    for (std::int64_t c = share.cell; left > 0; c += solid.columns()) {
      if (c >= solid.grid.size()) grow(solid, solid.grid.n[2] + 1);
      double& mass = solid.mass[static_cast<std::size_t>(c)];
      double const taken = std::min(left, std::max(0.0, full - mass));
      mass += taken;
      left -= taken;
    }
  }
}

double part_relative_density(SolidField const& solid, double density) {
  std::vector<double> const fill = fill_fraction(solid, density);
  CompensatedSum metal, envelope;
  for (std::int64_t column = 0; column < solid.columns(); ++column) {
    auto const at = [&](std::int64_t k) { return fill[static_cast<std::size_t>(column + k * solid.columns())]; };
    std::int64_t const top = top_cell(solid, fill, column);
    if (top < 0) continue;
    envelope.add(static_cast<double>(top) + at(top));
    for (std::int64_t k = 0; k <= top; ++k) metal.add(at(k));
  }
  return envelope.value() > 0 ? metal.value() / envelope.value() : 1.0;
}

std::vector<DensitySlice> density_by_height(SolidField const& solid, double density, Vec3 const& from, Vec3 const& to) {
  std::vector<double> const fill = fill_fraction(solid, density);
  std::vector<DensitySlice> slices(static_cast<std::size_t>(solid.grid.n[2]));
  for (std::int64_t column = 0; column < solid.columns(); ++column) {
    Vec3 const middle = solid.grid.centre(column % solid.grid.n[0], column / solid.grid.n[0], 0);
    if (middle.x() < from.x() || middle.x() > to.x() || middle.y() < from.y() || middle.y() > to.y()) continue;
    std::int64_t const top = top_cell(solid, fill, column);
    for (std::int64_t k = 0; k < top; ++k) {
      slices[static_cast<std::size_t>(k)].columns++;
      slices[static_cast<std::size_t>(k)].relative_density +=
          fill[static_cast<std::size_t>(column + k * solid.columns())];
    }
  }
  while (!slices.empty() && slices.back().columns == 0) slices.pop_back();
  for (std::size_t k = 0; k < slices.size(); ++k) {
    slices[k].height = (static_cast<double>(k) + 0.5) * solid.grid.cell;
    slices[k].relative_density /= static_cast<double>(slices[k].columns);
  }
  return slices;
}

}  // namespace layerloop::coupling
