#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "coupling/build_state.hpp"
#include "coupling/fusion.hpp"
#include "coupling/lit_bed.hpp"
#include "coupling/melt_layer.hpp"
#include "coupling/melt_plate.hpp"

namespace layerloop::coupling {

struct MeltOptions {
  std::filesystem::path folder;       ///< results go here; made when missing; empty: nothing is written
  BedSource bed;                      ///< where melt.bed is a file
  std::filesystem::path spread = {};  ///< folder of a layer that is spread; empty: `spread` in that of the results
  bool quiet = false;                 ///< no progress
};

/// What a track or patch looks like, from what is in the run.
enum class Regime { none, no_fusion, conduction, transition, keyhole, balling };
std::string const& name_of(Regime regime);

/// What the regime is told from. SI.
struct RegimeSigns {
  PoolSize pool;
  double height = 0;       ///< of the molten bead above the surface that the powder was spread on
  double depression = 0;   ///< depression_of()
  double spot_radius = 0;  ///< 1/e2
  bool molten = false;     ///< any cell
  bool boils = false;      ///< any cell
  bool powder = false;
};

/// none: no cell melts. no_fusion: what melts does not reach below the surface that the powder was spread on. balling:
/// on powder, a pool longer than its circumference as a free cylinder, pi times its width (Rayleigh and Plateau), most
/// of which stands above that surface. conduction: the metal stays below the boiling point. keyhole: the vapour
/// depression is deeper than the beam's 1/e2 radius. transition: it boils, but not as deep.
Regime regime_of(RegimeSigns const& signs);

/// Cooling of the probed surface, from the solidus to 100 K below it, after it was last molten.
struct CoolingRate {
  double value = 0;  ///< [K/s]
  double u_num = 0;  ///< one time step at either end
};
/// Nothing when the probe did not melt, or the exposure ended before it was cold.
std::optional<CoolingRate> cooling_rate(ProbeHistory const& probe, double solidus);

/// What the exposure repeated in larger cells came to.
struct SecondGrid {
  double cell_size = 0;  ///< [m]
  PoolSize pool;
  double absorptivity = 0;
};

/// One exposure and what explains it.
struct MeltStudy {
  Case placed;  ///< with plate and cells as chosen
  PoolEstimate estimate;
  BuildState build;  ///< afterwards: with powder, what melted is part of the solid
  std::int32_t layer = 1;
  MeltedLayer melted;
  CellContent cells;
  std::optional<SecondGrid> second_grid;  ///< with melt.two_grids
  PoolSize u_num;                         ///< of the pool
  double absorptivity_u_mesh = 0;         ///< error of the absorptivity from the cells, if there is a second grid
  Regime regime = Regime::none;
  std::optional<CoolingRate> cooling;
  std::optional<Fusion> fusion;     ///< of a patch
  std::vector<double> bead_height;  ///< of the solid above the plate or part at every section [m]; empty: no powder
};

/// Depth of the vapour depression [m]: that of the effect keyhole where it is on, else how deep the boiling point
/// reached below the surface that the powder was spread on.
double depression_of(MeltStudy const& study);

/// Standard uncertainty of the absorptivity: of the rays, and of the cells where there is a second grid.
double absorptivity_uncertainty(MeltStudy const& study);

/// Cells of the second grid: 1.5 times as large, in a spread layer the nearest to that (1.2 to 2.1) that divide its
/// width and length; nothing: there are none. On a plate that is still to be chosen, its cell_size may be 0.
std::optional<double> second_cell(Case const& checked);

/// Exposes a plate or bed to the scan of the case and writes summary.json, sections.csv, tracks.csv, probe.csv,
/// heat_NNNN.h5, case_resolved.toml, log.jsonl and report.html; with powder also bed_NNNN.h5 and solid_NNNN.stl. \note
/// Collective \throws InputError, FileError, PhysicsError, StoppedBySignal
MeltStudy run_melt(Case const& checked, MeltOptions const& options, Communicator const& comm);

}  // namespace layerloop::coupling
