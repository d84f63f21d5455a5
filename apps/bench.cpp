#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "apps/verbs.hpp"
#include "core/bed_file.hpp"
#include "core/error.hpp"
#include "core/material.hpp"
#include "dem/settled_bed_bench.hpp"
#include "raytrace/ray_bench.hpp"
#include "thermal/heat_bench.hpp"

namespace layerloop::apps {
namespace {

struct BenchOptions {
  std::filesystem::path packing;
  std::int64_t steps = 1000;
  int threads = 1;
  std::int64_t rays = 300'000;
  bool uniform = false;
  std::int64_t cells = 1'000'000;
  bool tracks = false, plain = false;
  double cell = 5e-6, dwell = 0;  // [m], [s]
};

void bench_dem(BenchOptions const& options) {
  Communicator const comm;
  omp_set_num_threads(options.threads);
  dem::SettledBedBench const result = dem::bench_settled_bed(read_bed(options.packing), options.steps, comm);
  if (!comm.is_root()) return;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  nlohmann::ordered_json json{{"particles", result.particles},
                              {"contacts", result.contacts},
                              {"steps", options.steps},
                              {"ranks", comm.size()},
                              {"threads", options.threads},
                              {"seconds", result.seconds},
                              {"particle_steps_per_second", result.particle_steps_per_second()},
                              {"peak_memory", static_cast<double>(usage.ru_maxrss) * 1024},
                              {"neighbour_rebuilds", result.rebuilds},
                              {"imbalance", result.imbalance}};
  for (auto const& [phase, seconds] : result.phases) json["phases"][phase] = seconds;
  fmt::print("{}\n", json.dump(2));
}

void bench_rays(BenchOptions const& options) {
  using raytrace::BenchLight;
  omp_set_num_threads(1);
  raytrace::RayBench const r = raytrace::bench_rays(read_bed(options.packing), options.rays,
                                                    options.uniform ? BenchLight::uniform : BenchLight::spot);
  nlohmann::ordered_json const json{
      {"particles", r.particles},
      {"paths", r.paths},
      {"secondary_rays", r.secondary_rays},
      {"hit_share", r.hit_share},
      {"light", options.uniform ? "uniform" : "spot"},
      {"backend", r.grid_chosen ? "grid" : "embree"},
      {"rays_per_second", r.tracer.median},
      {"embree_rays_per_second", r.built_in.median},
      {"embree_double_rays_per_second", r.embree.median},
      {"grid_rays_per_second", r.grid.median},
      {"tracer_over_embree", r.tracer.median / r.built_in.median},
      {"grid_over_embree", r.grid.median / r.built_in.median},
      {"best",
       {{"rays_per_second", r.tracer.best},
        {"embree_rays_per_second", r.built_in.best},
        {"embree_double_rays_per_second", r.embree.best},
        {"grid_rays_per_second", r.grid.best}}},
      {"build_seconds", {{"built_in", r.built_in_build}, {"embree", r.embree_build}, {"grid", r.grid_build}}},
      {"hits_differing", r.hits_differing},
      {"hits_differing_plainly", r.hits_differing_plainly},
      {"absorptivity", r.reached_absorptivity},
      {"standard_error", r.reached_standard_error},
      {"seconds_to_standard_error", r.seconds_to_standard_error},
      {"rays_to_standard_error", r.rays_to_standard_error}};
  fmt::print("{}\n", json.dump(2));
}

/// A track of 316L with all cells at every step, with cold ones asleep, as chosen automatically; one of AlSi10Mg.
void bench_tracks(BenchOptions const& options) {
  using thermal::TrackSteps;
  omp_set_num_threads(options.threads);
  nlohmann::ordered_json json{{"cell", options.cell}};
  auto const run = [&](char const* name, char const* metal, double absorbed, TrackSteps steps) {
    auto const r = thermal::bench_track(built_in_materials().at(metal), absorbed, steps, options.cell);
    double const best = json.contains(name) ? std::min(r.seconds, json[name]["seconds"].get<double>()) : r.seconds;
    json[name] = {{"seconds", best},
                  {"sweeps", r.sweeps},
                  {"stable_step", r.stable_step},
                  {"width", r.pool.width},
                  {"depth", r.pool.depth},
                  {"length", r.pool.length},
                  {"heat_energy_relative_error", r.heat_error}};
    return best;
  };
  double all = 0, asleep = 0, aluminium = 0;
  for (int round = 0; round < 3; ++round) {  // the fastest of three: others use the machine too
    all = run("316L_all_cells", "316L", 20, TrackSteps::all_cells);
    asleep = run("316L", "316L", 20, TrackSteps::automatic);
    aluminium = run("AlSi10Mg", "AlSi10Mg", 36, TrackSteps::automatic);
  }
  if (options.plain) run("AlSi10Mg_explicit", "AlSi10Mg", 36, TrackSteps::cold_cells_asleep);
  json["asleep_over_all"] = asleep / all;
  json["AlSi10Mg_over_316L"] = aluminium / asleep;
  fmt::print("{}\n", json.dump(2));
}

void bench_dwell(BenchOptions const& options) {
  omp_set_num_threads(options.threads);
  auto const r = thermal::bench_dwell(options.cells, options.dwell, options.plain ? 1.3 : 0);
  nlohmann::ordered_json const json{{"cells", r.cells},
                                    {"dwell", options.dwell},
                                    {"seconds", r.seconds},
                                    {"sweeps", r.sweeps},
                                    {"rise", r.rise},
                                    {"heat_kept", r.heat_kept},
                                    {"heat_energy_relative_error", r.heat_error}};
  fmt::print("{}\n", json.dump(2));
}

void bench_heat(BenchOptions const& options) {
  if (Communicator().size() > 1) {
    throw InputError("bench heat runs on one process (its triad does) leave out mpiexec, and use --threads");
  }
  if (options.tracks) return bench_tracks(options);
  if (options.dwell > 0) return bench_dwell(options);
  thermal::HeatBench const r = thermal::bench_heat(options.cells, options.steps, options.threads);
  nlohmann::ordered_json const json{{"cells", r.cells},
                                    {"steps", r.steps},
                                    {"threads", r.threads},
                                    {"cell_updates_per_second", r.cell_updates_per_second},
                                    {"bytes_per_update", r.bytes_per_update},
                                    {"triad_bytes_per_second", r.triad_bytes_per_second},
                                    {"share_of_triad", r.share_of_triad},
                                    {"liquid_share", r.liquid_share}};
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

void add_bench(CLI::App& program, Action& chosen) {
  CLI::App* bench = program.add_subcommand("bench", "how fast the kernels are on this machine");
  bench->require_subcommand(1);
  CLI::App* verb =
      bench->add_subcommand("dem", "a settled bed under the thesis' contact law, every contact every step");
  auto const options = std::make_shared<BenchOptions>();
  verb->add_option("packing", options->packing, "the bed: csv, dump, extxyz or h5")->required()->type_name("PACKING");
  verb->add_option("--steps", options->steps, "steps that are timed, after 100 that are not")
      ->check(CLI::Range(1, 1'000'000'000));
  verb->add_option("--threads", options->threads, "threads of each rank")->check(CLI::Range(1, 1024));
  verb->callback([=, &chosen] { chosen = [=] { bench_dem(*options); }; });

  CLI::App* rays = bench->add_subcommand("rays", "flights between the grains of a bed, beside Embree's own spheres");
  rays->add_option("bed", options->packing, "the bed: csv, dump, extxyz or h5")->required()->type_name("BED");
  rays->add_option("--rays", options->rays, "reflected rays that are timed, about")
      ->check(CLI::Range(1000, 1'000'000'000));
  rays->add_flag("--uniform", options->uniform, "light over the whole bed instead of a spot of 60 um");
  rays->callback([=, &chosen] { chosen = [=] { bench_rays(*options); }; });

  CLI::App* heat = bench->add_subcommand("heat", "explicit heat steps of a full block, beside a triad");
  heat->add_option("--cells", options->cells, "cells, about")->check(CLI::Range(27, 1'000'000'000));
  heat->add_option("--steps", options->steps, "steps of each of seven rounds")->check(CLI::Range(1, 1'000'000'000));
  heat->add_option("--threads", options->threads, "threads")->check(CLI::Range(1, 1024));
  heat->add_flag("--tracks", options->tracks, "instead: tracks of 1 ms on a plate of 1.0 x 0.4 x 0.3 mm");
  heat->add_option("--cell", options->cell, "edge of their cells [m]")->check(CLI::Range(1e-6, 5e-5));
  heat->add_option("--dwell", options->dwell, "instead: a dwell of a heated plate [s]")->check(CLI::Range(0.0, 1e3));
  heat->add_flag("--plain", options->plain, "also AlSi10Mg in explicit steps; a dwell in many finer steps");
  heat->callback([=, &chosen] { chosen = [=] { bench_heat(*options); }; });
}

}  // namespace layerloop::apps
