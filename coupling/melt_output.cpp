#include "coupling/melt_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/json_number.hpp"
#include "core/statistics.hpp"
#include "core/vtkhdf.hpp"
#include "core/write_file.hpp"
#include "coupling/layer_output.hpp"
#include "coupling/program_version.hpp"
#include "coupling/report/csv_table.hpp"
#include "coupling/scan_path.hpp"
#include "coupling/stopwatch.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json pool(MeltStudy const& study) {
  PoolSize const& size = study.melted.heat.melt.pool;
  json all{{"width", size.width},   {"width_u_num", study.u_num.width},
           {"depth", size.depth},   {"depth_u_num", study.u_num.depth},
           {"length", size.length}, {"length_u_num", study.u_num.length}};
  double top = 0, area = 0;
  auto const& sections = study.melted.heat.melt.sections;
  for (TrackSection const& section : sections) {
    top += section.depth_from_top / static_cast<double>(sections.size());
    area += section.area / static_cast<double>(sections.size());
  }
  all["depth_from_top"] = top;
  all["area"] = area;
  if (study.bead_height.empty()) return all;
  Sample const bead = sample_of(study.bead_height);
  all["bead_height"] = bead.mean;
  all["bead_height_sd"] = number(bead.sd);
  return all;
}

json fusion(Fusion const& f) {
  return {{"unmelted_powder", f.unmelted_powder ? json(*f.unmelted_powder) : json(nullptr)},
          {"unmelted_surface", f.unmelted_surface},
          {"overlap_depth", f.overlap_depth},
          {"elliptic_overlap_depth", f.elliptic_overlap_depth}};
}

json tracks(MeltStudy const& study) {
  json all = json::array();
  auto const& path = study.melted.exposure.source.tracks;
  auto const back = return_times(path);
  for (std::size_t t = 0; t < path.size(); ++t) {
    PoolSize const& size = study.melted.heat.melt.track_pools[t];
    Track const& track = path[t];
    double const length = (track.end - track.begin).norm();
    all.push_back({{"track", t + 1},
                   {"x_begin", track.begin.x()},
                   {"y_begin", track.begin.y()},
                   {"x_end", track.end.x()},
                   {"y_end", track.end.y()},
                   {"begin_time", track.begin_time},
                   {"power", track.power},
                   {"speed", length / (track.end_time - track.begin_time)},
                   {"return_time", back[t] ? json(*back[t]) : json(nullptr)},
                   {"width", size.width},
                   {"depth", size.depth},
                   {"length", size.length}});
  }
  return all;
}

json consolidation(MeltStudy const& study) {
  Consolidation const& part = study.build.record.layers.back().consolidation;
  return {
      {"melted_mass", part.melted_mass},     {"melted_mass_u_num", std::abs(part.melted_mass - part.melted_cell_mass)},
      {"grains_melted", part.grains_melted}, {"grains_trapped", part.grains_trapped},
      {"grains_moved", part.grains_moved},   {"part_relative_density", part.part_relative_density}};
}

json ledger(MeltStudy const& study) {
  Ledger const& l = study.build.record.ledger;
  json all{{"power_incident", l.power_incident},
           {"power_absorbed", l.power_absorbed},
           {"power_escaped", l.power_escaped},
           {"power_residual", l.power_residual},
           {"power_rescaling", l.power_rescaling},
           {"power_outside_grid", study.melted.exposure.mean.outside_grid},
           {"ray_energy_relative_error", l.ray_energy_relative_error},
           {"heat_in", l.heat_in},
           {"heat_stored", l.heat_stored},
           {"heat_out", l.heat_out},
           {"heat_evaporated", study.melted.heat.heat_evaporated},
           {"heat_energy_relative_error", l.heat_energy_relative_error},
           {"mass_evaporated", l.mass_evaporated}};
  if (study.bead_height.empty()) return all;
  all.update({{"mass_fed", l.mass_fed},
              {"mass_bed", l.mass_bed},
              {"mass_melted", l.mass_melted},
              {"mass_relative_error", l.mass_relative_error},
              {"particles_fed", l.particles_fed},
              {"particles_bed", l.particles_bed},
              {"particles_melted", l.particles_melted},
              {"surface_height_correction", l.surface_height_correction}});
  return all;
}

