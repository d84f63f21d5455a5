// What the effects plume_attenuation and spot_drift do to the beam, stop by stop.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/optical_constants.hpp"
#include "coupling/exposure.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "tests/coupling/solid_scenes.hpp"

namespace layerloop::coupling {
namespace {

/// A track along x over a bare plate wide enough for the spot.
struct BarePlate {
  Case checked = small_case();
  TriangleSurface substrate;
  CellContent cells;

  BarePlate() {
    checked.material = built_in_materials().at("316L");
    checked.machine.deposition_length = 400 * um;
    checked.machine.width = 300 * um;
    checked.laser.power = 100;
    checked.laser.spot_diameter = 60 * um;
    checked.laser.wavelength = 1070e-9;
    checked.material.refractive_index = optical_data(checked.material.optical_data)(checked.laser.wavelength);
    checked.optics.rays = 20000;
    checked.optics.position_spacing = 20 * um;
    checked.scan.kind = ScanKind::track;
    checked.scan.scan_speed = 1;
    checked.scan.track_length = 60 * um;
    SolidField const solid = lowered_plate(checked);
    substrate = mesh_solid(solid, checked);
    cells = cell_content(solid, {}, checked, 120 * um, 520 * um);
  }

  /// Exposes all stretches, with this vapour rate before each; the powers stay in `source`.
  Exposure expose(double vapour_rate = 0, std::int32_t layer = 1) const {
    Exposure exposure = plan_exposure(checked, layer);
    raytrace::BedScene const scene({}, substrate, std::array{0.0, checked.machine.width});
    MeltState now;
    now.vapour_rate = vapour_rate;
    for (std::size_t i = 0; i < exposure.source.power.size(); ++i)
      expose_stretch(exposure, i, now, scene, cells, checked, layer, Communicator());
    return exposure;
  }

  /// Variance of the absorbed power along x about its mean, without that of a cell's own width [m^2].
  double second_moment(AbsorbedPower const& power) const {
    double sum = 0, first = 0, second = 0;
    for (std::size_t c = 0; c < power.cell.size(); ++c) {
      auto const [i, j, k] = cells.grid.coordinates(power.cell[c]);
      double const x = cells.grid.centre(i, j, k).x();
      sum += power.watts[c], first += power.watts[c] * x, second += power.watts[c] * x * x;
    }
    double const cell = cells.grid.cell;
    return second / sum - std::pow(first / sum, 2) - cell * cell / 12;
  }
};

void expect_same_bits(Exposure const& a, Exposure const& b) {
  for (std::size_t i = 0; i < a.source.power.size(); ++i) {
    EXPECT_EQ(a.source.power[i].cell, b.source.power[i].cell);
    EXPECT_EQ(a.source.power[i].watts, b.source.power[i].watts);
    EXPECT_EQ(a.source.power[i].absorptivity, b.source.power[i].absorptivity);
  }
  EXPECT_EQ(a.mean.standard_error, b.mean.standard_error);
}

TEST(LightEffects, NullStrengthChangesNoBit) {
  for (bool const traced : {true, false}) {
    BarePlate plate;
    if (!traced) plate.checked.laser.absorptivity = 0.35;
    Exposure const without = plate.expose(2e-6, 40);
    for (char const* name : {"plume_attenuation", "spot_drift"}) {
      plate.checked.effects[name] = {.enabled = true, .strength = 0};
      expect_same_bits(plate.expose(2e-6, 40), without);
      plate.checked.effects[name].strength = 1;
      EXPECT_NE(plate.expose(2e-6, 40).source.power[2].watts, without.source.power[2].watts) << name;
      plate.checked.effects.erase(name);
    }
  }
}

/// Under a steady rate the plume grows as 1 - exp(-t / relaxation), and the beam falls by Beer and Lambert.
TEST(LightEffects, PlumeTakesItsShareByBeerAndLambert) {
  BarePlate plate;
  Exposure const clear = plate.expose();
  double const rate = 2e-6, unit = 20e-6, relaxation = 30e-6, stretch = 20e-6;
  plate.checked.effects["plume_attenuation"] = {
      true, 1, {{"rate_of_unit_depth", unit}, {"relaxation_time", relaxation}}};
  Exposure const dim = plate.expose(rate);
  for (std::size_t i = 0; i < 3; ++i) {
    double const grown = 1 - std::exp(-static_cast<double>(i) * stretch / relaxation);
    double const passed = std::exp(-rate / unit * grown);
    AbsorbedPower const &with = dim.source.power[i], &without = clear.source.power[i];
    EXPECT_NEAR(with.attenuated, 100 * (1 - passed), 1e-12 * 100);
    EXPECT_NEAR(with.absorbed, passed * without.absorbed, 1e-12 * 100);
    EXPECT_NEAR(with.absorptivity, passed * without.absorptivity, 1e-12);
    EXPECT_EQ(with.incident, 100);
  }
  EXPECT_GT(dim.mean.attenuated, 0);
  EXPECT_LT(dim.worst_ray_energy_error, 1e-12);
}

TEST(LightEffects, GasFlowBendsThePlumeIntoTheBeam) {
  BarePlate plate;
  plate.checked.laser.absorptivity = 0.35;
  plate.checked.effects["plume_attenuation"] = {true, 1, {{"flow_asymmetry", 0.5}, {"relaxation_time", 0}}};
  auto& direction = plate.checked.effects["plume_attenuation"].parameters["flow_direction"];
  auto const depth = [&](double azimuth) {
    direction = azimuth;
    AbsorbedPower const power = plate.expose(2e-6).source.power[1];
    return -std::log(1 - power.attenuated / power.incident);
  };
  double const with_flow = depth(0), across = depth(0.5 * std::numbers::pi), against = depth(std::numbers::pi);
  EXPECT_NEAR(across, 2 / 36.0, 1e-12);
  EXPECT_NEAR(with_flow / across, 1.5, 1e-12);
  EXPECT_NEAR(against / across, 0.5, 1e-12);
}

/// Second moment of a Gaussian of 1/e2 radius w: (w / 2)^2, with w as the shifted focus says; traced and prescribed.
TEST(LightEffects, DriftingSpotHasTheWidthOfTheShiftedFocus) {
  for (bool const traced : {true, false}) {
    BarePlate plate;
    if (!traced) plate.checked.laser.absorptivity = 0.35;
    plate.checked.effects["spot_drift"] = {true, 1, {{"rate", 1.0}, {"largest_shift", 5e-3}, {"beam_quality", 1.2}}};
    double const on_time = 60e-6, waist = 30 * um, tolerance = traced ? 0.02 : 1e-4;
    double const rayleigh = std::numbers::pi * waist * waist / (1.2 * 1070e-9);
    for (std::int32_t const layer : {1, 41, 201}) {
      Exposure const exposure = plate.expose(0, layer);
      for (std::size_t i = 0; i < exposure.stops.size(); ++i) {
        double const shift = std::min(5e-3, (layer - 1) * on_time + exposure.stops[i].begin_time);
        double const w = waist * std::sqrt(1 + std::pow(shift / rayleigh, 2));
        EXPECT_NEAR(plate.second_moment(exposure.source.power[i]) / (0.25 * w * w), 1, tolerance) << layer << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace layerloop::coupling
