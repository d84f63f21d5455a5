#pragma once
#include <span>
#include <vector>

#include "core/cell_content.hpp"
#include "core/communicator.hpp"
#include "core/heat_source.hpp"
#include "core/melt_record.hpp"
#include "thermal/heat_system.hpp"
#include "thermal/melt_pool.hpp"

namespace layerloop::thermal {

/// Largest values over the ranks of what each knows of its own cells, as a field over the whole grid (shape
/// grid.size()). \note Collective
template <class Real>
std::vector<Real> gather(HeatCells const& cells, LocalBox const& box, std::span<Real const> own,
                         Communicator const& comm);

/// Temperature of every cell [K] from such a field of enthalpies; a cell without an unknown shows its host's.
std::vector<float> to_temperature(HeatCells const& cells, EnthalpyTable const& table,
                                  std::vector<float> const& enthalpy);

/// Isotherms [K] that pools are measured on.
struct PoolIsotherms {
  double pool, boiling;
};

/// Follows the tracks, in whatever direction they run, one after another: peak enthalpies of the track that is being
/// scanned, for its sections; the length of the pool at instants two cells of travel apart while the beam passes the
/// middle tenth of the track; and from the middle track on the temperature of the surface in the middle of it.
class PoolObserver {
 public:
  /// Where on the track the sections lie.
  static constexpr double section_places[] = {0.25, 0.375, 0.5, 0.625, 0.75};

  PoolObserver(HeatCells const& cells, CellContent const& content, std::vector<Track> const& tracks,
               PoolIsotherms isotherms, Communicator const& comm);

  /// To be called after every step. \note Collective
  void observe(HeatSystem& system, double time);
  /// Ends the last track; `system.peak` then holds the peaks of the whole exposure. \note Collective
  void finish(HeatSystem& system);

  void write(MeltRecord& record) const;

 private:
  void begin_track(HeatSystem& system, std::size_t track);
  void end_track(HeatSystem& system);
  void probe(HeatSystem const& system, double time);
  double length_now(HeatSystem const& system, Track const& track) const;

  HeatCells const& cells_;
  CellContent const& content_;
  std::vector<Track> const& tracks_;
  PoolIsotherms isotherms_;
  Communicator const& comm_;
  std::int64_t probed_ = -1;         ///< cell of the grid
  std::size_t next_ = 0;             ///< tracks that have begun
  double last_sample_ = 0;           ///< beam travel at the last length [m]
  std::vector<double> lengths_;      ///< of the present track
  std::vector<float> earlier_peak_;  ///< of the tracks before, and of the time before the first
  std::vector<TrackPool> pools_;
  std::vector<TrackSection> sections_;
  ProbeHistory probe_;  ///< of the rank that owns the cell
};

}  // namespace layerloop::thermal
