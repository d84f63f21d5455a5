#include "coupling/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coupling/effects/spot_drift.hpp"
#include "coupling/optics_of_case.hpp"
#include "coupling/scan_path.hpp"
#include "raytrace/trace.hpp"

namespace layerloop::coupling {
namespace {

std::vector<BeamStop> beam_stops(std::vector<Track> const& tracks, double spacing) {
  std::vector<BeamStop> stops;
  for (Track const& track : tracks) {
    Vec3 const along = track.end - track.begin;
    auto const count = std::max<std::int64_t>(1, std::llround(along.norm() / spacing));
    double const duration = track.end_time - track.begin_time;
    for (std::int64_t s = 0; s < count; ++s) {
      auto const share = [&](double part) { return (static_cast<double>(s) + part) / static_cast<double>(count); };
      stops.push_back({track.begin + share(0.5) * along, along.normalized(), track.begin_time + share(0.0) * duration,
                       track.begin_time + share(1.0) * duration, track.power});
    }
  }
  return stops;
}

/// Walls of a keyhole recede by at most a cell between two traces [m/s].
constexpr double drilling_speed = 6;

/// Absorptivity of a cone of a grey material (Gouffe 1945). \param flat  that of the material
double absorptivity_of_cone(double flat, double radius, double depth) {
  if (depth == 0) return flat;
  double const slope2 = radius * radius + depth * depth;
  double const mouth = radius / std::sqrt(slope2);  // area of the mouth over that of the wall
  double const seen = radius * radius / slope2;     // solid angle of the mouth from the tip over pi
  return flat * (1 + (1 - flat) * (mouth - seen)) / (flat * (1 - mouth) + mouth);
}

/// The given absorptivity instead of a trace: the Gaussian beam on the topmost metal of every column (periodic in y).
AbsorbedPower prescribed_absorption(BeamStop const& stop, double flat, double spot_radius, CellContent const& cells,
                                    MeltState const& now) {
  VoxelGrid const& grid = cells.grid;
  double const width = grid.cell * grid.n[1];
  auto const share = [&](double from, double to) {  // of a Gaussian of standard deviation w/2 between two offsets
    return 0.5 * (std::erf(std::sqrt(2.0) * to / spot_radius) - std::erf(std::sqrt(2.0) * from / spot_radius));
  };
  double const absorptivity = absorptivity_of_cone(flat, now.keyhole_radius, now.keyhole_depth);
  AbsorbedPower power;
  power.incident = stop.power;
  power.absorptivity = absorptivity;
  power.absorbed = absorptivity * stop.power;
  power.escaped = stop.power - power.absorbed;
  double on_grid = 0;
  std::vector<std::pair<std::int64_t, double>> deposits;  // cell, watts
  for (std::int32_t j = 0; j < grid.n[1]; ++j) {
    double const y = grid.origin.y() + j * grid.cell - stop.centre.y();
    double const share_y =
        share(y, y + grid.cell) + share(y - width, y - width + grid.cell) + share(y + width, y + width + grid.cell);
    for (std::int32_t i = 0; i < grid.n[0]; ++i) {
      double const x = grid.origin.x() + i * grid.cell - stop.centre.x();
      double const watts = power.absorbed * share_y * share(x, x + grid.cell);
      if (watts < 1e-12 * stop.power) continue;
      std::int32_t k = grid.n[2] - 1;
      auto const metal = [&](std::int32_t level) {
        auto const c = static_cast<std::size_t>(grid.index(i, j, level));
        return cells.solid[c] + cells.powder[c];
      };
      while (k > 0 && metal(k) < 0.5) --k;
      if (!now.keyhole.empty()) {
        double const wall = now.keyhole[static_cast<std::size_t>(i + std::int64_t{grid.n[0]} * j)];
        while (k > 0 && grid.centre(i, j, k).z() > wall) --k;
      }
      deposits.emplace_back(grid.index(i, j, k), watts);
      on_grid += watts;
    }
  }
  std::ranges::sort(deposits);
  for (auto const& [cell, watts] : deposits) {
    power.cell.push_back(cell);
    power.watts.push_back(watts);
  }
  power.outside_grid = power.absorbed - on_grid;
  return power;
}

}  // namespace

Exposure plan_exposure(Case const& checked, std::int32_t layer) {
  Exposure exposure;
  HeatSource& source = exposure.source;
  source.tracks = scan_path(checked, layer);
  source.beam_radius = checked.laser.spot_radius();
  // Without rays a position costs little: one for every cell of travel.
  double spacing = checked.optics.position_spacing;
  if (checked.laser.absorptivity) spacing = std::min(spacing, checked.heat.cell_size);
  if (checked.effect_strength("keyhole") != 0)
    spacing = std::min(spacing, checked.scan.scan_speed * checked.heat.cell_size / drilling_speed);
  exposure.stops = beam_stops(source.tracks, spacing);
  for (BeamStop& stop : exposure.stops) {
    stop.on_time = exposure.on_time;
    exposure.on_time += stop.end_time - stop.begin_time;
  }
  exposure.stops_per_levelling = static_cast<std::size_t>(std::ceil(checked.optics.position_spacing / spacing - 1e-9));
  source.time.push_back(exposure.stops.front().begin_time);
  for (std::size_t s = 0; s < exposure.stops.size(); ++s) {
    if (exposure.stops[s].begin_time > source.time.back()) {  // the beam was off since the last track
      exposure.stop_of_stretch.push_back(-1);
      source.time.push_back(exposure.stops[s].begin_time);
    }
    exposure.stop_of_stretch.push_back(static_cast<std::int64_t>(s));
    source.time.push_back(exposure.stops[s].end_time);
  }
  source.power.resize(exposure.stop_of_stretch.size());
  exposure.plume = Plume(checked);
  exposure.modified = std::make_shared<ModifiedAbsorption const>(checked);
  if (!checked.laser.absorptivity) {
    exposure.beam = spot_beam(checked.laser, Vec3::Zero(), checked.laser.power);
    exposure.optics = optical_set(checked);
  }
  return exposure;
}

namespace {

/// What a stop absorbs of a beam of this power. \param laser  at this time
AbsorbedPower absorb(Exposure const& exposure, std::size_t s, double beam_power, LaserSettings const& laser,
                     MeltState const& now, raytrace::BedScene const& scene, CellContent const& cells,
                     Case const& checked, std::int32_t layer, Communicator const& comm) {
  BeamStop stop = exposure.stops[s];
  stop.power = beam_power;
  if (checked.laser.absorptivity)
    return prescribed_absorption(stop, *checked.laser.absorptivity, laser.spot_radius(), cells, now);
  raytrace::Beam beam = exposure.beam;
  if (laser.focus_offset != checked.laser.focus_offset) beam = spot_beam(laser, stop.centre, 0);
  beam.centre = stop.centre;
  beam.power = stop.power;
  // Every position draws its own rays: the errors of the positions are independent.
  std::uint64_t const id = static_cast<std::uint64_t>(layer) << 32 | static_cast<std::uint64_t>(s);
  raytrace::TraceSettings const settings{.rays = checked.optics.rays,
                                         .seed = checked.seed,
                                         .id = id,
                                         .polarisation = polarisation_of(checked),
                                         .diffuse_share = diffuse_share(checked)};
  return raytrace::trace(scene, beam, exposure.optics, floor_index(checked), cells.grid, settings, &comm);
}

/// Puts what effects of the user's make of the absorbed power in its place; the rest escapes.
void modify(AbsorbedPower& power, BeamStop const& stop, double speed, ModifiedAbsorption const& modified) {
  if (!modified.acts() || power.absorbed == 0) return;
  double const wanted = modified({stop.on_time, power.incident, power.absorbed, speed, stop.centre, stop.along});
  double const factor = wanted / power.absorbed;
  for (double& watts : power.watts) watts *= factor;
  power.outside_grid *= factor;
  power.escaped += power.absorbed - wanted;
  power.absorbed = wanted;
  power.absorptivity *= factor;
  power.standard_error *= factor;
}

/// Books what the plume took from a beam of `power` before the rest was absorbed as `absorbed` says.
void book_attenuation(AbsorbedPower& absorbed, double power) {
  double const passed = absorbed.incident / power;
  absorbed.attenuated = power - absorbed.incident;
  absorbed.incident = power;
  absorbed.absorptivity *= passed;
  absorbed.standard_error *= passed;
}

}  // namespace

void expose_stretch(Exposure& exposure, std::size_t stretch, MeltState const& now, raytrace::BedScene const& scene,
                    CellContent const& cells, Case const& checked, std::int32_t layer, Communicator const& comm) {
  HeatSource& source = exposure.source;
  if (stretch > 0) exposure.plume.feed(now.vapour_rate, source.time[stretch] - source.time[stretch - 1]);
  if (exposure.stop_of_stretch[stretch] < 0) return;
  auto const s = static_cast<std::size_t>(exposure.stop_of_stretch[stretch]);
  BeamStop const& stop = exposure.stops[s];
  LaserSettings const laser = drifted_laser(checked, (layer - 1) * exposure.on_time + stop.on_time);
  AbsorbedPower& power = source.power[stretch];
  power = absorb(exposure, s, stop.power * exposure.plume.transmission(stop.along), laser, now, scene, cells, checked,
                 layer, comm);
  modify(power, stop, checked.scan.scan_speed, *exposure.modified);
  book_attenuation(power, stop.power);
  accumulate(exposure.mean, power, (stop.end_time - stop.begin_time) / exposure.on_time);
  exposure.worst_ray_energy_error = std::max(exposure.worst_ray_energy_error, ray_energy_error(power));
}

AreaMap absorbed_energy(HeatSource const& source, VoxelGrid const& grid) {
  AreaMap map{grid.origin.x(), grid.origin.y(), grid.cell, grid.n[0], grid.n[1], {}};
  std::size_t const columns = static_cast<std::size_t>(grid.n[0]) * static_cast<std::size_t>(grid.n[1]);
  map.values.assign(columns, 0.0);
  for (std::size_t s = 0; s < source.power.size(); ++s) {
    double const duration = source.time[s + 1] - source.time[s];
    for (std::size_t c = 0; c < source.power[s].cell.size(); ++c) {
      map.values[static_cast<std::size_t>(source.power[s].cell[c]) % columns] +=
          source.power[s].watts[c] * duration / (grid.cell * grid.cell);
    }
  }
  return map;
}

}  // namespace layerloop::coupling
