#include "coupling/consolidation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/compensated_sum.hpp"
#include "coupling/freeze_zone.hpp"
#include "coupling/melt_columns.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "tests/coupling/solid_scenes.hpp"

namespace layerloop::coupling {
namespace {

Vec3 at(double x, double y, double above_plate) { return Vec3(120 * um + x, y, -30 * um + above_plate); }

/// Grains at random places without overlap on the plate, up to `height`.
PowderBed scattered_bed(int wanted, double height) {
  PowderBed bed;
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int tries = 0; tries < 400000 && static_cast<int>(bed.size()) < wanted; ++tries) {
    double const r = uniform(generator) < 0.5 ? 6.5 * um : 14 * um;
    Vec3 const p = at(r + uniform(generator) * (200 * um - 2 * r), uniform(generator) * 100 * um,
                      r + uniform(generator) * (height - 2 * r));
    bool free = true;
    for (std::size_t g = 0; g < bed.size() && free; ++g) {
      Vec3 d = bed.position(g) - p;
      d.y() -= 100 * um * std::round(d.y() / (100 * um));
      free = d.norm() >= bed.radius[g] + r;
    }
    if (free) bed.add(static_cast<std::int64_t>(bed.size()), p, r, 0);
  }
  return bed;
}

double volume_of(std::vector<CellVolume> const& metal) {
  CompensatedSum sum;
  for (CellVolume const& m : metal) sum.add(m.volume);
  return sum.value();
}

MeltColumns empty_columns(std::int32_t nx, std::int32_t ny, std::int32_t nz) {
  MeltColumns melt{
      {Vec3::Zero(), 5 * um, {nx, ny, nz}}, {}, {}, {}, std::vector<char>(static_cast<std::size_t>(nx * ny), 0)};
  for (auto* values : {&melt.solid, &melt.grains, &melt.liquid})
    values->assign(static_cast<std::size_t>(nx * ny * nz), 0.0);
  return melt;
}

TEST(MeltColumns, SlabOfPackingPShrinksToPTimesItsHeight) {
  for (double p : {0.4, 0.55, 0.61}) {
    MeltColumns melt = empty_columns(6, 5, 12);
    for (std::size_t c = 0; c < melt.liquid.size(); ++c) melt.liquid[c] = p;
    std::vector<double> fill(melt.liquid.size(), 0.0);
    for (CellVolume const& m : settle_melt(melt, 30 * um).metal) fill[static_cast<std::size_t>(m.cell)] += m.volume;
    for (std::int64_t c = 0; c < melt.grid.size(); ++c) {
      double const expected = std::clamp(12 * p - static_cast<double>(melt.grid.coordinates(c)[2]), 0.0, 1.0);
      EXPECT_NEAR(fill[static_cast<std::size_t>(c)], expected, 1e-12);
    }
  }
}

TEST(MeltColumns, MeltRestsOnAGrainThatStaysAndTheVoidBelowStays) {
  MeltColumns melt = empty_columns(1, 1, 10);
  melt.grains[4] = 0.9;
  melt.liquid[7] = 0.8;
  melt.liquid[1] = 0.3;
  std::vector<double> fill(10, 0.0);
  for (CellVolume const& m : settle_melt(melt, 0).metal) fill[static_cast<std::size_t>(m.cell)] += m.volume;
  EXPECT_NEAR(fill[0], 0.3, 1e-15) << "what is below the grain falls on the plate";
  EXPECT_NEAR(fill[1] + fill[2] + fill[3], 0, 1e-15) << "the void stays";
  EXPECT_NEAR(fill[4], 0.1, 1e-15) << "the room beside the grain";
  EXPECT_NEAR(fill[5], 0.7, 1e-15);
}

/// The free decay of a sine: each sweep multiplies its amplitude by 1 - 2 c (1 - cos q).
TEST(MeltColumns, LevellingDampsAWaveAtItsKnownRateAndKeepsTheVolume) {
  constexpr int ny = 40;
  double const length = 15 * um;
  MeltColumns melt = empty_columns(3, ny, 20);
  auto const height = [&](int j) { return 10 + 2 * std::sin(2 * M_PI * j / ny); };
  for (std::int64_t c = 0; c < melt.grid.size(); ++c) {
    auto const [i, j, k] = melt.grid.coordinates(c);
    melt.liquid[static_cast<std::size_t>(c)] = std::clamp(height(j) - k, 0.0, 1.0);
  }
  SettledMelt const settled = settle_melt(melt, length);
  EXPECT_NEAR(volume_of(settled.metal), 3 * ny * 10.0, 1e-10);
  std::vector<double> column(3 * ny, 0.0);
  for (CellVolume const& m : settled.metal) column[static_cast<std::size_t>(m.cell % (3 * ny))] += m.volume;
  double const sweeps = std::ceil(9 / 0.4), decay = std::pow(1 - 0.4 * (1 - std::cos(2 * M_PI / ny)), sweeps);
  for (int j = 0; j < ny; ++j)
    EXPECT_NEAR(column[static_cast<std::size_t>(1 + 3 * j)], 10 + 2 * decay * std::sin(2 * M_PI * j / ny), 1e-9);
}

TEST(MeltColumns, NothingFlowsIntoColumnsWithoutMelt) {
  MeltColumns melt = empty_columns(9, 1, 10);
  for (std::int64_t k = 0; k < 10; ++k) melt.liquid[static_cast<std::size_t>(melt.grid.index(4, 0, k))] = 0.7;
  for (CellVolume const& m : settle_melt(melt, 50 * um).metal) EXPECT_EQ(m.cell % 9, 4);
}

TEST(MeltColumns, MeltRunsOverMoltenPlateUntilItIsLevel) {
  MeltColumns melt = empty_columns(9, 1, 10);
  for (std::int64_t k = 0; k < 10; ++k) melt.liquid[static_cast<std::size_t>(melt.grid.index(4, 0, k))] = 0.7;
  for (std::size_t i = 2; i < 9; ++i) melt.molten_plate[i] = 1;
  std::vector<double> column(9, 0.0);
  for (CellVolume const& m : settle_melt(melt, 100 * um).metal)
    column[static_cast<std::size_t>(m.cell % 9)] += m.volume;
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(column[i], i < 2 ? 0.0 : 1.0, 1e-3) << i;
}

/// A grain whose centre lies at a height where a known part of its volume is molten: below the plane at `t` from its
/// centre.
TEST(Consolidation, HalfOrMoreMeltsTheWholeGrain) {
  Case const checked = small_case();
  for (double const share : {0.45, 0.49, 0.51, 0.55}) {
    SolidField solid = lowered_plate(checked);
    PowderBed bed;
    // Molten is the left of the lattice plane x = 80 um; the volume share left of a plane at distance t of the centre
    // is 1/2 + 3 t / (4 r) - t^3 / (4 r^3).
    double const r = 14 * um;
    double t = 0;
    for (int newton = 0; newton < 50; ++newton) {
      double const u = t / r, f = 0.5 + 0.75 * u - 0.25 * u * u * u - share;
      t -= r * f / (0.75 - 0.75 * u * u);
    }
    bed.add(3, at(80 * um - t, 50 * um, r * 1.0001), r, 0);
    bed.add(9, at(150 * um, 50 * um, 30 * um), 13 * um, 0);
    CellContent const cells = cell_content(solid, bed, checked, 0, 1);
    double const plane = 120 * um + 80 * um;
    MeltRecord const melt = melt_where(cells.grid, [&](Vec3 const& p) { return p.x() < plane; });
    TriangleSurface substrate;
    double const grain_mass = 8190 * bed.volume(0);
    Consolidation const figures = consolidate(solid, bed, substrate, melt, cells, checked);
    EXPECT_EQ(figures.grains_melted, share > 0.5 ? 1 : 0) << share;
    EXPECT_EQ(bed.size(), share > 0.5 ? 1u : 2u);
    EXPECT_NEAR(figures.melted_cell_mass / grain_mass, share, 0.005);
    EXPECT_NEAR(metal_mass(solid), share > 0.5 ? grain_mass : 0.0, 1e-15 * grain_mass);
    EXPECT_EQ(figures.grains_trapped, 0);
  }
}

TEST(Consolidation, MassIsExactAndNoGrainThatStaysOverlapsTheSurface) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  PowderBed bed = scattered_bed(70, 60 * um);
  ASSERT_GT(bed.size(), 50u);
  for (std::size_t g = 1; g < bed.size(); ++g) bed.contacts.push_back({bed.id[g - 1], bed.id[g], {1e-9, 0, 0}});
  PowderBed const before = bed;
  CellContent const cells = cell_content(solid, bed, checked, 0, 1);
  auto const pool = [](Vec3 const& p) {
    double const across = p.y() - 50 * um;
    return p.x() > 160 * um && p.x() < 280 * um && across * across < std::pow(32 * um, 2);
  };
  TriangleSurface substrate;
  Consolidation const figures =
      consolidate(solid, bed, substrate, melt_where(cells.grid, pool, 64 * um), cells, checked);
  EXPECT_GT(figures.grains_melted, 10);
  EXPECT_GT(figures.grains_moved, 0);
  EXPECT_GT(figures.surface_height_correction, 0);
  EXPECT_EQ(static_cast<std::size_t>(figures.grains_melted) + bed.size(), before.size());

