#include "coupling/report/ledger_checks.hpp"

#include <fmt/format.h>

#include <cmath>

#include "coupling/report/html.hpp"

namespace layerloop::coupling {
namespace {

// The limits at which a run is stopped (coupling/ledger.hpp).
constexpr double mass_limit = 1e-12, ray_limit = 1e-12, residual_limit = 1e-6, heat_limit = 1e-6, motion_limit = 1e-3;

LedgerCheck small_enough(std::string label, double error, double limit) {
  return {fmt::format("{} (limit {})", label, significant(limit, 1)), significant(error, 2),
          std::isfinite(error) && std::abs(error) <= limit};
}

LedgerTable mass_table(Ledger const& l) {
  auto const micrograms = [](double kg) { return significant(1e9 * kg, 5) + " &micro;g"; };
  return {"Mass",
          {{"fed", micrograms(l.mass_fed), true},
           {"in the bed", micrograms(l.mass_bed)},
           {"in the overflow", micrograms(l.mass_overflow)},
           {"melted into the part", micrograms(l.mass_melted)},
           {"drawn away beside the tracks (denudation)", micrograms(l.mass_lost)},
           {"seen to evaporate by the heat model, not taken off the part", micrograms(l.mass_evaporated)}},
          {small_enough("relative error", l.mass_relative_error, mass_limit)}};
}

LedgerTable particle_table(Ledger const& l) {
  std::int64_t const missing =
      l.particles_fed - l.particles_bed - l.particles_overflow - l.particles_melted - l.particles_lost;
  return {"Grains",
          {{"fed", count(l.particles_fed), true},
           {"in the bed", count(l.particles_bed)},
           {"in the overflow", count(l.particles_overflow)},
           {fmt::format("melted (of them {} whole inside the part)", l.particles_trapped), count(l.particles_melted)},
           {"drawn away beside the tracks (denudation)", count(l.particles_lost)}},
          {{"unaccounted for (limit 0)", count(missing), missing == 0}}};
}

LedgerTable light_table(Ledger const& l) {
  auto const watts = [](double power) { return significant(power, 5) + " W"; };
  double const residual = l.power_incident > 0 ? l.power_residual / l.power_incident : 0;
  return {"Light, mean over the exposure",
          {{"incident", watts(l.power_incident), true},
           {"absorbed", watts(l.power_absorbed)},
           {"escaped", watts(l.power_escaped)},
           {"lost in the plume", watts(l.power_attenuated)},
           {"still on rays that were cut off", watts(l.power_residual)},
           {"factor that was then applied to the absorbed power, less 1", significant(l.power_rescaling, 2)}},
          {small_enough("relative error, worst beam position", l.ray_energy_relative_error, ray_limit),
           small_enough("residual over incident", residual, residual_limit)}};
}

LedgerTable heat_table(Ledger const& l) {
  auto const millijoules = [](double joules) { return significant(1e3 * joules, 5) + " mJ"; };
  return {"Heat",
          {{"brought in", millijoules(l.heat_in), true},
           {"stored in the grid", millijoules(l.heat_stored)},
           {"out through the edges of the grid", millijoules(l.heat_out)},
           {"surface moved by levelling, mean", significant(1e6 * l.surface_height_correction, 3) + " &micro;m"}},
          {small_enough("relative error, worst layer", l.heat_energy_relative_error, heat_limit)}};
}

LedgerTable motion_table(Ledger const& l) {
  auto const nanojoules = [](double joules) { return significant(1e9 * joules, 5) + " nJ"; };
  return {"Energy of the moving grains",
          {{"work of the blade", nanojoules(l.energy_wall_work), true},
           {"gained in motion", nanojoules(l.energy_kinetic)},
           {"gained in height", nanojoules(l.energy_potential)},
           {"gained in contacts", nanojoules(l.energy_elastic)},
           {"dissipated in impacts", nanojoules(l.energy_dissipated_normal)},
           {"dissipated by friction", nanojoules(l.energy_dissipated_tangential)},
           {"dissipated by rolling", nanojoules(l.energy_dissipated_rolling)},
           {"dissipated in the gas", nanojoules(l.energy_dissipated_gas)},
           {"of grains that fell asleep", nanojoules(l.energy_dissipated_sleep)},
           {"of grains that were taken out", nanojoules(l.energy_carried_out)},
           {"residual", nanojoules(l.energy_residual)}},
          {small_enough("residual over work done", l.energy_relative_error_dem, motion_limit)}};
}

}  // namespace

std::vector<LedgerTable> ledgers(Ledger const& ledger, bool laser) {
  std::vector<LedgerTable> tables{mass_table(ledger), particle_table(ledger)};
  if (ledger.energy_work_done > 0) tables.push_back(motion_table(ledger));
  if (laser) tables.insert(tables.end(), {light_table(ledger), heat_table(ledger)});
  return tables;
}

std::vector<LedgerCheck> ledger_checks(Ledger const& ledger, bool laser) {
  std::vector<LedgerCheck> all;
  for (LedgerTable const& table : ledgers(ledger, laser))
    all.insert(all.end(), table.checks.begin(), table.checks.end());
  return all;
}

}  // namespace layerloop::coupling
