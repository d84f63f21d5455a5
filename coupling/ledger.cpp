#include "coupling/ledger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "coupling/material_mass.hpp"

namespace layerloop::coupling {
namespace {

constexpr char const* report_it = "This is a fault of the program: please report it with the case file.";

void require(double error, double limit, char const* what, char const* remedy = report_it) {
  if (error <= limit) return;  // also fails on NaN
  throw PhysicsError(fmt::format("the ledger of {} does not close (relative error {:.2e}, limit {:.0e}) {}", what,
                                 error, limit, remedy));
}

}  // namespace

void book_light(Ledger& ledger, Exposure const& exposure, std::int32_t layer) {
  auto const mean = [&](double& so_far, double now) { so_far += (now - so_far) / layer; };
  mean(ledger.power_incident, exposure.mean.incident);
  mean(ledger.power_absorbed, exposure.mean.absorbed);
  mean(ledger.power_escaped, exposure.mean.escaped);
  mean(ledger.power_attenuated, exposure.mean.attenuated);
  mean(ledger.power_residual, exposure.mean.residual);
  ledger.ray_energy_relative_error = std::max(ledger.ray_energy_relative_error, exposure.worst_ray_energy_error);
}

void book_lost(Ledger& ledger, Denuded const& lost) {
  ledger.particles_lost += lost.grains;
  ledger.mass_lost += lost.mass;
}

void book_heat(Ledger& ledger, thermal::HeatOutcome const& heat) {
  ledger.heat_in += heat.heat_in;
  ledger.heat_stored += heat.heat_stored;
  ledger.heat_out += heat.heat_out;
  ledger.heat_energy_relative_error = std::max(ledger.heat_energy_relative_error, heat.heat_energy_relative_error);
  ledger.mass_evaporated += heat.mass_evaporated;
}

void book_motion(Ledger& ledger, dem::EnergyLedger const& energy) {
  ledger.energy_wall_work += energy.wall_work;
  ledger.energy_kinetic += energy.kinetic;
  ledger.energy_potential += energy.potential;
  ledger.energy_elastic += energy.elastic;
  ledger.energy_carried_out += energy.carried_out;
  ledger.energy_dissipated_normal += energy.dissipated_normal;
  ledger.energy_dissipated_tangential += energy.dissipated_tangential;
  ledger.energy_dissipated_rolling += energy.dissipated_rolling;
  ledger.energy_dissipated_gas += energy.dissipated_gas;
  ledger.energy_dissipated_sleep += energy.dissipated_sleep;
  ledger.energy_residual += energy.residual;
  ledger.energy_work_done += energy.work_done;
  if (ledger.energy_work_done > 0)
    ledger.energy_relative_error_dem = std::abs(ledger.energy_residual) / ledger.energy_work_done;
}

void audit(BuildState& build, Case const& checked) {
  Ledger& ledger = build.record.ledger;
  ledger.particles_bed = static_cast<std::int64_t>(build.bed.size());
  ledger.mass_bed = sum_of(mass_by_material(build.bed, checked));

  std::int64_t const accounted =
      ledger.particles_bed + ledger.particles_overflow + ledger.particles_melted + ledger.particles_lost;
  double const mass = ledger.mass_bed + ledger.mass_overflow + ledger.mass_melted + ledger.mass_lost;
  ledger.mass_relative_error = std::abs(ledger.mass_fed - mass) / ledger.mass_fed;

  require(static_cast<double>(std::abs(ledger.particles_fed - accounted)), 0, "particles");
  require(ledger.mass_relative_error, 1e-12, "mass");
  require(ledger.ray_energy_relative_error, 1e-12, "light");
  if (ledger.power_incident > 0) require(ledger.power_residual / ledger.power_incident, 1e-6, "light that was cut off");
  require(ledger.heat_energy_relative_error, 1e-6, "heat");
  require(ledger.energy_relative_error_dem, 1e-3, "the energy of the grains",
          "The motion is not resolved: lower contact.time_step_fraction, or set run.energy_ledger = false.");
}

}  // namespace layerloop::coupling