  // Mass, grain by grain, against the field.
  CompensatedSum melted;
  for (std::size_t g = 0; g < before.size(); ++g) {
    if (!std::binary_search(bed.id.begin(), bed.id.end(), before.id[g])) melted.add(8190 * before.volume(g));
  }
  EXPECT_NEAR(metal_mass(solid) / melted.value(), 1, 1e-15);
  EXPECT_NEAR(figures.melted_mass / melted.value(), 1, 1e-15);
  double const full = 8190 * solid.grid.cell_volume();
  for (double m : solid.mass) EXPECT_LE(m, full * (1 + 1e-12));

  EXPECT_NO_THROW(check_substrate(substrate));
  EXPECT_NEAR(figures.mesh_volume / figures.field_volume, 1, 0.01);
  for (std::size_t g = 0; g < bed.size(); ++g) {
    EXPECT_GE(gap_to_surface(bed, g, substrate), 0) << "grain " << bed.id[g];
    EXPECT_GE(bed.x[g] - bed.radius[g], 120 * um - 1e-3 * bed.radius[g]);
    EXPECT_LE(bed.x[g] + bed.radius[g], 320 * um + 1e-3 * bed.radius[g]);
    EXPECT_TRUE(bed.y[g] >= 0 && bed.y[g] < 100 * um);
    for (std::size_t h = 0; h < g; ++h) {
      Vec3 d = bed.position(g) - bed.position(h);
      d.y() -= 100 * um * std::round(d.y() / (100 * um));
      EXPECT_GE(d.norm(), bed.radius[g] + bed.radius[h] - 1e-3 * std::min(bed.radius[g], bed.radius[h]));
    }
  }
}

