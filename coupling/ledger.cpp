#include "coupling/ledger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "coupling/material_mass.hpp"

namespace layerloop::coupling {
namespace {

void require(double error, double limit, char const* what) {
  if (error <= limit) return;  // also fails on NaN
  throw PhysicsError(
      fmt::format("the ledger of {} does not close (relative error {:.2e}, limit {:.0e}) This is a fault of the "
                  "program: please report it with the case file.",
                  what, error, limit));
}

}  // namespace

void book_light(Ledger& ledger, Exposure const& exposure, std::int32_t layer) {
  auto const mean = [&](double& so_far, double now) { so_far += (now - so_far) / layer; };
  mean(ledger.power_incident, exposure.mean.incident);
  mean(ledger.power_absorbed, exposure.mean.absorbed);
  mean(ledger.power_escaped, exposure.mean.escaped);
  mean(ledger.power_residual, exposure.mean.residual);
  ledger.ray_energy_relative_error = std::max(ledger.ray_energy_relative_error, exposure.worst_ray_energy_error);
}

void book_heat(Ledger& ledger, thermal::HeatOutcome const& heat) {
  ledger.heat_in += heat.heat_in;
  ledger.heat_stored += heat.heat_stored;
  ledger.heat_out += heat.heat_out;
  ledger.heat_energy_relative_error = std::max(ledger.heat_energy_relative_error, heat.heat_energy_relative_error);
  ledger.mass_evaporated += heat.mass_evaporated;
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
}

}  // namespace layerloop::coupling