json grid(MeltStudy const& study) {
  VoxelGrid const& g = study.cells.grid;
  json all{{"cell_size", g.cell},
           {"cells", g.size()},
           {"size", {g.cell * g.n[0], g.cell * g.n[1], study.placed.heat.substrate_depth}},
           {"explicit_steps", study.melted.heat.explicit_steps},
           {"implicit_steps", study.melted.heat.implicit_steps},
           {"estimated_pool",
            {{"absorptivity", study.estimate.absorptivity},
             {"width", study.estimate.pool.width},
             {"depth", study.estimate.pool.depth},
             {"length", study.estimate.pool.length}}},
           {"largest_edge_temperature_rise", number(edge_temperature_rise(study))}};
  if (!study.second_grid) return all;
  PoolSize const& pool = study.second_grid->pool;
  all["second_grid"] = {{"cell_size", study.second_grid->cell_size},
                        {"width", pool.width},
                        {"depth", pool.depth},
                        {"length", pool.length},
                        {"absorptivity", study.second_grid->absorptivity},
                        {"order", 2},
                        {"order_is", "assumed"}};
  return all;
}

json definitions(MeltStudy const& study) {
  bool const two = study.second_grid.has_value();
  std::string const isotherm = study.placed.heat.pool_isotherm;
  return {
      {"pool.width",
       "largest width across the track inside the isotherm, in the plane normal to the track; mean over "
       "five sections between a quarter and three quarters of every track"},
      {"pool.depth", "depth of that isotherm below the original surface of the plate, mean over the same sections"},
      {"pool.depth_from_top", "the same below the mean top of powder and plate before the exposure"},
      {"pool.length",
       "extent along the track of what is above the isotherm at one instant, mean over instants about mid-track"},
      {"pool.area", "area of the section inside the isotherm, molten powder included"},
      {"pool.*_u_num",
       two ? "difference to the second grid, whose cells are r times as large, over r^2 - 1 (Richardson, order "
             "2 assumed), combined with the scatter between sections"
           : "half a cell in each direction, combined with the scatter between sections"},
      {"pool.bead_height",
       "highest metal over the original surface within the pool's width after the melt has settled, mean over the "
       "sections; _sd: from section to section"},
      {"tracks[].return_time", "since the beam passed next to the middle of this track on the nearest earlier one [s]"},
      {"fusion",
       "between the outermost tracks, over the middle half of their length: unmelted_powder: share of the powder's "
       "volume that never melted; unmelted_surface: share of the area where the original surface never melted; "
       "overlap_depth: smallest melted depth on any line along the tracks; elliptic_overlap_depth: that of half "
       "ellipses of the pool's size (Tang et al. 2017)"},
      {"time_above_liquidus", "longest of any cell [s]; the field is in heat_NNNN.h5"},
      {"isotherm", "heat.pool_isotherm = " + isotherm},
      {"start_temperature", "of metal and far field when the exposure began"},
      {"peak_temperature", "highest temperature that any cell reached"},
      {"cooling_rate", "mean between the solidus and 100 K below it at the surface in the middle of the middle track"},
      {"cooling_rate_u_num", "half a time step at either end"},
      {"absorptivity", "absorbed over incident power, mean over the exposure; given, or of the rays"},
      {"standard_error", "of the absorptivity, from the rays; 0 where it was given"},
      {"normalised_enthalpy",
       "A P / (rho h_s sqrt(pi a v w^3)) with the absorptivity A above, w the 1/e2 radius of the beam, rho h_s the "
       "heat "
       "from ambient to the liquidus without latent heat, a the diffusivity at the solidus (King et al. 2014)"},
      {"regime",
       "none: no cell melts; no_fusion: what melts does not reach below the original surface; balling: on powder, "
       "longer than pi times its width (Rayleigh-Plateau) and mostly above that surface; conduction: all metal stays "
       "below the boiling point; keyhole: the vapour depression is deeper than the 1/e2 radius; transition: not as "
       "deep"},
      {"depression_depth", "of the effect keyhole where it is on, else how deep the boiling point reached"},
      {"grid.largest_edge_temperature_rise", "highest peak above ambient on the sides and the bottom of the plate [K]"},
  };
}

void write_sections(fs::path const& path, MeltStudy const& study) {
  CsvTable table(
      "track,along [m],x [m],y [m],width [m],depth [m],depth_from_top [m],area [m2],area_below [m2],boiling_depth [m],"
      "bead_height [m]");
  auto const& sections = study.melted.heat.melt.sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    TrackSection const& s = sections[i];
    table.row({static_cast<double>(s.track + 1), s.along, s.x, s.y, s.width, s.depth, s.depth_from_top, s.area,
               s.area_below, s.boiling_depth, study.bead_height.empty() ? 0.0 : study.bead_height[i]});
  }
  table.write(path);
}

void write_tracks(fs::path const& path, MeltStudy const& study) {
  CsvTable table(
      "track,x_begin [m],y_begin [m],x_end [m],y_end [m],begin_time [s],power [W],speed [m/s],return_time [s],"
      "width [m],depth [m],length [m]");
  for (json const& t : tracks(study)) {
    std::vector<double> row;
    for (char const* key : {"track", "x_begin", "y_begin", "x_end", "y_end", "begin_time", "power", "speed",
                            "return_time", "width", "depth", "length"})
      row.push_back(t.at(key).is_null() ? std::nan("") : t.at(key).get<double>());
    table.row(row);
  }
  table.write(path);
}

