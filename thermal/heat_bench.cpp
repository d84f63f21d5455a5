#include "thermal/heat_bench.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "core/huge_pages.hpp"
#include "thermal/exposure.hpp"
#include "thermal/heat_system.hpp"

namespace layerloop::thermal {
namespace {

constexpr int rounds = 7;
constexpr double ambient = 298;

/// Of one thread processor time, so that other programs on the machine count only by what they take from the caches; of
/// several the time on the wall, because threads burn time while they wait for one another [s].
template <class Work>
double seconds(Work const& work) {
  auto const now = [] {
    timespec time{};
    clock_gettime(omp_get_max_threads() == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  double const begin = now();
  work();
  return now() - begin;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + std::ssize(values) / 2);
  return values[values.size() / 2];
}

CellContent block(std::array<std::int32_t, 3> const& n, double cell) {
  CellContent content;
  content.grid.cell = cell;
  content.grid.n = n;
  auto const size = static_cast<std::size_t>(content.grid.size());
  content.solid.assign(size, 1);
  content.powder.assign(size, 0);
  content.grain.assign(size, -1);
  return content;
}

CellContent block(std::int64_t cells) {
  double const edge = std::cbrt(static_cast<double>(cells));
  auto const n = std::max(3, static_cast<std::int32_t>(std::lround(edge)));
  auto const across = static_cast<double>(std::int64_t{n} * n);
  return block({n, n, std::max(3, static_cast<std::int32_t>(std::lround(static_cast<double>(cells) / across)))}, 5e-6);
}

/// Everything is warm, the middle of the top molten.
void heat_up(HeatSystem& system) {
  LocalBox const& box = system.conduction.box;
  for (std::int32_t k = 0; k < box.n[2]; ++k) {
    for (std::int32_t j = 0; j < box.n[1]; ++j) {
      for (std::int32_t i = 0; i < box.n[0]; ++i) {
        double const x = (i + 0.5) / box.n[0] - 0.5, y = (j + 0.5) / box.n[1] - 0.5, z = (k + 0.5) / box.n[2] - 1;
        double const shape = std::exp(-12 * (x * x + y * y + z * z));
        system.enthalpy[static_cast<std::size_t>(box.index(i, j, k))] = system.table.liquidus() * (0.05 + 1.5 * shape);
      }
    }
  }
  finish_step(system, 0);
}

/// a = b + s c over `n` doubles, often enough to be timed [s an element].
class Triad {
 public:
  explicit Triad(std::size_t n) : a_(n), b_(n), c_(n) {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < n; ++i) a_[i] = 0, b_[i] = 1, c_[i] = 1e-3;
  }
  double seconds_per_element() {
    std::size_t const n = a_.size(), repeats = std::max<std::size_t>(1, 50'000'000 / n);
    double* __restrict const a = a_.data();
    double const *const b = b_.data(), *const c = c_.data();
    double const spent = seconds([&] {
#pragma omp parallel
      for (std::size_t r = 0; r < repeats; ++r) {
        double const factor = 1 + 1e-9 * static_cast<double>(r);  // so that no repeat can be left out
#pragma omp for simd schedule(static)
        for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + factor * c[i];
      }
    });
    return spent / static_cast<double>(n * repeats);
  }

 private:
  std::vector<double, HugePages<double>> a_, b_, c_;
};

/// Enthalpy and peak are read and written; outside the uniform stretches three shares and a capacity are read; the time
/// above the liquidus is read and written, and the flag of having melted read, where a row holds liquid.
double bytes_per_update(HeatSystem const& system) {
  double bytes = 0, cells = 0;
  for (std::size_t r = 0; r < system.conduction.rows.size(); ++r) {
    Row const &row = system.conduction.rows[r], &uniform = system.conduction.uniform[r];
    auto const all = static_cast<double>(row.end - row.begin);
    bool const liquid = std::any_of(system.enthalpy.begin() + row.begin, system.enthalpy.begin() + row.end,
                                    [&](double h) { return h >= system.table.liquidus(); });
    bytes += all * (24 + (liquid ? 9 : 0)) + (all - static_cast<double>(uniform.end - uniform.begin)) * 20;
    cells += all;
  }
  return bytes / cells;
}

}  // namespace

HeatBench bench_heat(std::int64_t cells, std::int64_t steps, int threads) {
  omp_set_num_threads(threads);
  Material const& metal = built_in_materials().at("316L");
  HeatCells const heat_cells = make_heat_cells(block(cells), SideY::far_field);
  EnthalpyTable const table(metal, ambient, 1.5 * metal.boiling_point);
  HeatGrid const grid(heat_cells.grid, false, Communicator());
  HeatSystem system =
      make_heat_system(table, grid, make_conduction(heat_cells, grid.box(), {1e-3, 1e-3}, 25, 0), SurfaceSink{});
  double const dt = 0.95 * stable_step(system.conduction, table);
  Triad triad(static_cast<std::size_t>(heat_cells.unknowns));
  HeatBench result{.cells = heat_cells.unknowns, .steps = steps, .threads = threads};
  std::vector<double> updates, bandwidths, shares;
  for (int round = 0; round <= rounds; ++round) {
    double const element = triad.seconds_per_element();
    heat_up(system);
    double const spent = seconds([&] {
      for (std::int64_t i = 0; i < steps; ++i) explicit_step(system, {}, dt);
    });
    if (round == 0) continue;  // cold memory
    updates.push_back(static_cast<double>(result.cells * steps) / spent);
    bandwidths.push_back(24 / element);
    shares.push_back(updates.back() * element);
  }
  result.cell_updates_per_second = median(updates);
  result.triad_bytes_per_second = median(bandwidths);
  result.share_of_triad = median(shares);
  result.bytes_per_update = bytes_per_update(system);
  auto const liquid = std::ranges::count_if(system.enthalpy, [&](double h) { return h >= table.liquidus(); });
  result.liquid_share = static_cast<double>(liquid) / static_cast<double>(result.cells);
  return result;
}

namespace {

constexpr double track_speed = 0.5, track_spot = 80e-6, track_time = 1e-3;  // [m/s], D4sigma [m], [s]

/// Powers of a Gaussian beam on the top cells, each cell's part integrated, in stretches of two cells of travel.
HeatSource gaussian_track(VoxelGrid const& grid, double absorbed) {
  HeatSource source;
  double const length = track_speed * track_time, s = std::sqrt(2.0) * track_spot / 4, half = grid.cell / 2;
  double const begin = 0.5 * (grid.n[0] * grid.cell - length), y = 0.5 * grid.n[1] * grid.cell;
  auto const stretches = static_cast<int>(std::lround(length / (2 * grid.cell)));
  auto const part = [&](double from_beam) {
    return 0.5 * (std::erf((from_beam + half) / s) - std::erf((from_beam - half) / s));
  };
  for (int m = 0; m < stretches; ++m) {
    source.time.push_back(track_time * m / stretches);
    AbsorbedPower power;
    for (std::int32_t j = 0; j < grid.n[1]; ++j) {
      for (std::int32_t i = 0; i < grid.n[0]; ++i) {
        Vec3 const c = grid.centre(i, j, grid.n[2] - 1);
        double const watts = absorbed * part(c.x() - begin - length * (m + 0.5) / stretches) * part(c.y() - y);
        if (watts < 1e-7 * absorbed) continue;
        power.cell.push_back(grid.index(i, j, grid.n[2] - 1));
        power.watts.push_back(watts);
      }
    }
    source.power.push_back(power);
  }
  source.time.push_back(track_time);
  source.tracks.push_back({{begin, y, 0}, {begin + length, y, 0}, 0, track_time, absorbed});
  return source;
}

}  // namespace

TrackBench bench_track(Material const& metal, double absorbed, TrackSteps steps, double cell) {
  auto const count = [&](double size) { return static_cast<std::int32_t>(std::lround(size / cell)); };
  CellContent content = block({count(1.0e-3), count(0.4e-3), count(0.3e-3)}, cell);
  content.grid.origin = {0, 0, -content.grid.n[2] * cell};
  Communicator const comm;
  HeatCells const cells = make_heat_cells(content, SideY::far_field);
  EnthalpyTable const table(metal, ambient, 1.5 * metal.boiling_point);
  HeatGrid const grid(cells.grid, false, comm);
  double const far = 0.4e-3;
  HeatSystem system = make_heat_system(
      table, grid, make_conduction(cells, grid.box(), {far, far}, metal.conductivity(metal.solidus), 0), {});
  system.awake.cold = steps == TrackSteps::all_cells ? AwakeRows::Cold::awake : AwakeRows::Cold::asleep;
  HeatSource const source = gaussian_track(content.grid, absorbed);
  PoolObserver pools(cells, content, source.tracks, {metal.liquidus, metal.boiling_point}, comm);
  HeatSolver const solver = steps == TrackSteps::automatic ? HeatSolver::automatic : HeatSolver::explicit_steps;
  Exposure exposure(system, cells, pools, solver, 1.5 * metal.boiling_point, comm);
  TrackBench result{.stable_step = stable_step(system.conduction, table)};
  result.seconds = seconds([&] {
    for (std::size_t i = 0; i < source.power.size(); ++i)
      exposure.heat(source.power[i], source.time[i + 1] - source.time[i], source.time[i]),
          exposure.check_now_and_then();
  });
  exposure.rest(0, track_time);  // checks
  pools.finish(system);
  MeltRecord record;
  pools.write(record);
  HeatOutcome outcome;
  exposure.write(outcome);
  result.pool = record.pool;
  result.sweeps = outcome.explicit_steps;
  result.heat_error = outcome.heat_energy_relative_error;
  return result;
}

DwellBench bench_dwell(std::int64_t cells_wanted, double dwell, double restart) {
  double const cell = 20e-6, pulse = 1e-3;
  CellContent content = block(cells_wanted);
  content.grid.cell = cell;
  Communicator const comm;
  Material const& metal = built_in_materials().at("316L");
  HeatCells const cells = make_heat_cells(content, SideY::far_field);
  EnthalpyTable const table(metal, ambient, 1.5 * metal.boiling_point);
  HeatGrid const grid(cells.grid, false, comm);
  HeatSystem system = make_heat_system(
      table, grid, make_conduction(cells, grid.box(), {50e-3, 50e-3}, metal.conductivity(metal.solidus), 0), {});
  std::vector<Track> const no_tracks;
  PoolObserver pools(cells, content, no_tracks, {metal.liquidus, metal.boiling_point}, comm);
  Exposure exposure(system, cells, pools, HeatSolver::automatic, 1.5 * metal.boiling_point, comm);
  auto const& n = content.grid.n;
  AbsorbedPower power;
  for (std::int32_t j = -5; j < 5; ++j) {
    for (std::int32_t i = -5; i < 5; ++i)
      power.cell.push_back(content.grid.index(n[0] / 2 + i, n[1] / 2 + j, n[2] - 1));
  }
  power.watts.assign(power.cell.size(), 0.3);
  exposure.heat(power, pulse, 0);
  DwellBench result{.cells = cells.unknowns};
  HeatOutcome before, after;
  exposure.write(before);
  result.seconds = seconds([&] {
    for (double at = 0, next = restart == 0 ? dwell : 1e-3; at < dwell;
         at = next, next = std::min(dwell, restart * next))
      exposure.rest(next - at, pulse + at);
  });
  exposure.write(after);
  result.sweeps = after.explicit_steps - before.explicit_steps;
  result.heat_error = after.heat_energy_relative_error;
  result.heat_kept = after.heat_stored / after.heat_in;
  for (double const place : {0.5, 0.25, 0.0}) {
    auto const at = [&](std::int32_t cells_along) {
      return std::min(cells_along - 1, static_cast<std::int32_t>(place * cells_along));
    };
    result.rise.push_back(
        table.temperature(
            system.enthalpy[static_cast<std::size_t>(system.conduction.box.index(at(n[0]), at(n[1]), n[2] - 1))]) -
        ambient);
  }
  return result;
}

}  // namespace layerloop::thermal
