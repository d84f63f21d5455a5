#include "coupling/run_record.hpp"

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.hpp"

namespace layerloop::coupling {
namespace {

using nlohmann::json;

// One list of members for each structure, for reading and writing alike: `visit(name, member)`.
template <class T, class Plain>
concept Of = std::same_as<std::remove_const_t<T>, Plain>;

template <class Visit>
void members(Of<PoolSize> auto& pool, Visit&& visit) {
  visit("width", pool.width);
  visit("depth", pool.depth);
  visit("length", pool.length);
}

template <class Visit>
void members(Of<AreaMap> auto& map, Visit&& visit) {
  visit("x0", map.x0);
  visit("y0", map.y0);
  visit("spacing", map.spacing);
  visit("nx", map.nx);
  visit("ny", map.ny);
  visit("values", map.values);
}

template <class Visit>
void zone_members(auto& zone, Visit&& visit) {
  visit("effective_thickness", zone.effective_thickness);
  visit("effective_thickness_u_num", zone.effective_thickness_u_num);
  visit("real_effective_thickness", zone.real_effective_thickness);
  visit("real_effective_thickness_u_num", zone.real_effective_thickness_u_num);
  visit("void_layer", zone.void_layer);
  visit("volume_fraction_nominal", zone.volume_fraction_nominal);
  visit("volume_fraction_real", zone.volume_fraction_real);
  visit("volume_fraction_real_u_num", zone.volume_fraction_real_u_num);
  visit("surface_coverage", zone.surface_coverage);
  visit("roughness_sa", zone.roughness_sa);
  visit("roughness_sa_u_num", zone.roughness_sa_u_num);
  visit("roughness_sq", zone.roughness_sq);
  visit("roughness_sz", zone.roughness_sz);
  visit("d10", zone.d10);
  visit("d50", zone.d50);
  visit("d90", zone.d90);
  visit("d10_number", zone.d10_number);
  visit("d50_number", zone.d50_number);
  visit("d90_number", zone.d90_number);
  visit("mean_diameter", zone.mean_diameter);
  visit("sauter_diameter", zone.sauter_diameter);
  visit("mass_diameter", zone.mass_diameter);
  visit("coordination_number", zone.coordination_number);
  visit("rattler_fraction", zone.rattler_fraction);
  visit("grains", zone.grains);
}

template <class Visit>
void members(Of<LayerBin> auto& bin, Visit&& visit) {
  visit("x", bin.x);
  zone_members(bin, visit);
}

template <class Visit>
void members(Of<StrokeMetrics> auto& stroke, Visit&& visit) {
  visit("settled_height", stroke.settled_height);
  visit("settled_density", stroke.settled_density);
  visit("reservoir_mean_diameter_before", stroke.reservoir_mean_diameter_before);
  visit("reservoir_mean_diameter", stroke.reservoir_mean_diameter);
  visit("reservoir_mass_ratio", stroke.reservoir_mass_ratio);
  visit("heap_angle_accumulation", stroke.heap_angle_accumulation);
  visit("heap_angle_accumulation_u_num", stroke.heap_angle_accumulation_u_num);
  visit("heap_angle_deposition", stroke.heap_angle_deposition);
  visit("heap_angle_deposition_u_num", stroke.heap_angle_deposition_u_num);
  visit("blade_force", stroke.blade_force);
  visit("mean_blade_force", stroke.mean_blade_force);
  visit("bond_number", stroke.bond_number);
  visit("steps_per_contact", stroke.steps_per_contact);
  visit("largest_overlap", stroke.largest_overlap);
}

template <class Visit>
void members(Of<LayerMetrics> auto& metrics, Visit&& visit) {
  zone_members(metrics, visit);
  visit("segregation_index", metrics.segregation_index);
  visit("lacey_index", metrics.lacey_index);
  visit("bins", metrics.bins);
  visit("surface", metrics.surface);
}

template <class Visit>
void members(Of<MeltSection> auto& section, Visit&& visit) {
  visit("x", section.x);
  visit("y0", section.y0);
  visit("z0", section.z0);
  visit("cell", section.cell);
  visit("ny", section.ny);
  visit("nz", section.nz);
  visit("peak_temperature", section.peak_temperature);
  visit("state", section.state);
}

template <class Visit>
void members(Of<Consolidation> auto& part, Visit&& visit) {
  visit("grains_melted", part.grains_melted);
  visit("grains_trapped", part.grains_trapped);
  visit("grains_moved", part.grains_moved);
  visit("melted_mass", part.melted_mass);
  visit("melted_cell_mass", part.melted_cell_mass);
  visit("largest_displacement", part.largest_displacement);
  visit("surface_height_correction", part.surface_height_correction);
  visit("mesh_volume", part.mesh_volume);
  visit("field_volume", part.field_volume);
  visit("triangles", part.triangles);
  visit("part_relative_density", part.part_relative_density);
}

template <class Visit>
void members(Of<MaterialShare> auto& share, Visit&& visit) {
  visit("name", share.name);
  visit("mass_share_fed", share.fed);
  visit("mass_share_layer", share.layer);
  visit("mass_share_layer_u_num", share.layer_u_num);
}

template <class Visit>
void members(Of<LayerRecord> auto& layer, Visit&& visit) {
  visit("layer", layer.layer);
  visit("grains_in_layer", layer.grains_in_layer);
  visit("grains_nipped", layer.grains_nipped);
  visit("metrics", layer.metrics);
  visit("stroke", layer.stroke);
  visit("blade_note", layer.blade_note);
  visit("materials", layer.materials);
  visit("absorptivity", layer.absorptivity);
  visit("absorptivity_standard_error", layer.absorptivity_standard_error);
  visit("mean_bounces", layer.mean_bounces);
  visit("rays", layer.rays);
  visit("absorbed_energy", layer.absorbed_energy);
  visit("start_temperature", layer.start_temperature);
  visit("peak_temperature", layer.peak_temperature);
  visit("pool", layer.pool);
  visit("pool_u_num", layer.pool_u_num);
  visit("sections", layer.sections);
  visit("consolidation", layer.consolidation);
  visit("part_surface", layer.part_surface);
  visit("pictures", layer.pictures);
}

template <class Visit>
void members(Of<Ledger> auto& ledger, Visit&& visit) {
  visit("mass_fed", ledger.mass_fed);
  visit("mass_bed", ledger.mass_bed);
  visit("mass_overflow", ledger.mass_overflow);
  visit("mass_melted", ledger.mass_melted);
  visit("mass_evaporated", ledger.mass_evaporated);
  visit("mass_lost", ledger.mass_lost);
  visit("mass_relative_error", ledger.mass_relative_error);
  visit("particles_fed", ledger.particles_fed);
  visit("particles_bed", ledger.particles_bed);
  visit("particles_overflow", ledger.particles_overflow);
  visit("particles_melted", ledger.particles_melted);
  visit("particles_lost", ledger.particles_lost);
  visit("particles_trapped", ledger.particles_trapped);
  visit("power_incident", ledger.power_incident);
  visit("power_absorbed", ledger.power_absorbed);
  visit("power_escaped", ledger.power_escaped);
  visit("power_attenuated", ledger.power_attenuated);
  visit("power_residual", ledger.power_residual);
  visit("ray_energy_relative_error", ledger.ray_energy_relative_error);
  visit("power_rescaling", ledger.power_rescaling);
  visit("heat_in", ledger.heat_in);
  visit("heat_stored", ledger.heat_stored);
  visit("heat_out", ledger.heat_out);
  visit("heat_energy_relative_error", ledger.heat_energy_relative_error);
  visit("surface_height_correction", ledger.surface_height_correction);
  visit("energy_wall_work", ledger.energy_wall_work);
  visit("energy_kinetic", ledger.energy_kinetic);
  visit("energy_potential", ledger.energy_potential);
  visit("energy_elastic", ledger.energy_elastic);
  visit("energy_carried_out", ledger.energy_carried_out);
  visit("energy_dissipated_normal", ledger.energy_dissipated_normal);
  visit("energy_dissipated_tangential", ledger.energy_dissipated_tangential);
  visit("energy_dissipated_rolling", ledger.energy_dissipated_rolling);
  visit("energy_dissipated_gas", ledger.energy_dissipated_gas);
  visit("energy_dissipated_sleep", ledger.energy_dissipated_sleep);
  visit("energy_residual", ledger.energy_residual);
  visit("energy_work_done", ledger.energy_work_done);
  visit("energy_relative_error_dem", ledger.energy_relative_error_dem);
}

template <class Visit>
void members(Of<WallTime> auto& time, Visit&& visit) {
  visit("dem", time.dem);
  visit("rays", time.rays);
  visit("heat", time.heat);
  visit("mesh", time.mesh);
  visit("io", time.io);
  visit("total", time.total);
}

template <class Visit>
void members(Of<RunRecord> auto& record, Visit&& visit) {
  visit("layers", record.layers);
  visit("ledger", record.ledger);
  visit("mass_fed_by_material", record.mass_fed_by_material);
  visit("wall_time", record.wall_time);
}

template <class T>
concept Array = requires(T const& values) {
  typename T::allocator_type;
}
&&!std::same_as<T, std::string>;
template <class T>
concept JsonKnows = std::integral<T> || std::same_as<T, std::string> || std::same_as<T, std::array<std::string, 2>>;

// nlohmann::json writes the shortest decimals that read back to the same double, but has no word for what is not
// finite.
json encode_number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

double decode_number(json const& from) {
  if (from.is_number()) return from.get<double>();
  std::string const word = from.get<std::string>();
  double const infinity = std::numeric_limits<double>::infinity();
  return word == "inf" ? infinity : word == "-inf" ? -infinity : std::numeric_limits<double>::quiet_NaN();
}

template <class T>
json encode(T const& value) {
  if constexpr (std::floating_point<T>) {
    return encode_number(value);
  } else if constexpr (JsonKnows<T>) {
    return value;
  } else if constexpr (Array<T>) {
    json array = json::array();
    for (auto const& element : value) array.push_back(encode(element));
    return array;
  } else {
    json object = json::object();
    members(value, [&](char const* name, auto const& member) { object[name] = encode(member); });
    return object;
  }
}

template <class T>
void decode(json const& from, T& value) {
  if constexpr (std::floating_point<T>) {
    value = static_cast<T>(decode_number(from));
  } else if constexpr (JsonKnows<T>) {
    from.get_to(value);
  } else if constexpr (Array<T>) {
    value.resize(from.get_ref<json::array_t const&>().size());
    for (std::size_t i = 0; i < value.size(); ++i) decode(from[i], value[i]);
  } else {
    members(value, [&](char const* name, auto& member) { decode(from.at(name), member); });
  }
}

void add_laser_keys(json& entry, LayerRecord const& layer) {
  entry["absorptivity"] = layer.absorptivity;
  entry["absorptivity_u_num"] = layer.absorptivity_standard_error;
  entry["mean_bounces"] = layer.mean_bounces;
  entry["rays"] = layer.rays;
  entry["start_temperature"] = layer.start_temperature;
  entry["peak_temperature"] = layer.peak_temperature;
  entry["pool"] = encode(layer.pool);
  members(layer.pool_u_num, [&](std::string const& name, double value) { entry["pool"][name + "_u_num"] = value; });
  entry["melted_mass"] = layer.consolidation.melted_mass;
  // What lies between the mass of melted cells and the mass of whole grains is the rounding of the half-or-more rule.
  entry["melted_mass_u_num"] = std::abs(layer.consolidation.melted_mass - layer.consolidation.melted_cell_mass);
}

/// The bins of a layer; what is the volume fraction of a layer is called relative density there.
json bins_summary(LayerRecord const& layer) {
  json bins = encode(layer.metrics.bins);
  for (json& bin : bins) {
    for (std::string const ending : {"", "_u_num"}) {
      bin["relative_density" + ending] = bin["volume_fraction_real" + ending];
      bin.erase("volume_fraction_real" + ending);
    }
  }
  return bins;
}

json layer_summary(LayerRecord const& layer, Case const& checked) {
  json entry = encode(layer.metrics);
  entry.erase("surface");
  entry["bins"] = bins_summary(layer);
  entry.update(encode(layer.stroke));
  entry["layer"] = layer.layer;
  entry["grains_in_layer"] = layer.grains_in_layer;
  entry["grains_nipped"] = layer.grains_nipped;
  for (MaterialShare const& share : layer.materials) {
    entry["by_material"][share.name] = encode(share);
    entry["by_material"][share.name].erase("name");
  }
  if (!layer.blade_note.empty()) entry["blade_note"] = layer.blade_note;
  if (checked.has_laser()) add_laser_keys(entry, layer);
  if (!checked.has_part()) return entry;
  Consolidation const& part = layer.consolidation;
  entry["part_relative_density"] = part.part_relative_density;
  entry["grains_melted"] = part.grains_melted;
  entry["grains_trapped"] = part.grains_trapped;
  entry["grains_moved"] = part.grains_moved;
  return entry;
}

/// Without the energy of the grains where it was not booked.
json ledger_summary(Ledger const& ledger, Case const& checked) {
  json entries = encode(ledger);
  if (checked.run.energy_ledger) return entries;
  json kept = json::object();
  for (auto const& [key, value] : entries.items())
    if (!key.starts_with("energy_")) kept[key] = value;
  return kept;
}

/// A number that is not finite has a word in the record, and is nothing in a summary.
void blank_what_is_not_finite(json& value) {
  if (value == "nan" || value == "inf" || value == "-inf") value = nullptr;
  if (value.is_structured())
    for (json& member : value) blank_what_is_not_finite(member);
}

}  // namespace

void to_json(json& to, RunRecord const& record) { to = encode(record); }

void from_json(json const& from, RunRecord& record) {
  try {
    decode(from, record);
  } catch (json::exception const& error) {
    throw FileError(
        fmt::format("the record of the run is damaged ({}); go back to an earlier checkpoint", error.what()));
  }
}

std::map<std::string, std::string> definitions(ReportExtras const& extras) {
  std::map<std::string, std::string> all{
      {"absorptivity",
       "absorbed over incident laser power, mean over the exposure of the layer, before any rescaling; light that "
       "leaves "
       "the scene after reflections is not absorbed"},
      {"absorptivity_u_num",
       "standard error of the absorptivity from independent sets of rays; where powder melts under the beam the cells "
       "add an "
       "error that goes as their size, some 0.04 at 5 um, which melt.two_grids measures"},
      {"mean_bounces", "hits on a surface per ray"},
      {"melted_mass",
       "mass of the grains that had at least half of their volume in melted cells; they join the solid with their "
       "whole mass"},
      {"melted_mass_u_num",
       "difference between that mass and the powder mass inside melted cells: what the half-or-more rule rounds"},
      {"pool.width",
       "largest width across the track at mid-track inside the isotherm of heat.pool_isotherm, mean over the tracks"},
      {"pool.depth",
       "depth of the same isotherm below the surface that the powder was spread on, at mid-track, mean over the "
       "tracks"},
      {"pool.length",
       "largest extent along the track of what is above the isotherm at one instant, mean over the tracks"},
      {"pool.*_u_num", "half a cell in each direction, combined with the scatter between cuts"},
      {"start_temperature", "of metal, powder and far field when the exposure of the layer began"},
      {"peak_temperature", "highest temperature that any cell reached"},
      {"part_relative_density", "metal over metal and enclosed voids of the part so far, the plate left out"},
      {"grains_trapped", "melted by half or more, but enclosed in the part as whole grains"},
      {"grains_nipped",
       "grains caught between the rigid blade and an edge (overlap above 2 % of the diameter), taken out and booked as "
       "overflow"},
      {"by_material.*.mass_share_fed", "share of the material in the mass of all powder fed so far"},
      {"by_material.*.mass_share_layer",
       "share of the material in the mass of the grains that the layer added to the deposition zone"},
      {"by_material.*.mass_share_layer_u_num",
       "standard deviation of that share among grains of these sizes that are drawn at random from powder.mixture"},
      {"energy_relative_error_dem",
       "residual of the energy of the moving grains over the work that moving walls and gravity did on "
       "them; what was moved between strokes as one body (piston, plate) is left out"},
      {"energy_dissipated_tangential",
       "slip, damping, and what tangential springs lose as the contact under them shrinks"},
      {"energy_carried_out", "kinetic, potential and elastic energy of grains that were taken out during a stroke"},
      {"grains_moved", "grains that were moved clear of the new surface"},
      {"surface_height_correction", "mean change of the surface by levelling of the melt and resettling of grains"},
  };
  for (auto const& [quantity, sentence] : extras.definitions) all[quantity] = sentence;
  return all;
}

json summary(Case const& checked, RunRecord const& record, ReportExtras const& extras) {
  bool const spreading = checked.process == Process::spreading;
  json all = json::object();
  all["layers"] = json::array();
  for (LayerRecord const& layer : record.layers) all["layers"].push_back(layer_summary(layer, checked));
  if (spreading) {
    all.update(encode(record.layers.back().stroke));
    all["bins"] = bins_summary(record.layers.back());
  }
  all["ledger"] = ledger_summary(record.ledger, checked);
  blank_what_is_not_finite(all);
  all["verb"] = spreading ? "spread" : "run";
  all["case"] = checked.name;
  all["seed"] = checked.seed;
  all["version"] = extras.version;
  all["wall_time"] = encode(record.wall_time);
  all["definitions"] = definitions(extras);
  return all;
}

}  // namespace layerloop::coupling