TEST(Consolidation, SameBitsTwice) {
  Case const checked = small_case();
  auto const run = [&](SolidField& solid, PowderBed& bed, TriangleSurface& substrate) {
    CellContent const cells = cell_content(solid, bed, checked, 0, 1);
    consolidate(solid, bed, substrate,
                melt_where(
                    cells.grid, [](Vec3 const& p) { return p.x() < 200 * um; }, 40 * um),
                cells, checked);
  };
  SolidField solid_a = lowered_plate(checked), solid_b = solid_a;
  PowderBed bed_a = scattered_bed(60, 50 * um), bed_b = bed_a;
  TriangleSurface surface_a, surface_b;
  run(solid_a, bed_a, surface_a);
  run(solid_b, bed_b, surface_b);
  EXPECT_EQ(solid_a.mass, solid_b.mass);
  EXPECT_EQ(surface_a.vertices, surface_b.vertices);
  EXPECT_EQ(surface_a.triangles, surface_b.triangles);
  EXPECT_EQ(bed_a.x, bed_b.x);
  EXPECT_EQ(bed_a.z, bed_b.z);
}

/// Powder that melts from above but not at the bottom: melt lies on a grain that stays, and the void around it stays
/// too.
TEST(Consolidation, UnmeltedGrainUnderTheMeltLowersTheRelativeDensity) {
  Case const checked = small_case();
  auto const density_with_melt_above = [&](double height) {
    SolidField solid = lowered_plate(checked);
    PowderBed bed;
    double const r = 20 * um;
    std::int64_t id = 0;
    for (int layer = 0; layer < 2; ++layer) {
      for (double x : {60.0, 100.0, 140.0}) {
        for (double y : {10.0, 50.0, 90.0}) bed.add(id++, at(x * um, y * um, r + 2 * layer * r), r, 0);
      }
    }
    double const all = 8190 * total_volume(bed);
    CellContent const cells = cell_content(solid, bed, checked, 0, 1);
    TriangleSurface substrate;
    Consolidation const figures =
        consolidate(solid, bed, substrate,
                    melt_where(
                        cells.grid, [&](Vec3 const& p) { return p.z() > -30 * um + height; }, 40 * um),
                    cells, checked);
    double in_bed = 0;
    for (std::size_t g = 0; g < bed.size(); ++g) {
      in_bed += 8190 * bed.volume(g);
      EXPECT_GE(gap_to_surface(bed, g, substrate), 0);
    }
    EXPECT_NEAR((metal_mass(solid) + in_bed) / all, 1, 1e-14);
    return figures.part_relative_density;
  };
  double const melted_through = density_with_melt_above(0), upper_layer_only = density_with_melt_above(40 * um);
  EXPECT_GT(melted_through, 1 - 1e-9);
  EXPECT_LT(upper_layer_only, 0.95);
}

