#include "raytrace/trace.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "raytrace/ray_loop.hpp"

namespace layerloop::raytrace {
namespace {

AbsorbedPower watts_of(RayTally const& tally, double incident) {
  double const watts = incident / tally.rays();  // of one ray
  AbsorbedPower power;
  power.incident = incident;
  power.rays = static_cast<std::int64_t>(tally.rays());
  for (auto const& [cell, sum] : tally.cells()) {
    power.cell.push_back(cell);
    power.watts.push_back(watts * sum);
  }
  power.outside_grid = watts * tally.outside_grid.value();

  auto const [absorptivity, error] = tally.absorptivity(0);
  power.absorptivity = absorptivity;
  power.standard_error = error;
  power.absorbed = incident * absorptivity;
  power.escaped = incident * tally.estimate(tally.layout.escaped(0)).value;
  power.residual = incident * tally.estimate(tally.layout.residual(0)).value;
  power.mean_bounces = tally.estimate(tally.layout.hits()).value;
  return power;
}

void check_result(AbsorbedPower const& power, Beam const& beam, BedScene const& scene) {
  CompensatedSum placed;
  placed.add(power.outside_grid);
  for (double const watts : power.watts) placed.add(watts);
  double const error = std::max(ray_energy_error(power), std::abs(placed.value() - power.absorbed) / power.incident);
  if (!(error < 1e-12)) {
    throw PhysicsError(
        fmt::format("the ledger of the trace does not close (incident {:g} W, absorbed {:g} W, escaped {:g} W, "
                    "residual {:g} W, relative error {:g}); look for coordinates or refractive indices that are "
                    "not numbers",
                    power.incident, power.absorbed, power.escaped, power.residual, error));
  }
  if (!(power.absorbed > 0)) {
    throw PhysicsError(fmt::format(
        "the beam at x = {:g} m, y = {:g} m is not absorbed at all (bed and substrate span x = {:g} "
        "to {:g} m, y = {:g} to {:g} m): check the scan path and optics.refractive_index",
        beam.centre.x(), beam.centre.y(), scene.lower().x(), scene.upper().x(), scene.lower().y(), scene.upper().y()));
  }
}

}  // namespace

AbsorbedPower trace(BedScene const& scene, Beam const& beam, OpticalSet const& optics, std::int32_t substrate_material,
                    VoxelGrid const& grid, TraceSettings const& settings) {
  if (settings.rays < 1 || settings.replicates < 2) {
    throw InputError(fmt::format(
        "{} rays in {} replicates cannot be traced (the standard error needs 2 replicates): raise optics.rays",
        settings.rays, settings.replicates));
  }
  RayProblem const problem{.scene = scene,
                           .beam = beam,
                           .sets = {&optics, 1},
                           .substrate_material = substrate_material,
                           .polarisation = settings.polarisation,
                           .slopes = Slopes::without,
                           .diffuse_share = settings.diffuse_share,
                           .cut_off = settings.cut_off,
                           .max_bounces = settings.max_bounces,
                           .seed = settings.seed,
                           .id = settings.id,
                           .places = {.grid = &grid}};
  check_problem(problem);
  RayTally tally({1, optics.surface.size(), 0}, problem.places, 0, settings.replicates);
  trace_rays(problem, (settings.rays + settings.replicates - 1) / settings.replicates, tally);
  AbsorbedPower power = watts_of(tally, beam.power);
  check_result(power, beam, scene);
  return power;
}

AbsorbedPower trace(BedScene const& scene, Beam const& beam, std::span<std::complex<double> const> refractive_index,
                    std::int32_t substrate_material, VoxelGrid const& grid, TraceSettings const& settings) {
  OpticalSet optics;
  for (std::complex<double> const N : refractive_index) optics.surface.push_back({.refractive_index = N});
  return trace(scene, beam, optics, substrate_material, grid, settings);
}

}  // namespace layerloop::raytrace
