#pragma once
#include <span>
#include <vector>

#include "core/huge_pages.hpp"
#include "thermal/awake_rows.hpp"
#include "thermal/conduction.hpp"
#include "thermal/enthalpy_table.hpp"
#include "thermal/heat_grid.hpp"
#include "thermal/surface_sink.hpp"

namespace layerloop::thermal {

/// What an explicit step keeps from one call to the next, so that it need not allocate.
struct StepScratch {
  std::vector<double> contact_flow;                                 ///< as conduction.contacts [W/m]
  std::vector<double> far_flow;                                     ///< as conduction.far [W/m]
  std::vector<double> surface_flow;                                 ///< as sink.cells, in super steps [W]
  std::vector<std::vector<double>> theta;                           ///< of each thread: planes of cells [W/m]
  std::vector<double, HugePages<double>> start, older, start_rate;  ///< of a super step: two stages, dh/dt at its start
};

/// Everything that one rank steps through time. Shapes of the fields: grid.box().size(), x fastest.
struct HeatSystem {
  EnthalpyTable const& table;
  HeatGrid const& grid;
  Conduction conduction;
  SurfaceSink sink;

  std::vector<double, HugePages<double>> enthalpy;  ///< per volume of metal, zero at ambient [J/m^3]
  std::vector<double> integral;                     ///< Theta(enthalpy) at the last `finish_step` [W/m]
  std::vector<double> balance;                      ///< scratch [W/m]
  std::vector<float, HugePages<float>> peak;        ///< largest enthalpy since the last reset [J/m^3]
  std::vector<float> time_above_liquidus;           ///< [s]
  std::vector<char> melted;                         ///< 1: has been at the liquidus
  double heat_to_far_field = 0;                     ///< [J] so far, this rank
  double floor = 0;  ///< enthalpy up to which explicit steps let metal keep its heat [J/m^3]
  AwakeRows awake;
  StepScratch scratch;

  double metal_volume(std::int64_t cell) const { return conduction.cell / conduction.per_capacity[cell]; }
};

HeatSystem make_heat_system(EnthalpyTable const& table, HeatGrid const& grid, Conduction conduction, SurfaceSink sink);

/// Row: keeps peaks; returns the row's largest enthalpy [J/m^3].
double record_peak(HeatSystem& system, Row const& row);

/// Cells of a row with liquid in it: their time above the liquidus; appends those that have just melted.
void record_liquid(HeatSystem& system, Row const& row, double dt, std::vector<std::int64_t>& newly_melted);

/// Cells of the neighbours' layer that have melted since this was last asked.
std::vector<std::int64_t> neighbours_that_melted(HeatSystem const& system);

/// Joins cells that have just melted with what they touch.
void join_melted(HeatSystem& system, std::vector<std::int64_t> const& cells);

/// After an implicit step: fetches the neighbours' layer, looks Theta up, keeps peaks and times, joins what has melted.
/// \note Collective
void finish_step(HeatSystem& system, double dt);

/// One forward Euler step: source and conduction, then the sinks; then fetches the neighbours' layer and joins what has
/// melted. The same bits for any number of ranks and threads. Cold metal is left out (AwakeRows): call `finish_step`
/// after the enthalpy was changed by other means. \pre dt <= stable_step \note Collective
void explicit_step(HeatSystem& system, std::span<CellPower const> source, double dt);

/// Stages that a super step needs to be stable. \param stable  the longest explicit step [s]
int super_step_stages(double dt, double stable);

/// About stages^2 / 4 explicit steps at once, at second order in time: the Runge-Kutta-Legendre scheme RKL2 of Meyer,
/// Balsara & Aslam, J. Comput. Phys. 257 (2014) 594, for conduction, source and surface losses. Every stage is made of
/// flows, so heat balances to round-off. Peaks and melting are seen at the end of the step only; evaporation is left
/// out. The same bits for any number of ranks and threads. \pre stages >= super_step_stages(dt, stable_step), no metal
/// that evaporates \note Collective
void super_step(HeatSystem& system, std::span<CellPower const> source, double dt, int stages);

/// The same powers, ascending by cell, as sweeps want them.
std::vector<CellPower> ascending(std::span<CellPower const> source);

/// Heat above ambient in this rank's cells [J].
double stored_heat(HeatSystem const& system);

/// Largest |balance| of this rank's cells now, without source and sinks [W/m].
double largest_imbalance(HeatSystem& system);

/// Largest enthalpy of this rank's cells now [J/m^3]; NaN when any cell is.
double hottest(HeatSystem const& system);

}  // namespace layerloop::thermal
