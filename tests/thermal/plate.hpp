#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "thermal/expose.hpp"

namespace layerloop::thermal {

inline double constexpr infinite = std::numeric_limits<double>::infinity();

/// Metal whose k and cp do not change; nothing melts, boils or radiates unless a test says so.
inline Material constant_metal(double conductivity, double density, double specific_heat) {
  Material m;
  m.name = "constant";
  m.density = density;
  m.conductivity = {{298}, {conductivity}};
  m.specific_heat = {{298}, {specific_heat}};
  m.solidus = m.liquidus = 1708;
  m.boiling_point = 2e4;
  m.heat_of_vaporisation = 6e6;
  m.molar_mass = 0.056;
  return m;
}

/// A block that is all solid.
inline CellContent solid_block(double cell, std::array<std::int32_t, 3> n) {
  CellContent content;
  content.grid.cell = cell;
  content.grid.n = n;
  auto const size = static_cast<std::size_t>(content.grid.size());
  content.solid.assign(size, 1);
  content.powder.assign(size, 0);
  content.grain.assign(size, -1);
  return content;
}

/// A plate of IN718 whose top is z = 0, and five grains that touch it. y is periodic, the grains lie mirrored about the
/// middle of y. Cells of 5 um.
inline CellContent plate_with_grains(std::array<std::int32_t, 3> n, std::int32_t plate_cells) {
  CellContent content = solid_block(5e-6, n);
  VoxelGrid& grid = content.grid;
  grid.origin = {0, 0, -plate_cells * grid.cell};
  double const length = n[0] * grid.cell, width = n[1] * grid.cell;
  PowderBed bed;
  std::array<Vec3, 5> const grains{Vec3{0.5, 0.5, 16e-6}, Vec3{0.3, 0.25, 11e-6}, Vec3{0.3, 0.75, 11e-6},
                                   Vec3{0.75, 0.3, 14e-6}, Vec3{0.75, 0.7, 14e-6}};
  for (Vec3 const& g : grains)
    bed.add(static_cast<std::int64_t>(bed.size()), {g.x() * length, g.y() * width, g.z()}, g.z(), 0);
  for (std::int64_t c = 0; c < grid.size(); ++c) {
    if (grid.coordinates(c)[2] >= plate_cells) content.solid[static_cast<std::size_t>(c)] = 0;
  }
  for (std::size_t row = 0; row < bed.size(); ++row) {
    for (GrainShare const& share : grain_shares(bed, row, grid, width)) {
      auto const c = static_cast<std::size_t>(share.cell);
      content.powder[c] = std::min(content.powder[c] + share.volume / grid.cell_volume(), 1 - content.solid[c]);
      if (content.powder[c] > 0) content.grain[c] = static_cast<std::int32_t>(row);
    }
  }
  return content;
}

/// Power of a Gaussian beam on the topmost metal of every column of cells, one track along x in the middle of y.
inline HeatSource beam_from_above(CellContent const& content, double absorbed, double radius, double speed, double x0,
                                  double x1) {
  VoxelGrid const& grid = content.grid;
  HeatSource source;
  double const y = grid.cell * grid.n[1] / 2, step = 2 * grid.cell;
  source.time.push_back(0);
  for (double x = x0 + step / 2; x < x1; x += step) {
    AbsorbedPower power;
    for (std::int32_t j = 0; j < grid.n[1]; ++j) {
      for (std::int32_t i = 0; i < grid.n[0]; ++i) {
        Vec3 const c = grid.centre(i, j, 0);
        double const r2 = std::pow(c.x() - x, 2) + std::pow(c.y() - y, 2);
        double const watts = absorbed * 2 / (3.14159265 * radius * radius) * std::exp(-2 * r2 / (radius * radius)) *
                             grid.cell * grid.cell;
        if (watts < 1e-6 * absorbed) continue;
        std::int32_t k = grid.n[2] - 1;
        auto const metal = [&](std::int32_t at) {
          auto const cell = static_cast<std::size_t>(grid.index(i, j, at));
          return content.solid[cell] + content.powder[cell];
        };
        while (metal(k) == 0) --k;
        power.cell.push_back(grid.index(i, j, k));
        power.watts.push_back(watts);
      }
    }
    source.power.push_back(power);
    source.time.push_back(source.time.back() + step / speed);
  }
  source.tracks.push_back({{x0, y, 0}, {x1, y, 0}, 0, source.time.back(), absorbed});
  return source;
}

/// No heat leaves.
inline HeatSettings closed_settings(double cell) {
  HeatSettings settings;
  settings.cell_size = cell;
  settings.substrate_depth = settings.margin = infinite;
  settings.ambient_temperature = 298;
  settings.solver = HeatSolver::explicit_steps;
  settings.powder_contact_conductivity = 0.3;
  settings.pool_isotherm = "liquidus";
  return settings;
}

/// One interval of power in the cells named.
inline HeatSource constant_source(std::vector<std::int64_t> cells, double watts_each, double duration) {
  AbsorbedPower power;
  power.watts.assign(cells.size(), watts_each);
  power.cell = std::move(cells);
  return {{0, duration}, {power}, {}};
}

/// Gaussian surface flux on the top cells of a plate, one straight track along x at y = `y`, integrated over each cell.
inline HeatSource gaussian_track(VoxelGrid const& grid, double absorbed, double d4sigma, double speed, double x0,
                                 double x1, double y, double spacing) {
  double const sigma = d4sigma / 4, s = std::sqrt(2.0) * sigma;
  HeatSource source;
  source.time.push_back(0);
  auto const intervals = static_cast<int>(std::ceil((x1 - x0) / spacing));
  double const dx = (x1 - x0) / intervals;
  std::int32_t const top = grid.n[2] - 1;
  for (int m = 0; m < intervals; ++m) {
    AbsorbedPower power;
    double const x = x0 + (m + 0.5) * dx;
    for (std::int32_t j = 0; j < grid.n[1]; ++j) {
      for (std::int32_t i = 0; i < grid.n[0]; ++i) {
        Vec3 const c = grid.centre(i, j, top);
        double const h = grid.cell / 2;
        double const in_x = 0.5 * (std::erf((c.x() + h - x) / s) - std::erf((c.x() - h - x) / s));
        double const in_y = 0.5 * (std::erf((c.y() + h - y) / s) - std::erf((c.y() - h - y) / s));
        double const watts = absorbed * in_x * in_y;
        if (watts < 1e-9 * absorbed) continue;
        power.cell.push_back(grid.index(i, j, top));
        power.watts.push_back(watts);
      }
    }
    source.power.push_back(power);
    source.time.push_back((m + 1) * dx / speed);
  }
  source.tracks.push_back({{x0, y, 0}, {x1, y, 0}, 0, source.time.back(), absorbed});
  return source;
}

inline Effects effects_on(std::initializer_list<char const*> names) {
  Effects effects;
  for (char const* name : {"latent_heat", "variable_conductivity", "evaporation", "surface_losses"}) effects[name] = {};
  for (char const* name : names) effects[name] = {true, 1};
  return effects;
}

}  // namespace layerloop::thermal
