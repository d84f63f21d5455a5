#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/optical_constants.hpp"
#include "coupling/exposure.hpp"
#include "coupling/melt_surface.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "raytrace/fresnel.hpp"
#include "tests/coupling/solid_scenes.hpp"
#include "thermal/expose.hpp"

namespace layerloop::coupling {
namespace {

/// A track of 300 um at 1.5 m/s with a spot of 60 um over three layers of 316L grains, hexagonal layers over one
/// another as far as a width of 105 um lets them.
struct TrackOnPowder {
  Case checked = small_case();
  SolidField solid;
  PowderBed bed;
  TriangleSurface substrate;
  CellContent cells;

  TrackOnPowder() {
    checked.material = built_in_materials().at("316L");
    checked.machine.deposition_length = 480 * um;
    checked.machine.width = 105 * um;
    checked.machine.layer_thickness = 80 * um;
    checked.heat.substrate_depth = 60 * um;
    checked.heat.margin = 60 * um;
    checked.heat.ambient_temperature = 298;
    checked.heat.pool_isotherm = "liquidus";
    checked.heat.powder_contact_conductivity = 0.3;
    checked.laser.spot_diameter = 60 * um;
    checked.laser.wavelength = 1070e-9;
    checked.material.refractive_index = optical_data(checked.material.optical_data)(checked.laser.wavelength);
    checked.optics.rays = 4000;
    checked.optics.position_spacing = 15 * um;
    checked.scan.kind = ScanKind::track;
    checked.scan.tracks = 1;
    checked.scan.scan_speed = 1.5;
    checked.scan.track_length = 300 * um;
    for (char const* effect : {"latent_heat", "variable_conductivity", "evaporation", "surface_losses"})
      checked.effects[effect] = {.enabled = true};
    solid = lowered_plate(checked);
    substrate = mesh_solid(solid, checked);
    double const d = 26.25 * um, rise = std::sqrt(2.0 / 3.0) * d;
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 18; ++i)
        for (int j = 0; j < 4; ++j)
          bed.add(static_cast<std::int64_t>(bed.size()),
                  {120 * um + (i + 0.5 + 0.25 * (l % 2)) * d, std::fmod((j + 0.5 * (i % 2) + 0.3 * l) * d, 105 * um),
                   -80 * um + 0.5 * d + l * rise},
                  0.5 * d, 0);
    cells = cell_content(solid, bed, checked, 120 * um, 600 * um);
  }

  struct Outcome {
    double absorptivity, molten;
  };
  Outcome expose(double power, bool retrace) {
    checked.laser.power = power;
    Communicator const comm;
    Exposure exposure = plan_exposure(checked, 1);
    MeltSurface surface(solid, bed, substrate, cells, checked);
    double molten = 0;
    auto const absorbed_now = [&](std::size_t stretch, MeltState const& now) {
      std::vector<char> const melted = now.melted();
      if (retrace) surface.update(now);
      molten = static_cast<double>(std::ranges::count(melted, 1));
      expose_stretch(exposure, stretch, now, surface.scene(), cells, checked, 1, comm);
    };
    thermal::expose(cells, exposure.source, checked, comm, thermal::Report::silent, absorbed_now);
    EXPECT_LT(exposure.worst_ray_energy_error, 1e-12);
    return {exposure.mean.absorptivity, molten * cells.grid.cell_volume()};
  }
};

TEST(Retrace, AbsorptivityFallsWhenTheGrainsUnderTheBeamMeltFlat) {
  TrackOnPowder track;
  auto const faint = track.expose(10, true), low = track.expose(40, true), high = track.expose(80, true),
             as_spread = track.expose(80, false);
  EXPECT_NEAR(track.expose(10, false).absorptivity, as_spread.absorptivity, 1e-12) << "optics do not know the power";
  EXPECT_NEAR(faint.absorptivity, as_spread.absorptivity, 1e-3) << "hardly a grain melts";
  EXPECT_LT(low.absorptivity, as_spread.absorptivity - 0.02);
  EXPECT_LT(high.absorptivity, low.absorptivity - 0.02);
  double const flat = 1 - raytrace::fresnel_reflectance(track.checked.material.refractive_index, 1).average();
  EXPECT_GT(high.absorptivity, flat) << "the front of the beam still meets powder";
  EXPECT_GT(high.molten, low.molten);
}

}  // namespace
}  // namespace layerloop::coupling
