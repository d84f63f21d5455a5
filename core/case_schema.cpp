#include "core/case_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/case_rows.hpp"
#include "core/effect_catalogue.hpp"

namespace layerloop {
namespace {

// One row a key, its sentence last.
// clang-format off
std::vector<CaseKey> powder_rows() {
  using P = PowderSettings;
  using C = ContactSettings;
  constexpr auto powder = &Case::powder;
  constexpr auto contact = &Case::contact;
  return {
      {"case", "name", at<&Case::name>, D::none, {}, Need::never, "\"case\"", "Name of the case, for reports."},
      {"case", "seed", at<&Case::seed>, D::none, {0, 9.2e18}, Need::never, "1",
       "Seed of every random number; the same seed gives the same result."},
      {"case", "preset", word<&Case::preset>({"none", "thesis"}), D::none, {}, Need::never, "\"none\"",
       "Set of defaults that the file may override. `thesis`: powder and contact values of the spreading thesis."},

      {"powder", "material", at<powder, &P::material>, D::none, {}, Need::always, "",
       "Metal of grains, plate and part: a built-in one or a [material.NAME] of the file."},
      {"powder", "basis", choice<powder, &P::basis>({"number", "volume"}), D::none, {}, Need::always, "",
       "Whether `fractions` are shares of the number or of the volume of the grains."},
      {"powder", "diameters", at<powder, &P::diameters>, D::length, {1e-6, 5e-4}, Need::always, "",
       "Grain diameters of the size distribution."},
      {"powder", "fractions", at<powder, &P::fractions>, D::none, {0, 1}, Need::always, "",
       "Share of each diameter, by `basis`; they sum to 1."},
      {"powder", "particles", at<powder, &P::particles>, D::none, {0, 1e9}, Need::always, "",
       "Grains fed into the accumulation zone before the first layer."},
      {"powder", "bed", at<powder, &P::bed>, D::none, {}, Need::never, "\"\"",
       "File of grains (csv, LIGGGHTS or LAMMPS dump, extxyz, h5; coordinates of the machine) that are there before the "
       "first layer: those in the accumulation zone join the feed, those in the deposition zone lie on the plate, whose top "
       "is at z = 0 then."},

      {"contact", "youngs_modulus", at<contact, &C::youngs_modulus>, D::pressure, {1e6, 1e12}, Need::always, "",
       "Young's modulus of a grain; softened values (0.2 GPa) allow longer time steps."},
      {"contact", "poisson_ratio", at<contact, &C::poisson_ratio>, D::none, {0, 0.49}, Need::always, "",
       "Poisson's ratio of a grain."},
      {"contact", "restitution", at<contact, &C::restitution>, D::none, {0.01, 1}, Need::always, "",
       "Coefficient of restitution: speed after over speed before a head-on impact."},
      {"contact", "restitution_form", choice<contact, &C::restitution_form>({"exact", "clamped"}),
       D::none, {}, Need::never, "\"exact\"",
       "Whether damping may pull before separation (`exact`: the restitution is as given) or not (`clamped`)."},
      {"contact", "sliding_friction", at<contact, &C::sliding_friction>, D::none, {0, 5}, Need::always, "",
       "Coulomb friction between grains."},
      {"contact", "sliding_spring", choice<contact, &C::sliding_spring>({"rescaled", "kept"}),
       D::none, {}, Need::never, "\"rescaled\"",
       "Tangential spring of a contact that slides: shortened to the Coulomb bound, or kept."},
      {"contact", "rolling_friction", at<contact, &C::rolling_friction>, D::none, {0, 5}, Need::always, "",
       "Rolling friction of grains on grains and walls."},
      {"contact", "rolling_model", choice<contact, &C::rolling_model>({"cdt", "epsd2"}),
       D::none, {}, Need::never, "\"cdt\"",
       "Rolling friction as a constant directional torque (`cdt`) or as a spring cut at that torque (`epsd2`)."},
      {"contact", "cohesion", choice<contact, &C::cohesion>({"none", "sjkr", "sjkr2", "jkr", "dmt"}),
       D::none, {}, Need::never, "\"sjkr2\"",
       "Cohesion law; `sjkr2`: energy density times the area 4 pi R* overlap; `sjkr`: half of it; `jkr`, `dmt`: from `surface_energy`."},
      {"contact", "cohesion_energy_density", at<contact, &C::cohesion_energy_density>,
       D::energy_density, {0, 1e9}, Need::with_energy_density, "",
       "Cohesion energy density of `sjkr` and `sjkr2`; belongs to one Young's modulus."},
      {"contact", "surface_energy", at<contact, &C::surface_energy>,
       D::surface_energy, {0, 10}, Need::with_surface_energy, "",
       "Surface energy of `jkr` and `dmt`: the work of adhesion of two surfaces is twice that."},
      {"contact", "wall_friction", at<contact, &C::wall_friction>,
       D::none, {0, 5}, Need::never, "=contact.sliding_friction",
       "Coulomb friction between grains and platforms, blade and part."},
      {"contact", "wall_cohesion_area", choice<contact, &C::wall_cohesion_area>({"liggghts", "eq6"}),
       D::none, {}, Need::never, "\"liggghts\"",
       "Contact area of cohesion at a wall: 2 pi R overlap (`liggghts`) or 4 pi R overlap (`eq6`)."},
      {"contact", "coulomb_on", choice<contact, &C::coulomb_on>({"repulsive", "total"}),
       D::none, {}, Need::never, "\"repulsive\"",
       "Normal force that limits friction: without (`repulsive`) or with (`total`) cohesion."},
      {"contact", "time_step_fraction", at<contact, &C::time_step_fraction>,
       D::none, {0, 10, open}, Need::never, "0.149",
       "Time step as a share of the Rayleigh time of the smallest grain; above 0.15 the run is refused."},
  };
}

/// For any NAME.
std::vector<CaseKey> rows_of_names() {
  std::vector<CaseKey> rows{mixture_row("NAME")};
  for (auto const& part : {body_rows("NAME"), body_rows(walls_name), pair_rows("NAME", "NAME"), modifier_rows("NAME")})
    rows.insert(rows.end(), part.begin(), part.end());
  return rows;
}

std::vector<CaseKey> machine_rows() {
  using M = MachineSettings;
  constexpr auto machine = &Case::machine;
  return {
      {"machine", "layer_thickness", at<machine, &M::layer_thickness>, D::length, {5e-6, 5e-4}, Need::always, "",
       "Step by which the plate goes down before each layer."},
      {"machine", "recoating_speed", at<machine, &M::recoating_speed>, D::speed, {1e-3, 1}, Need::always, "",
       "Speed of the blade."},
      {"machine", "dosing", choice<machine, &M::dosing>({"feed", "rain"}), D::none, {}, Need::never, "\"rain\"",
       "How layer 2, 3, ... gets its powder: a piston lifts the accumulation zone's floor (`feed`), or new grains rain onto it (`rain`)."},
      {"machine", "dose_factor", at<machine, &M::dose_factor>, D::none, {0, 20}, Need::never, "1.2",
       "Powder for layer 2, 3, ...: `rain`: new grains, as a share of a nominal layer packed to 60 %; `feed`: volume that the piston lifts above the platforms, as a share of the nominal layer's."},
      {"machine", "accumulation_length", at<machine, &M::accumulation_length>,
       D::length, {5e-5, 0.02}, Need::always, "",
       "Length of the zone that holds the feed, along the recoating direction."},
      {"machine", "accumulation_depth", at<machine, &M::accumulation_depth>, D::length, {0, 0.02}, Need::always, "",
       "Depth of the accumulation zone's floor below the platforms; grains above the platforms are swept away."},
      {"machine", "gap_length", at<machine, &M::gap_length>, D::length, {0, 0.02}, Need::always, "",
       "Length of the platform between accumulation and deposition zone."},
      {"machine", "deposition_length", at<machine, &M::deposition_length>, D::length, {5e-5, 0.05}, Need::always, "",
       "Length of the zone that receives the layer."},
      {"machine", "width", at<machine, &M::width>, D::length, {2e-5, 0.02}, Need::always, "",
       "Period across the recoating direction: what leaves on one side enters on the other."},
      {"machine", "recoater", choice<machine, &M::recoater>({"blade", "roller", "compliant_blade"}),
       D::none, {}, Need::never, "\"blade\"",
       "What spreads: a rigid blade, a rigid roller, or a blade that yields upwards on a spring."},
      {"machine", "blade_width", at<machine, &M::blade_width>, D::length, {5e-6, 0.01}, Need::with_blade, "",
       "Extent of the blade along the recoating direction."},
      {"machine", "edge_radius", at<machine, &M::edge_radius>, D::length, {1e-7, 5e-3}, Need::with_blade, "",
       "Radius of the blade's rounded lower edges; of a super-elliptic edge the half axis."},
      {"machine", "edge_exponent", at<machine, &M::edge_exponent>, D::none, {2, 50}, Need::never, "2",
       "Exponent of the blade's super-elliptic edges; 2: round, larger: sharper."},
      {"machine", "blade_clearance", at<machine, &M::blade_clearance>, D::length, {0, 1e-3}, Need::never, "0",
       "Height of the recoater above the platforms; it adds to the layer thickness."},
      {"machine", "blade_friction", at<machine, &M::blade_friction>,
       D::none, {0, 5}, Need::never, "", "Coulomb friction between grains and recoater, if not that of the walls."},
      {"machine", "blade_stiffness", at<machine, &M::blade_stiffness>, D::pressure, {1, 1e9}, Need::never, "\"100 kPa\"",
       "Stiffness of a blade that yields against lifting, for each metre of its width (N/m a metre)."},
      {"machine", "blade_mass", at<machine, &M::blade_mass>, D::linear_density, {1e-4, 100}, Need::never, "\"0.06 kg/m\"",
       "Mass that a yielding blade moves, for each metre of its width."},
      {"machine", "blade_damping", at<machine, &M::blade_damping>, D::none, {0, 10}, Need::never, "0.3",
       "Damping of a blade that yields, as a share of the critical one."},
      {"machine", "roller_diameter", at<machine, &M::roller_diameter>, D::length, {5e-5, 0.1}, Need::never, "\"1 mm\"",
       "Diameter of the roller."},
      {"machine", "roller_spin", at<machine, &M::roller_spin>, D::none, {-20, 20}, Need::never, "1",
       "Speed of the roller's surface over the recoating speed; 1: counter-rotating, 0: does not turn, -1: rolls without slipping."},
      {"machine", "blade_collision", choice<machine, &M::blade_collision>({"stop", "report"}),
       D::none, {}, Need::never, "\"stop\"",
       "What happens when raised solid is in the blade's way."},
      {"machine", "platform_edge_radius", at<machine, &M::platform_edge_radius>,
       D::length, {1e-7, 1e-3}, Need::never, "\"20 um\"",
       "Radius of the platforms' edges towards the two zones."},
      {"machine", "end_wall", choice<machine, &M::end_wall>({"flush", "open", "high"}),
       D::none, {}, Need::never, "\"flush\"",
       "End of the deposition zone: a platform as high as the others, onto which the surplus is swept (`flush`); none, grains fall off there (`open`); a wall before which the recoater stops (`high`)."},
      {"machine", "plate_roughness", at<machine, &M::plate_roughness>, D::length, {0, 1e-4}, Need::never, "0",
       "Rms height of a rough plate before layer 1 (Gaussian random heights with their mean 3 rms above the plate's level); 0: flat, or `substrate`."},
      {"machine", "plate_correlation_length", at<machine, &M::plate_correlation_length>,
       D::length, {1e-6, 1e-2}, Need::never, "\"40 um\"",
       "Distance over which the correlation of the rough plate's heights falls to 1/e."},
      {"machine", "plate_grains", at<machine, &M::plate_grains>, D::none, {0, 0.5}, Need::never, "0",
       "Share of the plate that is covered by grains of the powder, frozen to it with half of their volume sunk in, before layer 1."},
      {"machine", "substrate", at<machine, &M::substrate>, D::none, {}, Need::never, "\"\"",
       "STL or PLY file (metres) of metal that is on the plate before layer 1: x and y of the machine, z from the plate's top."},
      {"machine", "frozen_zone", at<machine, &M::frozen_zone>, D::length, {0, 0.1}, Need::never, "",
       "[from, to] along x: freeze this part of each layer and mesh its surface, instead of a laser."},
  };
}

std::vector<CaseKey> heat_and_run_rows() {
  using H = HeatSettings;
  using R = RunSettings;
  constexpr auto heat = &Case::heat;
  constexpr auto run = &Case::run;
  return {
      {"heat", "cell_size", at<heat, &H::cell_size>, D::length, {2e-7, 1e-4}, Need::with_part, "",
       "Edge of the cubic cells of heat grid and part, and of the pixels of height maps; divides width and deposition "
       "length. Where powder is only spread: by default the largest such edge up to 5 um; verb melt: by default from spot and estimated pool."},
      {"heat", "size", at<heat, &H::size>, D::length, {2e-5, 0.05}, Need::never, "[]",
       "[x, y, z] of the plate that the verb melt heats, rounded up to whole cells; empty: from the length of the tracks and an estimate of the pool."},
      {"heat", "substrate_depth", at<heat, &H::substrate_depth>, D::length, {5e-6, 0.01}, Need::never, "\"120 um\"",
       "Depth of the plate that the grid holds, rounded up to whole cells."},
      {"heat", "margin", at<heat, &H::margin>, D::length, {0, 0.01}, Need::never, "\"50 um\"",
       "Distance from the scanned patch to the sides of the grid."},
      {"heat", "ambient_temperature", at<heat, &H::ambient_temperature>, D::temperature, {1, 2000}, Need::never, "300",
       "Temperature of plate, powder and gas before each exposure."},
      {"heat", "solver", choice<heat, &H::solver>({"explicit", "implicit", "automatic"}),
       D::none, {}, Need::never, "\"automatic\"",
       "Time stepping; `automatic`: explicit, and many steps at once (Runge-Kutta-Legendre) where metal conducts fast or "
       "the beam is off."},
      {"heat", "powder_contact_conductivity", at<heat, &H::powder_contact_conductivity>,
       D::conductivity, {0, 100}, Need::never, "0.2",
       "Conductivity across faces between cells of different grains: gas and point contacts; see the effect powder_conductivity."},
      {"heat", "gas", choice<heat, &H::gas>({"argon", "nitrogen", "helium"}), D::none, {}, Need::never, "\"argon\"",
       "Shielding gas, for the effect powder_conductivity."},
      {"heat", "gas_pressure", at<heat, &H::gas_pressure>, D::pressure, {1, 1e7}, Need::never, "101325",
       "Pressure of the shielding gas."},
      {"heat", "pool_isotherm", at<heat, &H::pool_isotherm>, D::none, {}, Need::never, "\"liquidus\"",
       "Isotherm that bounds the melt pool where it is measured: \"liquidus\", \"solidus\" or a temperature such as \"1563 K\"."},

      {"run", "layers", at<run, &R::layers>, D::none, {1, 100000}, Need::never, "1", "Layers to build."},
      {"run", "bins", at<run, &R::bins>, D::none, {1, 1000}, Need::never, "15",
       "Equal slices of the deposition zone along x in which every layer is measured."},
      {"run", "replicates", at<run, &R::replicates>, D::none, {1, 1000}, Need::never, "1",
       "Runs with the seeds seed, seed + 1, ...; the summary then gives means with 95 % intervals (3 or more advised)."},
      {"run", "grains_sleep", at<run, &R::grains_sleep>, D::none, {}, Need::never, "true",
       "Whether grains that lie still are left alone until something moves near them."},
      {"run", "energy_ledger", at<run, &R::energy_ledger>, D::none, {}, Need::never, "false",
       "Whether work, energy and dissipation of the grains are booked and must balance; their motion takes two to six times as long."},
      {"run", "checkpoint", at<run, &R::checkpoint>, D::none, {}, Need::never, "true",
       "Whether a checkpoint is written after each layer."},
      {"run", "pictures", at<run, &R::pictures>, D::none, {}, Need::never, "true",
       "Whether pictures of every layer are drawn for the report."},
      {"run", "unsafe_time_step", at<run, &R::unsafe_time_step>, D::none, {}, Need::never, "false",
       "Lets a run start with a time step above the stable limit; the guards then stop it."},
  };
}

std::vector<CaseKey> calibrate_rows() {
  using K = CalibrateSettings;
  constexpr auto calibrate = &Case::calibrate;
  constexpr double right_angle = std::numbers::pi / 2;
  return {
      {"calibrate", "base_diameter", at<calibrate, &K::base_diameter>, D::length, {1e-4, 0.05}, Need::never,
       "\"800 um\"", "Diameter of the round base that the pile stands on."},
      {"calibrate", "pile_particles", at<calibrate, &K::pile_particles>, D::none, {50, 1e8}, Need::never, "2600",
       "Grains that fall on the base; what rolls over its edge is gone."},
      {"calibrate", "batches", at<calibrate, &K::batches>, D::none, {1, 1000}, Need::never, "1",
       "Clouds that the grains of the pile come in, each when the one before has come to rest; 1: the cloud method."},
      {"calibrate", "cloud_width", at<calibrate, &K::cloud_width>, D::none, {0.05, 1}, Need::never, "0.85",
       "Diameter of a cloud over that of the base; small with many batches: pouring from a funnel."},
      {"calibrate", "cloud_density", at<calibrate, &K::cloud_density>, D::none, {0.005, 0.35}, Need::never, "0.16",
       "Solid share of a cloud; the looser, the higher it falls from."},
      {"calibrate", "fall_speed", at<calibrate, &K::fall_speed>, D::speed, {0, 5}, Need::never, "\"50 mm/s\"",
       "Downward speed of the grains of a cloud at the start."},
      {"calibrate", "settling_time", at<calibrate, &K::settling_time>, D::time, {1e-4, 10}, Need::never, "\"15 ms\"",
       "Longest time that pile and layer are given to come to rest."},
      {"calibrate", "plate_length", at<calibrate, &K::plate_length>, D::length, {1e-4, 0.02}, Need::never,
       "\"450 um\"", "Period, along and across, of the plate that is tilted."},
      {"calibrate", "plate_particles", at<calibrate, &K::plate_particles>, D::none, {20, 1e8}, Need::never, "800",
       "Grains on the plate that is tilted."},
      {"calibrate", "tilt_rate", at<calibrate, &K::tilt_rate>, D::angular_speed, {0.1, 1000}, Need::never,
       "\"1.4 deg/ms\"", "Rate at which the plate is tilted; the faster, the later the layer is seen to slip."},
      {"calibrate", "tilt_from", at<calibrate, &K::tilt_from>, D::angle, {0, right_angle}, Need::never, "\"20 deg\"",
       "Tilt that is reached 15 times faster."},
      {"calibrate", "tilt_to", at<calibrate, &K::tilt_to>, D::angle, {0, 2 * right_angle}, Need::never, "\"70 deg\"",
       "Tilt at which the test ends when the layer has not slipped."},
      {"calibrate", "target_repose", at<calibrate, &K::target_repose>, D::angle, {0, right_angle, open}, Need::never,
       "\"28.7 deg\"", "Measured angle of repose."},
      {"calibrate", "target_slip", at<calibrate, &K::target_slip>, D::angle, {0, right_angle, open}, Need::never,
       "\"41.6 deg\"", "Measured slipping angle."},
      {"calibrate", "tolerance", at<calibrate, &K::tolerance>, D::none, {1e-4, 1}, Need::never, "0.04",
       "Relative error of either angle at which a target counts as reached."},
      {"calibrate", "search", at<calibrate, &K::search>, D::none, {}, Need::never, "false",
       "Whether friction and cohesion that give both targets are looked for. Friction and cohesion at walls follow in "
       "the proportion that the case has."},
      {"calibrate", "friction", at<calibrate, &K::friction>, D::none, {0, 5}, Need::never, "[0.3, 1.1]",
       "[from, to]: bounds of the friction between grains in the search."},
      {"calibrate", "cohesion", at<calibrate, &K::cohesion>, D::energy_density, {0, 1e9}, Need::never,
       "[\"20 kJ/m3\", \"160 kJ/m3\"]", "[from, to]: bounds of the cohesion energy density in the search."},
      {"calibrate", "grid", at<calibrate, &K::grid>, D::none, {3, 50}, Need::never, "3",
       "Values of friction, and of cohesion, on the map that the search begins with."},
      {"calibrate", "refinements", at<calibrate, &K::refinements>, D::none, {0, 50}, Need::never, "4",
       "Further points at most, each where the fitted surfaces come closest to both targets."},
      {"calibrate", "parameter_step", at<calibrate, &K::parameter_step>, D::none, {0.01, 0.9}, Need::never, "0.25",
       "Relative change of each parameter, up and down, for the sensitivities of both angles."},
  };
}

std::vector<CaseKey> material_rows() {
  using M = Material;
  constexpr auto m = &Case::material;
  return {
      {"material", "density", at<m, &M::density>, D::density, {500, 25000}, Need::always, "",
       "Density at room temperature; grains and heat grid know no other."},
      {"material", "solid_density", at<m, &M::solid_density>, D::density, {500, 25000}, Need::never, "",
       "Density of the solid over temperature: a number or [[temperature, value], ...]."},
      {"material", "liquid_density", at<m, &M::liquid_density>, D::density, {500, 25000}, Need::never, "",
       "Density of the liquid over temperature: a number or [[temperature, value], ...]."},
      {"material", "conductivity", at<m, &M::conductivity>, D::conductivity, {0.1, 1000}, Need::with_laser, "",
       "Thermal conductivity, solid and liquid: a number or [[temperature, value], ...]."},
      {"material", "specific_heat", at<m, &M::specific_heat>, D::specific_heat, {50, 10000}, Need::with_laser, "",
       "Specific heat without latent heat: a number or [[temperature, value], ...]."},
      {"material", "latent_heat", at<m, &M::latent_heat>, D::specific_energy, {1e3, 2e6}, Need::with_laser, "",
       "Latent heat of fusion, beside the specific heat between solidus and liquidus."},
      {"material", "solidus", at<m, &M::solidus>, D::temperature, {200, 5000}, Need::with_laser, "",
       "Temperature where melting begins."},
      {"material", "liquidus", at<m, &M::liquidus>, D::temperature, {200, 5000}, Need::with_laser, "",
       "Temperature where melting ends."},
      {"material", "boiling_point", at<m, &M::boiling_point>, D::temperature, {500, 8000}, Need::with_laser, "",
       "Boiling point at one atmosphere."},
      {"material", "heat_of_vaporisation", at<m, &M::heat_of_vaporisation>,
       D::specific_energy, {1e5, 1e8}, Need::with_laser, "",
       "Heat of vaporisation."},
      {"material", "molar_mass", at<m, &M::molar_mass>, D::molar_mass, {1e-3, 0.3}, Need::with_laser, "",
       "Molar mass of the vapour."},
      {"material", "emissivity", at<m, &M::emissivity>, D::none, {0, 1}, Need::with_laser, "",
       "Total emissivity of the surface."},
      {"material", "viscosity", at<m, &M::viscosity>, D::viscosity, {1e-5, 1}, Need::never, "",
       "Viscosity of the liquid: a number or [[temperature, value], ...]."},
      {"material", "surface_tension", at<m, &M::surface_tension>, D::surface_energy, {0.01, 5}, Need::never, "",
       "Surface tension at the liquidus."},
      {"material", "surface_tension_slope", at<m, &M::surface_tension_slope>,
       D::surface_tension_slope, {-1e-2, 1e-2}, Need::never, "",
       "Change of the surface tension with temperature; negative: the melt flows away from the beam."},
      {"material", "refractive_index", at<m, &M::refractive_index>, D::none, {0, 100}, Need::never, "",
       "[n, k] at the laser's wavelength; replaces `optical_data`."},
      {"material", "optical_data", at<m, &M::optical_data>, D::none, {}, Need::never, "",
       "Set of optical constants, for example \"Cu (Johnson 1972)\"; an alloy borrows those of an element."},
      {"material", "source", at<m, &M::source>, D::none, {}, Need::always, "", "Where the values come from."},
  };
}

// clang-format on

std::vector<CaseKey> effect_rows() {
  std::vector<CaseKey> rows;
  for (Effect const& effect : effect_catalogue()) {
    auto const enabled = [name = effect.name](Case& into) -> bool& { return into.effects[name].enabled; };
    auto const strength = [name = effect.name](Case& into) -> double& { return into.effects[name].strength; };
    std::string const table = "effects." + effect.name;
    rows.push_back({table,
                    "enabled",
                    enabled,
                    D::none,
                    {},
                    Need::never,
                    effect.enabled,
                    fmt::format("{} Source: {}.", effect.sentence, effect.source)});
    EffectParameter const factor = effect.strength();
    rows.push_back(
        {table, factor.name, strength, factor.dimension, factor.range, Need::never, factor.fallback, factor.sentence});
    for (EffectParameter const& p : effect.parameters) {
      auto const value = [name = effect.name, key = p.name](Case& into) -> double& {
        return into.effects[name].parameters[key];
      };
      rows.push_back({table, p.name, value, p.dimension, p.range, Need::never, p.fallback, p.sentence});
    }
  }
  return rows;
}

}  // namespace

std::vector<CaseKey> const& case_schema() {
  static std::vector<CaseKey> const schema = [] {
    std::vector<CaseKey> rows;
    for (auto const part : {powder_rows, rows_of_names, machine_rows, laser_rows, heat_and_run_rows, calibrate_rows,
                            absorb_rows, melt_rows, effect_rows, material_rows}) {
      for (CaseKey& row : part()) rows.push_back(std::move(row));
    }
    return rows;
  }();
  return schema;
}

bool is_needed(CaseKey const& row, Case const& c) {
  bool const counts_grains = name_of(row) == "powder.particles" && c.process == Process::calibrating;
  bool const of_machine = row.table == "machine" || row.table == "heat" || counts_grains;
  if (of_machine && !c.has_machine()) return false;
  bool const bed_is_there = (c.process == Process::absorbing && c.absorb.bed == AbsorbingBed::file) ||
                            (c.process == Process::exposing && !c.has_machine());
  if (bed_is_there && (row.table == "contact" || (row.table == "powder" && row.key != "material"))) return false;
  bool const of_way = row.table == "scan" && (row.key == "scan_speed" || row.key == "track_length");
  if (of_way && c.scan.kind == ScanKind::file) return false;
  switch (row.need) {
    case Need::always:
      return true;
    case Need::with_laser:
      return c.has_laser();
    case Need::with_light:
      return c.has_light();
    case Need::with_spot:
      return c.has_spot() && c.laser.profile != SpotProfile::file;
    case Need::with_part:
      return c.has_part();
    case Need::with_energy_density:
      return c.contact.cohesion == Cohesion::sjkr || c.contact.cohesion == Cohesion::sjkr2;
    case Need::with_surface_energy:
      return c.contact.cohesion == Cohesion::jkr || c.contact.cohesion == Cohesion::dmt;
    case Need::with_blade:
      return c.machine.recoater != RecoaterKind::roller;
    case Need::never:
      return false;
  }
  return false;
}

std::string name_of(CaseKey const& row) { return row.table + "." + row.key; }

std::string shown_range(CaseKey const& row) {
  Range const& range = row.range;
  if (std::isinf(range.min) && std::isinf(range.max)) return "";
  return fmt::format("{}{}, {}]", range.lower == Range::End::open ? "(" : "[",
                     format_quantity(range.min, row.dimension), format_quantity(range.max, row.dimension));
}

CaseKey const* find_key(std::string const& table, std::string const& key) {
  std::string const family = family_of(table);
  for (CaseKey const& row : case_schema()) {
    if (row.table == family && (row.key == key || row.key == "NAME")) return &row;
  }
  return nullptr;
}

std::vector<std::string> const& case_tables() {
  static std::vector<std::string> const tables = [] {
    std::vector<std::string> names;
    for (CaseKey const& row : case_schema()) {
      std::string const name = row.table == "material" ? "material.NAME" : row.table;
      if (names.empty() || names.back() != name) names.push_back(name);
    }
    return names;
  }();
  return tables;
}

std::string preset_value(std::string const& preset, std::string const& table, std::string const& key) {
  struct Value {
    std::string_view preset, table, key, value;
  };
  // Thesis Table 4 and section 3.2; its density is 12 % above that of IN718 (8190 kg/m3), kept to repeat its runs.
  static std::vector<Value> const values = {
      {"thesis", "powder", "material", "\"IN718\""},
      {"thesis", "powder", "basis", "\"number\""},
      {"thesis", "powder", "diameters", "[\"13 um\", \"21 um\", \"28 um\", \"42 um\"]"},
      {"thesis", "powder", "fractions", "[0.2, 0.2, 0.5, 0.1]"},
      {"thesis", "contact", "youngs_modulus", "\"0.2 GPa\""},
      {"thesis", "contact", "poisson_ratio", "0.3"},
      {"thesis", "contact", "wall_cohesion_area", "\"eq6\""},
      {"thesis", "contact", "restitution", "0.7"},
      {"thesis", "contact", "sliding_friction", "0.7"},
      {"thesis", "contact", "rolling_friction", "0.15"},
      {"thesis", "contact", "cohesion_energy_density", "\"90000 J/m3\""},
      {"thesis", "material.IN718", "density", "\"9187 kg/m3\""},
      {"thesis", "powder", "particles", "4500"},
      // Thesis Table 5; it leaves open the depth of the accumulation zone, edges, friction of the blade, end wall.
      {"thesis", "machine", "layer_thickness", "\"100 um\""},
      {"thesis", "machine", "recoating_speed", "\"100 mm/s\""},
      {"thesis", "machine", "accumulation_length", "\"1250 um\""},
      {"thesis", "machine", "accumulation_depth", "\"300 um\""},
      {"thesis", "machine", "gap_length", "\"150 um\""},
      {"thesis", "machine", "deposition_length", "\"1250 um\""},
      {"thesis", "machine", "width", "\"175 um\""},
      {"thesis", "machine", "blade_width", "\"250 um\""},
      {"thesis", "machine", "edge_radius", "\"5 um\""},
  };
  for (Value const& row : values) {
    if (row.preset == preset && row.table == table && row.key == key) return std::string(row.value);
  }
  return "";
}

}  // namespace layerloop
