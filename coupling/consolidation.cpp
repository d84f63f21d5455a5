#include "coupling/consolidation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/compensated_sum.hpp"
#include "core/error.hpp"
#include "core/grain_size.hpp"
#include "coupling/effects/shrinkage.hpp"
#include "coupling/grain_clearance.hpp"
#include "coupling/melt_columns.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "coupling/surface_level.hpp"

namespace layerloop::coupling {
namespace {

/// Offset of the heat grid on the solid's lattice [cells]: lattice = heat cell + offset.
std::array<std::int64_t, 3> offset_on_lattice(VoxelGrid const& heat, VoxelGrid const& lattice) {
  std::array<std::int64_t, 3> offset{};
  for (std::size_t a = 0; a < 3; ++a) {
    auto const axis = static_cast<int>(a);
    offset[a] = std::llround((heat.origin[axis] - lattice.origin[axis]) / lattice.cell);
  }
  return offset;
}

/// Melted cells of the heat grid, flagged on the solid's lattice.
std::vector<char> melted_on_lattice(SolidField const& solid, MeltedCells const& melt) {
  auto const offset = offset_on_lattice(melt.grid, solid.grid);
  std::vector<char> melted(static_cast<std::size_t>(solid.grid.size()), 0);
  for (std::int64_t cell = 0; cell < melt.grid.size(); ++cell) {
    if (!melt.flags[static_cast<std::size_t>(cell)]) continue;
    auto const c = melt.grid.coordinates(cell);
    std::array<std::int64_t, 3> const on{c[0] + offset[0], c[1] + offset[1], c[2] + offset[2]};
    if (solid.grid.contains(on)) melted[static_cast<std::size_t>(solid.grid.index(on[0], on[1], on[2]))] = 1;
  }
  return melted;
}

std::vector<char> half_or_more_melted(PowderBed const& bed, std::vector<GrainCells>& grains,
                                      std::vector<char> const& melted, double cell_volume) {
  std::vector<char> taken(bed.size(), 0);
  for (std::size_t g = 0; g < bed.size(); ++g) {
    CompensatedSum sum;
    for (CellVolume const& c : grains[g].cells) {
      if (melted[static_cast<std::size_t>(c.cell)]) sum.add(c.volume);
    }
    grains[g].in_melted_cells = sum.value() * cell_volume;
    taken[g] =
        grains[g].in_melted_cells >= 0.5 * bed.volume(g) * (1 - 1e-12);  // round-off of the shares must not decide
  }
  return taken;
}

/// Columns whose topmost plate cell melted.
std::vector<char> molten_plate(SolidField const& solid, MeltedCells const& melt) {
  auto const offset = offset_on_lattice(melt.grid, solid.grid);
  std::vector<char> molten(static_cast<std::size_t>(solid.columns()), 0);
  std::int64_t const top = -1 - offset[2];  // layer of the heat grid
  for (std::int64_t j = 0; top >= 0 && j < melt.grid.n[1]; ++j) {
    for (std::int64_t i = 0; i < melt.grid.n[0]; ++i) {
      molten[static_cast<std::size_t>(i + offset[0] + solid.grid.n[0] * (j + offset[1]))] =
          melt.flags[static_cast<std::size_t>(melt.grid.index(i, j, top))];
    }
  }
  return molten;
}

/// Splits metal and grains into what is liquid and what stays, and takes the remelted metal out of the field.
MeltColumns liquid_and_rest(SolidField& solid, std::vector<GrainCells> const& grains, std::vector<char> const& taken,
                            std::vector<char> const& melted, double density) {
  MeltColumns columns{solid.grid,
                      fill_fraction(solid, density),
                      std::vector<double>(solid.mass.size(), 0.0),
                      std::vector<double>(solid.mass.size(), 0.0),
                      {}};
  for (std::size_t c = 0; c < melted.size(); ++c) {
    if (!melted[c]) continue;
    columns.liquid[c] = std::exchange(columns.solid[c], 0.0);
    solid.mass[c] = 0;
  }
  for (std::size_t g = 0; g < grains.size(); ++g) {
    std::vector<double>& to = taken[g] ? columns.liquid : columns.grains;
    for (CellVolume const& c : grains[g].cells) to[static_cast<std::size_t>(c.cell)] += c.volume;
  }
  return columns;
}

/// Grains whose centre lies inside the outer surface; enclosed voids are inside.
std::vector<char> inside_surface(SolidField const& solid, PowderBed const& bed, Case const& checked) {
  SurfaceLevel const level = surface_level(solid, checked.material.density, ignored_voids(checked), 1);
  std::vector<char> inside(bed.size(), 0);
  for (std::size_t g = 0; g < bed.size(); ++g) {
    Vec3 const p = (bed.position(g) - solid.grid.origin) / solid.grid.cell;
    bool const over_zone = p.x() > 0 && p.x() < solid.grid.n[0] && p.z() > 0;
    inside[g] = over_zone && level(p) >= 0.5;
  }
  return inside;
}

/// Grains join the field where they are.
void trap(SolidField& solid, PowderBed& bed, std::vector<char> const& trapped, Case const& checked,
          Consolidation& figures) {
  auto const grains = grains_on_lattice(solid, bed, checked, solid.grid.origin.x(), solid.grid.upper().x());
  for (std::size_t g = 0; g < bed.size(); ++g) {
    if (trapped[g]) add_metal(solid, grains[g].cells, checked.material.density);
  }
  take_from_bed(bed, trapped, Fate::trapped, checked, figures);
}

bool any(std::vector<char> const& flags) {
  return std::any_of(flags.begin(), flags.end(), [](char f) { return f != 0; });
}

}  // namespace

std::vector<GrainCells> grains_on_lattice(SolidField& solid, PowderBed const& bed, Case const& checked, double x_from,
                                          double x_to) {
  std::vector<GrainCells> grains(bed.size());
  std::vector<char> chosen(bed.size(), 0);
  double highest = solid.plate_top();
  for (std::size_t g = 0; g < bed.size(); ++g) {
    double const r = bed.radius[g];
    chosen[g] =
        bed.x[g] + r > std::max(x_from, solid.grid.origin.x()) && bed.x[g] - r < std::min(x_to, solid.grid.upper().x());
    if (chosen[g]) highest = std::max(highest, bed.z[g] + r);
  }
  grow(solid, static_cast<std::int32_t>(std::ceil((highest - solid.plate_top()) / solid.grid.cell)) + 2);

  constexpr std::int32_t below = 2;  // layers for what dips into the plate by its contact overlap
  VoxelGrid lattice = solid.grid;
  lattice.origin.z() -= below * lattice.cell;
  lattice.n[2] += below;
  std::int64_t const layer = solid.columns();
  for (std::size_t g = 0; g < bed.size(); ++g) {
    if (!chosen[g]) continue;
    std::vector<GrainShare> const shares = grain_shares(bed, g, lattice, checked.period_y());
    CompensatedSum inside;
    for (GrainShare const& share : shares) inside.add(share.volume);
    double const scale =
        bed.volume(g) / inside.value() / solid.grid.cell_volume();  // a grain's mass is never cut by a wall
    for (GrainShare const& share : shares) {
      std::int64_t const cell = share.cell - below * layer;
      grains[g].cells.push_back({cell >= 0 ? cell : share.cell % layer, share.volume * scale});
    }
  }
  return grains;
}

std::vector<GrainCells> grains_near(SolidField& solid, PowderBed const& bed, Case const& checked,
                                    VoxelGrid const& heated) {
  double const reach = 2 * largest_diameter(checked.powder);
  return grains_on_lattice(solid, bed, checked, heated.origin.x() - reach, heated.upper().x() + reach);
}

double take_from_bed(PowderBed& bed, std::vector<char> const& taken, Fate fate, Case const& checked,
                     Consolidation& figures) {
  CompensatedSum volume;
  std::int64_t count = 0;
  std::vector<char> keep(bed.size(), 1);
  for (std::size_t g = 0; g < bed.size(); ++g) {
    if (!taken[g]) continue;
    keep[g] = 0;
    ++count;
    volume.add(bed.volume(g));
  }
  bed.retain(keep);
  double const mass = checked.material.density * volume.value();
  figures.grains_melted += count;
  if (fate == Fate::trapped) figures.grains_trapped += count;
  figures.melted_mass += mass;
  return mass;
}

void embed(SolidField& solid, PowderBed& bed, TriangleSurface& substrate, Case const& checked, Consolidation& figures) {
  for (;;) {  // ends: every round but the last traps a grain
    for (auto inside = inside_surface(solid, bed, checked); any(inside); inside = inside_surface(solid, bed, checked)) {
      trap(solid, bed, inside, checked, figures);
    }
    substrate = mesh_solid(solid, checked);
    Clearance const clearance = clear_grains(bed, SurfaceDistance(substrate), checked);
    figures.grains_moved = clearance.grains_moved;
    figures.largest_displacement = clearance.largest_displacement;
    if (clearance.stuck.empty()) break;
    std::vector<char> stuck(bed.size(), 0);
    for (std::size_t g : clearance.stuck) stuck[g] = 1;
    trap(solid, bed, stuck, checked, figures);
  }
  figures.triangles = static_cast<std::int64_t>(substrate.triangles.size());
  figures.mesh_volume = enclosed_volume(substrate);
  figures.field_volume = volume_to_mesh(solid, checked);
  figures.part_relative_density = part_relative_density(solid, checked.material.density);
}

void check_mass(SolidField const& solid, double mass_before, Consolidation const& figures) {
  double const expected = mass_before + figures.melted_mass, found = metal_mass(solid);
  if (std::abs(found - expected) <= 1e-12 * expected) return;
  throw PhysicsError(fmt::format(
      "the solid holds {:.17g} kg where {:.17g} kg went in (consolidation lost or made mass) please report this case",
      found, expected));
}

MeltedDown melt_down(SolidField& solid, PowderBed const& bed, std::vector<GrainCells>& grains, MeltedCells const& melt,
                     double levelling_length, Case const& checked) {
  double const density = checked.material.density;
  std::vector<char> const melted = melted_on_lattice(solid, melt);
  MeltedDown down{.taken = half_or_more_melted(bed, grains, melted, solid.grid.cell_volume())};
  MeltColumns columns = liquid_and_rest(solid, grains, down.taken, melted, density);
  columns.molten_plate = molten_plate(solid, melt);
  columns.expansion = liquid_expansion(checked);
  SettledMelt const settled = settle_melt(columns, std::max(levelling_length, solid.grid.cell));
  down.mean_height_change = settled.mean_height_change;
  add_metal(solid, settled.metal, density);
  return down;
}

Consolidation consolidate(SolidField& solid, PowderBed& bed, TriangleSurface& substrate, MeltRecord const& melt,
                          CellContent const& cells, Case const& checked) {
  Consolidation figures;
  double const density = checked.material.density, mass_before = metal_mass(solid);
  auto grains = grains_near(solid, bed, checked, cells.grid);
  MeltedDown const down = melt_down(solid, bed, grains, {melt.grid, melt.melted}, 0.5 * melt.pool.width, checked);
  CompensatedSum in_melted_cells;
  for (GrainCells const& grain : grains) in_melted_cells.add(grain.in_melted_cells);
  figures.melted_cell_mass = density * in_melted_cells.value();
  figures.surface_height_correction = down.mean_height_change;
  take_from_bed(bed, down.taken, Fate::melted, checked, figures);

  embed(solid, bed, substrate, checked, figures);
  check_mass(solid, mass_before, figures);
  return figures;
}

}  // namespace layerloop::coupling
