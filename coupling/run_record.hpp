#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/area_map.hpp"
#include "core/case.hpp"
#include "core/layer_metrics.hpp"
#include "core/melt_record.hpp"

namespace layerloop::coupling {

/// Mass, particles, light and heat of a run, raw: taken before any rescaling or height correction. SI.
struct Ledger {
  double mass_fed = 0, mass_bed = 0, mass_overflow = 0, mass_melted = 0, mass_evaporated = 0, mass_lost = 0;
  double mass_relative_error = 0;
  std::int64_t particles_fed = 0, particles_bed = 0, particles_overflow = 0, particles_melted = 0, particles_lost = 0;
  std::int64_t particles_trapped = 0;  ///< of the melted: stayed whole inside the part
  double power_incident = 0, power_absorbed = 0, power_escaped = 0, power_attenuated = 0,
         power_residual = 0;             ///< mean over the exposure [W]
  double ray_energy_relative_error = 0;  ///< worst beam position
  double power_rescaling = 0;            ///< factor - 1 that was applied to the absorbed power
  double heat_in = 0, heat_stored = 0, heat_out = 0, heat_energy_relative_error = 0;  ///< [J]
  double surface_height_correction = 0;  ///< mean change of the surface by levelling and resettling [m]
  // Of the moving grains [J], summed over all layers, with run.energy_ledger; see dem::EnergyLedger.
  double energy_wall_work = 0, energy_kinetic = 0, energy_potential = 0, energy_elastic = 0, energy_carried_out = 0;
  double energy_dissipated_normal = 0, energy_dissipated_tangential = 0, energy_dissipated_rolling = 0,
         energy_dissipated_gas = 0, energy_dissipated_sleep = 0;
  double energy_residual = 0, energy_work_done = 0;
  double energy_relative_error_dem = 0;  ///< residual over work done
};

/// Transverse cut (y-z) through the heat grid at mid-track, after the exposure. Shapes: ny * nz, y fastest.
struct MeltSection {
  double x = 0, y0 = 0, z0 = 0, cell = 0;
  std::int32_t ny = 0, nz = 0;
  std::vector<float> peak_temperature;  ///< [K]
  std::vector<std::uint8_t> state;      ///< before the exposure: 0 gas, 1 powder, 2 solid; +4 when it melted
};

/// What became of the melted grains of one layer.
struct Consolidation {
  std::int64_t grains_melted = 0, grains_trapped = 0, grains_moved = 0;
  double melted_mass = 0;                    ///< that joined the solid in this layer, trapped grains included [kg]
  double melted_cell_mass = 0;               ///< powder mass in melted cells: what the half-or-more rule rounds [kg]
  double surface_height_correction = 0;      ///< mean change of the melt's surface by levelling [m]
  double largest_displacement = 0;           ///< of a grain that was moved clear of the new surface [m]
  double mesh_volume = 0, field_volume = 0;  ///< plate and part: enclosed by the mesh, and held by the field [m^3]
  std::int64_t triangles = 0;
  double part_relative_density = 0;  ///< metal / (metal + enclosed voids) of the part so far, plate left out
};

/// One material of a mixture in a layer, by mass.
struct MaterialShare {
  std::string name;
  double fed = 0;                     ///< of all powder fed so far
  double layer = 0, layer_u_num = 0;  ///< of the grains that the layer added to the deposition zone
};

/// Everything that a layer leaves for summary and report.
struct LayerRecord {
  std::int32_t layer = 0;  ///< 1-based
  std::int64_t grains_in_layer = 0;
  std::int64_t grains_nipped = 0;  ///< of the overflow: caught between the moving blade and an edge, and taken out
  LayerMetrics metrics;
  StrokeMetrics stroke;
  std::string blade_note;                ///< empty, or what the blade would have touched
  std::vector<MaterialShare> materials;  ///< of a mixture
  double absorptivity = 0, absorptivity_standard_error = 0, mean_bounces = 0;
  std::int64_t rays = 0;
  AreaMap absorbed_energy;       ///< [J/m^2] over the exposure
  double start_temperature = 0;  ///< of metal, powder and gas when the layer's exposure began [K]
  double peak_temperature = 0;
  PoolSize pool, pool_u_num;
  std::vector<MeltSection> sections;
  Consolidation consolidation;
  HeightMap part_surface;                            ///< of the solid (plate and part) after consolidation
  std::vector<std::array<std::string, 2>> pictures;  ///< file name in the output folder, caption
};

struct WallTime {
  double dem = 0, rays = 0, heat = 0, mesh = 0, io = 0, total = 0;  ///< [s]
};

struct RunRecord {
  std::vector<LayerRecord> layers;
  Ledger ledger;
  std::vector<double> mass_fed_by_material;  ///< by PowderBed::material [kg]
  WallTime wall_time;
};

/// What explains the figures of a run.
struct ReportExtras {
  std::string version;                             ///< of the program
  std::map<std::string, std::string> definitions;  ///< quantity -> sentence, for the quantities of a spread layer
};

/// Lossless: every number comes back bit for bit (not a number, infinity: as text). \throws FileError damaged
void to_json(nlohmann::json& json, RunRecord const& record);
void from_json(nlohmann::json const& json, RunRecord& record);

/// A sentence for every quantity of the summary: those of `extras`, and those of light, heat and part.
std::map<std::string, std::string> definitions(ReportExtras const& extras);

/// summary.json as the contract names it: scalars with `_u_num`, definitions, ledger, wall time; no maps; null where
/// there was nothing to measure. Quantities of light, heat and part are left out where nothing was melted or frozen.
/// Where powder was only spread, bins and stroke of the last layer stand at the top as well.
nlohmann::json summary(Case const& checked, RunRecord const& record, ReportExtras const& extras);

}  // namespace layerloop::coupling