void write_probe(fs::path const& path, ProbeHistory const& probe) {
  CsvTable table("time [s],temperature [K]");
  for (std::size_t i = 0; i < probe.time.size(); ++i) table.row({probe.time[i], probe.temperature[i]});
  table.write(path);
}

}  // namespace

double edge_temperature_rise(MeltStudy const& study) {
  MeltRecord const& melt = study.melted.heat.melt;
  VoxelGrid const& grid = melt.grid;
  double hottest = 0;
  for (std::int64_t c = 0; c < grid.size(); ++c) {
    auto const [i, j, k] = grid.coordinates(c);
    if (i > 0 && i < grid.n[0] - 1 && j > 0 && j < grid.n[1] - 1 && k > 0) continue;
    hottest = std::max(hottest, static_cast<double>(melt.peak_temperature[static_cast<std::size_t>(c)]));
  }
  return hottest - study.melted.start_temperature;
}

json melt_summary(MeltStudy const& study) {
  thermal::HeatOutcome const& heat = study.melted.heat;
  AbsorbedPower const& light = study.melted.exposure.mean;
  WallTime const& time = study.build.record.wall_time;
  json all{{"verb", "melt"},
           {"case", study.placed.name},
           {"seed", study.placed.seed},
           {"version", program_version()},
           {"pool", pool(study)},
           {"regime", name_of(study.regime)},
           {"isotherm", study.placed.heat.pool_isotherm},
           {"depression_depth", depression_of(study)},
           {"start_temperature", study.melted.start_temperature},
           {"peak_temperature", heat.peak_temperature},
           {"time_above_liquidus", std::ranges::max(heat.melt.time_above_liquidus)},
           {"cooling_rate", study.cooling ? json(study.cooling->value) : json(nullptr)},
           {"cooling_rate_u_num", study.cooling ? json(study.cooling->u_num) : json(nullptr)},
           {"absorptivity", light.absorptivity},
           {"absorptivity_u_num", absorptivity_uncertainty(study)},
           {"standard_error", light.standard_error},
           {"normalised_enthalpy", normalised_enthalpy(study.placed, light.absorptivity)},
           {"spot_radius", study.placed.laser.spot_radius()},
           {"grid", grid(study)},
           {"ledger", ledger(study)},
           {"wall_time",
            {{"dem", time.dem},
             {"rays", time.rays},
             {"heat", time.heat},
             {"mesh", time.mesh},
             {"io", time.io},
             {"total", time.total}}},
           {"definitions", definitions(study)}};
  all["tracks"] = tracks(study);
  if (study.fusion) all["fusion"] = fusion(*study.fusion);
  if (!study.bead_height.empty()) all["solid"] = consolidation(study);
  return all;
}

MeltOutput::MeltOutput(Case const& placed, fs::path folder, Communicator const& comm)
    : folder_(std::move(folder)), writes_(comm.is_root()) {
  if (!writes_) return;
  std::error_code failure;
  fs::create_directories(folder_, failure);
  if (failure) throw FileError(fmt::format("cannot make the folder {} ({})", folder_.string(), failure.message()));
  write_file(folder_ / "case_resolved.toml", resolved_toml(placed));
}

void MeltOutput::write(MeltStudy& study) const {
  if (!writes_) return;
  MeltRecord const& melt = study.melted.heat.melt;
  {
    Stopwatch const timed(study.build.record.wall_time.io);
    write_heat_file(folder_ / fmt::format("heat_{:04}.h5", study.layer), study.cells, melt);
    if (!study.bead_height.empty()) {
      write_bed_file(folder_ / fmt::format("bed_{:04}.h5", study.layer), study.build.bed, study.build.substrate, {});
      write_stl(study.build.substrate, folder_ / fmt::format("solid_{:04}.stl", study.layer));
    }
    write_sections(folder_ / "sections.csv", study);
    write_tracks(folder_ / "tracks.csv", study);
    write_probe(folder_ / "probe.csv", melt.probe);
  }
  json const summary = melt_summary(study);
  json const line{{"event", "melted"},
                  {"regime", summary.at("regime")},
                  {"pool", summary.at("pool")},
                  {"absorptivity", summary.at("absorptivity")},
                  {"seconds", summary.at("wall_time").at("total")}};
  write_file(folder_ / "log.jsonl", line.dump() + "\n");
  write_file(folder_ / "report.html", melt_page(folder_, study));
  write_file(folder_ / "summary.json", summary.dump(2) + "\n");
}

}  // namespace layerloop::coupling
