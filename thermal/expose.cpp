#include "thermal/expose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/effect_catalogue.hpp"
#include "core/error.hpp"
#include "core/modifier.hpp"
#include "core/note_once.hpp"
#include "core/progress.hpp"
#include "thermal/effects/keyhole.hpp"
#include "thermal/effects/latent_heat.hpp"
#include "thermal/effects/marangoni.hpp"
#include "thermal/effects/powder_conductivity.hpp"
#include "thermal/effects/variable_conductivity.hpp"
#include "thermal/exposure.hpp"

namespace layerloop::thermal {
namespace {

void check(AbsorbedPower const& power, VoxelGrid const& grid) {
  bool const inside = std::ranges::all_of(power.cell, [&](std::int64_t c) { return c >= 0 && c < grid.size(); });
  bool const finite = std::ranges::all_of(power.watts, [](double w) { return std::isfinite(w) && w >= 0; });
  if (!inside || !finite || power.cell.size() != power.watts.size())
    throw InputError("heat source has a cell outside the heat grid or a power that is negative or not finite");
}

void check(HeatSource const& source, VoxelGrid const& grid) {
  if (source.time.size() != source.power.size() + 1 || !std::ranges::is_sorted(source.time)) {
    throw InputError(fmt::format("heat source has {} times for {} intervals (one more than intervals, ascending)",
                                 source.time.size(), source.power.size()));
  }
  for (AbsorbedPower const& power : source.power) check(power, grid);
}

/// Highest temperature that the model is trusted with [K]. With evaporation a surface under 2e10 W/m^2 settles 1500 K
/// above boiling, because the melt of this model cannot flow away from under its own vapour; beyond 2000 K something is
/// wrong.
double hottest_allowed(Material const& material, bool evaporation) {
  return evaporation ? material.boiling_point + 2000 : 1.5 * material.boiling_point;
}

SurfaceSink make_sink(HeatCells const& cells, HeatGrid const& grid, EnthalpyTable const& table,
                      Material const& material, double ambient, Effects const& effects) {
  SurfaceSink sink;
  double const evaporation = effect_strength(effects, "evaporation"),
               losses = effect_strength(effects, "surface_losses");
  if (evaporation != 0) sink.evaporation.emplace(material, evaporation);
  if (losses != 0)
    sink.losses.emplace(material, ambient, effect_parameter(effects, "surface_losses", "convection"), losses);
  if (!sink.evaporation && !sink.losses) return sink;
  sink.evaporation_onset = table.solidus();
  VoxelGrid const& voxels = cells.grid;
  for (std::int64_t c = 0; c < voxels.size(); ++c) {
    double const fill = cells.fill[static_cast<std::size_t>(c)];
    std::int64_t const own = grid.box().own(voxels.coordinates(c));
    if (own < 0 || fill == 0) continue;
    double const area = open_area(cells, c) * voxels.cell * voxels.cell;
    if (area > 0) sink.cells.push_back({own, area, fill * voxels.cell_volume()});
  }
  return sink;
}

/// 1: was above the liquidus. \note Collective
std::vector<char> melted_cells(HeatSystem const& system, HeatCells const& cells, Communicator const& comm) {
  std::vector<float> const flags(system.melted.begin(), system.melted.end());
  std::vector<float> const unknowns = gather<float>(cells, system.conduction.box, flags, comm);
  std::vector<char> melted(unknowns.size(), 0);
  for (std::size_t c = 0; c < melted.size(); ++c)
    melted[c] = cells.metal[c] && unknowns[static_cast<std::size_t>(cells.host[c])] > 0;
  return melted;
}

/// A Gaussian beam has 1 % of its power beyond 1.5 of its 1/e^2 radius.
constexpr double lit_radii = 1.5;

/// What the beam reaches at a time; nothing while it is off.
BeamReach reach_at(HeatSource const& source, double time) {
  for (Track const& track : source.tracks) {
    if (time < track.begin_time || time > track.end_time) continue;
    double const share = (time - track.begin_time) / (track.end_time - track.begin_time);
    return {track.begin + share * (track.end - track.begin), lit_radii * source.beam_radius};
  }
  return {Vec3::Zero(), -1};
}

/// Follows the keyhole to the temperatures of now. \note Collective
void update(Keyhole& keyhole, HeatSystem& system, HeatCells const& cells, Communicator const& comm,
            BeamReach const& beam, MeltState& state) {
  LocalBox const& box = system.conduction.box;
  std::vector<double> enthalpy = gather<double>(cells, box, system.enthalpy, comm);
  keyhole.update(enthalpy, system.table, beam);
  for (std::int64_t const c : keyhole.changed()) {
    std::int64_t const own = box.own(cells.grid.coordinates(c));
    if (own < 0) continue;
    double const h = enthalpy[static_cast<std::size_t>(c)];
    system.enthalpy[static_cast<std::size_t>(own)] = h;
    // What light piled up in a cell between two traces is no temperature that metal had.
    float& peak = system.peak[static_cast<std::size_t>(own)];
    peak = std::min(peak, static_cast<float>(system.table.enthalpy(keyhole.wall_temperature())));
  }
  if (!keyhole.changed().empty()) {
    system.grid.exchange(system.enthalpy);
    system.awake.forget();
  }
  state.keyhole = keyhole.wall();
  state.keyhole_radius = keyhole.radius();
  state.keyhole_depth = keyhole.depth();
}

MeltRecord make_record(HeatSystem const& system, HeatCells const& cells, Communicator const& comm) {
  MeltRecord record;
  record.grid = cells.grid;
  LocalBox const& box = system.conduction.box;
  record.peak_temperature = to_temperature(cells, system.table, gather<float>(cells, box, system.peak, comm));
  std::vector<float> const time = gather<float>(cells, box, system.time_above_liquidus, comm);
  record.melted = melted_cells(system, cells, comm);
  record.time_above_liquidus.assign(time.size(), 0);
  for (std::size_t c = 0; c < time.size(); ++c) {
    if (cells.metal[c]) record.time_above_liquidus[c] = time[static_cast<std::size_t>(cells.host[c])];
  }
  return record;
}

}  // namespace

HeatOutcome expose(CellContent const& content, HeatSource const& source, Material const& metal,
                   HeatSettings const& settings, Effects const& effects, SideY side_y, Communicator const& comm,
                   Report report, AbsorbedNow const& absorbed_now) {
  check(source, content.grid);
  HeatCells const cells = make_heat_cells(content, side_y);
  double const hottest = hottest_allowed(metal, effect_strength(effects, "evaporation") != 0);
  EnthalpyTable const table(metal, settings.ambient_temperature, hottest);
  double const isotherm = settings.isotherm(metal);
  PoolObserver pools(cells, content, source.tracks, {isotherm, metal.boiling_point}, comm);

  HeatGrid const grid(content.grid, side_y == SideY::periodic, comm);
  Conduction conduction =
      make_conduction(cells, grid.box(), {settings.margin, settings.substrate_depth}, metal.conductivity(metal.solidus),
                      contact_law(cells, settings, metal, effects));
  if (double const strength = effect_strength(effects, "marangoni"); strength != 0) {
    conduction.liquid = marangoni(table, strength, effect_parameter(effects, "marangoni", "lateral_factor"),
                                  effect_parameter(effects, "marangoni", "vertical_factor"));
  }
  HeatSystem system = make_heat_system(table, grid, std::move(conduction),
                                       make_sink(cells, grid, table, metal, settings.ambient_temperature, effects));
  Exposure exposure(system, cells, pools, settings.solver, hottest, comm);
  Progress progress("heat", source.time.back() - source.time.front(), report == Report::progress && comm.is_root());
  MeltState state{.melted = [&] { return melted_cells(system, cells, comm); }, .keyhole = {}};
  Keyhole keyhole(metal, cells, effect_strength(effects, "keyhole"));
  double evaporated = 0;  // [kg]
  for (std::size_t i = 0; i < source.power.size(); ++i) {
    double const begin = source.time[i], duration = source.time[i + 1] - begin;
    if (duration == 0) continue;
    if (absorbed_now) {
      absorbed_now(i, state);
      check(source.power[i], content.grid);
    }
    if (source.power[i].cell.empty()) {
      exposure.rest(duration, begin);
    } else {
      exposure.heat(source.power[i], duration, begin);
    }
    if (keyhole.acts()) update(keyhole, system, cells, comm, reach_at(source, begin + duration), state);
    exposure.check_now_and_then();
    double const before = std::exchange(evaporated, exposure.mass_evaporated());
    state.vapour_rate = (evaporated - before) / duration;
    progress.update(source.time[i + 1] - source.time.front());
  }
  HeatOutcome outcome;
  outcome.end_time = source.time.back() + exposure.freeze(source.time.back());
  pools.finish(system);
  exposure.write(outcome);
  outcome.melt = make_record(system, cells, comm);
  pools.write(outcome.melt);
  outcome.peak_temperature = *std::ranges::max_element(outcome.melt.peak_temperature);
  outcome.keyhole_depth = keyhole.deepest();
  outcome.cells = cells.unknowns;
  if (report == Report::progress && comm.is_root())
    for (std::string const& use : uses_beyond_range(metal, settings.ambient_temperature, outcome.peak_temperature))
      note_once(use);
  return outcome;
}

Material with_effects(Material metal, Effects const& effects) {
  apply_latent_heat(metal, effect_strength(effects, "latent_heat"));
  apply_variable_conductivity(metal, effect_strength(effects, "variable_conductivity"));
  return metal;
}

HeatOutcome expose(CellContent const& content, HeatSource const& source, Case const& settings, Communicator const& comm,
                   Report report, AbsorbedNow const& absorbed_now) {
  double const span = content.grid.cell * content.grid.n[1];
  bool const periodic = std::abs(span - settings.period_y()) < 0.01 * content.grid.cell;
  Case effective = settings;
  effective.material = with_effects(settings.material, settings.effects);
  return expose(content, source, modified_material(effective), settings.heat, settings.effects,
                periodic ? SideY::periodic : SideY::far_field, comm, report, absorbed_now);
}

}  // namespace layerloop::thermal
