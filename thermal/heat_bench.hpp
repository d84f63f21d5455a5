#pragma once
#include <cstdint>
#include <vector>

#include "core/material.hpp"
#include "core/melt_record.hpp"

namespace layerloop::thermal {

/// How fast explicit steps are, beside a triad a = b + s c over arrays of one double a cell, in turn with them.
struct HeatBench {
  std::int64_t cells = 0;  ///< all with an unknown
  std::int64_t steps = 0;  ///< of each round
  int threads = 1;
  double cell_updates_per_second = 0;  ///< median of the rounds [1/s]
  double triad_bytes_per_second = 0;   ///< median, counting 24 bytes an element [B/s]
  double share_of_triad = 0;    ///< median over the rounds of updates / triad elements, a round being close in time
  double bytes_per_update = 0;  ///< that a step has to read and write, each array once [B]
  double liquid_share = 0;      ///< of the cells at the end
};

/// A full block of 316L, near a cube in cells of 5 um, far field on its sides and bottom, a molten spot in the middle
/// of its top and no cell at ambient. Latent heat and variable conductivity are on; nothing heats it, nothing drains
/// it. Calls `explicit_step`, which is what an exposure calls. \pre one process, PETSc runs
HeatBench bench_heat(std::int64_t cells, std::int64_t steps, int threads);

/// One track on a plate of 1.0 x 0.4 x 0.3 mm in cells of 5 um, 1 ms at 0.5 m/s, latent heat and variable conductivity.
struct TrackBench {
  double seconds = 0;      ///< of one thread: processor time
  double stable_step = 0;  ///< [s]
  std::int64_t sweeps = 0;
  PoolSize pool = {};
  double heat_error = 0;  ///< relative, of the ledger
};

/// Explicit steps of all cells; the same with cold cells asleep; and as HeatSolver::automatic chooses.
enum class TrackSteps { all_cells, cold_cells_asleep, automatic };

/// \param absorbed [W] \pre one process, PETSc runs
TrackBench bench_track(Material const& metal, double absorbed, TrackSteps steps, double cell = 5e-6);

/// A plate, near a cube in cells of 20 um, far field 50 mm away, that was heated by 30 W in the middle of its top for 1
/// ms.
struct DwellBench {
  std::int64_t cells = 0;
  double seconds = 0;  ///< for the dwell alone, as of a track
  std::int64_t sweeps = 0;
  double heat_error = 0;          ///< relative, of the ledger
  double heat_kept = 0;           ///< share of the heat at the end
  std::vector<double> rise = {};  ///< on the top in the middle, at the quarter and in the corner [K]
};

/// \param restart  0: the dwell in one go; else steps begin small again whenever time has grown by this factor, which
/// makes them many times finer \pre one process, PETSc runs
DwellBench bench_dwell(std::int64_t cells, double dwell, double restart);

}  // namespace layerloop::thermal
