#include "coupling/melt_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "coupling/part_surface_cgal.hpp"
#include "raytrace/fresnel.hpp"
#include "raytrace/trace.hpp"
#include "tests/coupling/solid_scenes.hpp"

namespace layerloop::coupling {
namespace {

constexpr std::complex<double> steel{2.96, 4.01};

MeltState state(std::vector<char> melted) {
  return {.melted = [=] { return melted; }, .keyhole = {}};
}

/// A square layer of touching grains over the whole pit of 200 x 100 um.
struct Layer {
  Case checked = small_case();
  SolidField solid = lowered_plate(checked);
  PowderBed bed;
  TriangleSurface substrate = mesh_solid(solid, checked);
  CellContent cells;

  Layer() {
    checked.laser.spot_diameter = 60 * um;
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j < 5; ++j)
        bed.add(static_cast<std::int64_t>(bed.size()), {(130 + 20 * i) * um, (10 + 20 * j) * um, -20 * um}, 10 * um, 0);
    cells = cell_content(solid, bed, checked, 120 * um, 320 * um);
  }
  double absorptivity(raytrace::BedScene const& scene) const {
    raytrace::Beam const beam{.centre = {220 * um, 50 * um, 0},
                              .power = 1,
                              .profile = raytrace::BeamProfile::uniform,
                              .size_x = 120 * um,
                              .size_y = 100 * um};
    std::vector const metals{steel};
    return raytrace::trace(scene, beam, metals, 0, cells.grid, {.rays = 8000}).absorptivity;
  }
};

TEST(MeltSurface, GrainsThatMeltFlatAbsorbAsAMirrorDoes) {
  Layer const layer;
  MeltSurface surface(layer.solid, layer.bed, layer.substrate, layer.cells, layer.checked);
  double const powder = layer.absorptivity(surface.scene());
  surface.update(state(std::vector<char>(static_cast<std::size_t>(layer.cells.grid.size()), 1)));
  double const flat = 1 - raytrace::fresnel_reflectance(steel, 1).average();
  EXPECT_NEAR(layer.absorptivity(surface.scene()), flat, 1e-3);
  EXPECT_GT(powder, flat + 0.1) << "between grains the light is caught";

  // 50 grains over 200 x 100 um: the film lies where their volume puts it.
  raytrace::Hit const hit = surface.scene().first_hit({{220 * um, 50 * um, 100 * um}, -Vec3::UnitZ()});
  EXPECT_EQ(hit.target, raytrace::Target::substrate);
  double const film = 50 * layer.bed.volume(0) / (200 * um * 100 * um);
  EXPECT_NEAR(hit.point.z(), -30 * um + film, 0.02 * layer.checked.heat.cell_size);
}

TEST(MeltSurface, WhereNothingMeltedGrainsAndPlateStayAsTheyAre) {
  Layer const layer;
  MeltSurface surface(layer.solid, layer.bed, layer.substrate, layer.cells, layer.checked);
  raytrace::BedScene const* const first = &surface.scene();
  std::vector<char> melted(static_cast<std::size_t>(layer.cells.grid.size()), 0);
  surface.update(state(melted));
  EXPECT_EQ(&surface.scene(), first) << "no scene is built anew without new melt";
  for (std::int64_t cell = 0; cell < layer.cells.grid.size(); ++cell)
    melted[static_cast<std::size_t>(cell)] = cell % layer.cells.grid.n[0] < 12;  // x < 180 um: the first three rows
  surface.update(state(melted));
  EXPECT_EQ(surface.scene().grains(), 35);
  for (double x = 200 * um; x < 310 * um; x += 3.3 * um) {
    raytrace::Ray const ray{{x, 31.7 * um, 100 * um}, -Vec3::UnitZ()};
    raytrace::BedScene const before(layer.bed, layer.substrate, {0, layer.checked.machine.width});
    EXPECT_NEAR(surface.scene().first_hit(ray).point.z(), before.first_hit(ray).point.z(), 1e-12);
  }
}

}  // namespace
}  // namespace layerloop::coupling