TEST(Consolidation, RemeltedMetalFillsTheVoidUnderIt) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  fill_field(solid, 8190,
             [](int i, int j, int k) { return i >= 8 && i < 20 && j >= 4 && j < 16 && k >= 4 && k < 8 ? 1.0 : 0.0; });
  double const mass = metal_mass(solid);
  EXPECT_NEAR(part_relative_density(solid, 8190), 0.5, 1e-12);
  PowderBed bed;
  CellContent const cells = cell_content(solid, bed, checked, 0, 1);
  TriangleSurface substrate;
  Consolidation const figures = consolidate(solid, bed, substrate,
                                            melt_where(
                                                cells.grid, [](Vec3 const&) { return true; }, 40 * um),
                                            cells, checked);
  EXPECT_NEAR(figures.part_relative_density, 1, 1e-12);
  EXPECT_NEAR(metal_mass(solid) / mass, 1, 1e-15);
  EXPECT_EQ(figures.grains_melted, 0);
}

/// The melt of a thick slab of powder swallows a small grain that did not melt.
TEST(Consolidation, GrainInsideTheMeltIsTrappedWithItsWholeMass) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  PowderBed bed;
  bed.add(1, at(100 * um, 50 * um, 6.6 * um), 6.5 * um, 0);
  fill_field(solid, 8190, [](int i, int j, int k) {
    return k < 8 && (i < 17 || i > 22 || j < 7 || j > 12) ? 1.0 : k >= 3 && k < 8 ? 1.0 : 0.0;
  });
  double const before = metal_mass(solid), grain = 8190 * bed.volume(0);
  CellContent const cells = cell_content(solid, bed, checked, 0, 1);
  TriangleSurface substrate;
  Consolidation const figures =
      consolidate(solid, bed, substrate, melt_where(cells.grid, [](Vec3 const&) { return false; }), cells, checked);
  EXPECT_EQ(figures.grains_trapped, 1);
  EXPECT_EQ(figures.grains_melted, 1);
  EXPECT_EQ(bed.size(), 0u);
  EXPECT_NEAR((metal_mass(solid)) / (before + grain), 1, 1e-15);
  EXPECT_LT(figures.part_relative_density, 1 - 1e-4);
}

TEST(Transfer, ContentIsConservativeAndNeverOverfull) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  fill_field(solid, 8190, [](int i, int, int k) { return i < 10 ? std::clamp(2.5 - k, 0.0, 1.0) : 0.0; });
  PowderBed bed;
  bed.add(0, at(100 * um, 0, 14 * um), 14 * um, 0);
  bed.add(1, at(150 * um, 40 * um, 10 * um), 6.5 * um, 0);
  CellContent const content = cell_content(solid, bed, checked, 121 * um, 400 * um);
  EXPECT_EQ(content.grid.n[0], 40);
  EXPECT_EQ(content.grid.n[1], 20);
  EXPECT_NEAR(content.grid.origin.z(), -70 * um, 1e-15);
  CompensatedSum metal, powder;
  for (std::size_t c = 0; c < content.solid.size(); ++c) {
    EXPECT_LE(content.solid[c] + content.powder[c], 1 + 1e-15);
    EXPECT_EQ(content.grain[c] >= 0, content.powder[c] > 0);
    metal.add(content.solid[c]);
    powder.add(content.powder[c]);
  }
  EXPECT_NEAR(metal.value(), 40 * 20 * 8 + 10 * 20 * 2.5, 1e-9);
  EXPECT_NEAR(powder.value() * content.grid.cell_volume() / total_volume(bed), 1, 1e-12);
}

TEST(FreezeZone, MassIsExactPoresStayAndTheMeshCoversTheGrains) {
  Case checked = small_case();
  checked.machine.frozen_zone = {{170 * um, 270 * um}};
  SolidField solid = lowered_plate(checked);
  PowderBed bed = scattered_bed(70, 60 * um);
  PowderBed const before = bed;
  TriangleSurface substrate;
  Consolidation const figures = freeze_zone(solid, bed, substrate, checked);
  EXPECT_NO_THROW(check_substrate(substrate));
  SurfaceDistance const distance(substrate);
  CompensatedSum frozen;
  for (std::size_t g = 0; g < before.size(); ++g) {
    bool const stays = std::binary_search(bed.id.begin(), bed.id.end(), before.id[g]);
    EXPECT_FALSE(stays && before.x[g] >= 170 * um && before.x[g] <= 270 * um);
    if (stays) continue;
    frozen.add(8190 * before.volume(g));
    // The summit of every frozen grain lies under the mesh, to the third of a bin that the curvature of small grains
    // hides in it.
    Vec3 const summit = before.position(g) + Vec3(0, 0, before.radius[g]);
    Vec3 const nearest = distance.closest_point(summit);
    bool const covered = winding_number(summit, substrate) > 0.5 || (nearest - summit).norm() < 5 * um / 3;
    EXPECT_TRUE(covered) << "grain " << before.id[g] << " off by " << (nearest - summit).norm();
  }
  EXPECT_NEAR(metal_mass(solid) / frozen.value(), 1, 1e-15);
  EXPECT_LT(figures.part_relative_density, 0.9);
  EXPECT_EQ(static_cast<std::size_t>(figures.grains_melted) + bed.size(), before.size());
  for (std::size_t g = 0; g < bed.size(); ++g) EXPECT_GE(gap_to_surface(bed, g, substrate), 0);
}

}  // namespace
}  // namespace layerloop::coupling
