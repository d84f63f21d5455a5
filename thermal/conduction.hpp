#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "thermal/enthalpy_table.hpp"
#include "thermal/heat_cells.hpp"
#include "thermal/heat_grid.hpp"

namespace layerloop::thermal {

/// A face between two bodies that touch without being one metal: grain on grain, grain on plate.
struct ContactFace {
  std::int64_t cell, neighbour;  ///< local; `cell` is an own cell
  double conductivity;           ///< [W/(m K)], share of the face included; 0 once one of the two has melted
};

/// A face through which heat leaves towards the far field.
struct FarFace {
  std::int64_t cell;    ///< local, own
  double share;         ///< heat flow / (cell size * conductivity integral) [-]
  double per_capacity;  ///< of the cell, as in Conduction: here it comes with the stream of faces
};

/// A stretch of cells along x that holds metal, local indices [begin, end).
struct Row {
  std::int64_t begin, end;
};

/// Full cells along x in which every face is either whole or turned to gas, the faces across x only at the two ends.
/// Melting only joins metal, so it stays so.
struct UniformRow : Row {
  enum Side : std::uint8_t { low_x = 1, high_x = 2, low_y = 4, high_y = 8, low_z = 16, high_z = 32 };
  std::uint8_t gas = 0;  ///< sides without a neighbour
};

/// How much better the melt conducts than its table says, because it flows. \see effect `marangoni`
struct LiquidConductivity {
  double lateral = 1, vertical = 1;  ///< factors along x and y, and along z
  double liquidus = 0;               ///< Theta above which they act [W/m]

  bool acts() const { return lateral != 1 || vertical != 1; }
  /// Theta whose differences are the flows along one direction: that of k times the factor. Exact, as Theta is.
  static double enhanced(double theta, double factor, double liquidus) {
    double const excess = theta - liquidus;
    return theta + (factor - 1) * (excess > 0 ? excess : 0);
  }
};

/// Distances to the places that stay at ambient temperature [m]; infinite: adiabatic.
struct FarField {
  double sides = 0;  ///< beyond the x sides, and the y sides when SideY::far_field
  double bottom = 0;
};

/// Heat conduction between the cells of one rank. Shapes: box.size() unless said otherwise.
///
/// Balance of cell c, in W/m (heat flow / cell size):
///   sum_bulk share (Theta_n - Theta_c) + sum_contact k_contact (T_n - T_c) - sum_far share Theta_c.
/// Bulk faces join cells of one body, and any two of which one has been molten, because melt wets what it touches. The
/// share of the face is the mean of what both sides fill, at most 1: exact inside metal; a thin film on full metal is
/// not cut off from it as the smaller fill would have it. Contact faces join different bodies: a full cell of metal (k
/// at the solidus) in series with one of the contact law. Gas conducts nothing. Far faces: metal over half a
/// cell plus the distance of the far field. Theta is taken from `EnthalpyTable`; every flow is evaluated alike from
/// both sides, so heat is neither made nor lost.
struct Conduction {
  LocalBox box;
  double cell = 0;                               ///< [m]
  std::vector<float> share_x, share_y, share_z;  ///< of the face between a cell and its upper neighbour
  std::vector<double> per_capacity;              ///< 1 / (fill cell^2) [1/m^2]; 0: no unknown
  std::vector<float> fill;                       ///< as in HeatCells, neighbours' layer included
  std::vector<ContactFace> contacts;             ///< ascending by cell, then by direction
  std::vector<FarFace> far;
  std::vector<Row> rows;  ///< own cells
  std::vector<Row> rows_with_neighbours;
  std::vector<std::size_t> first_row, first_row_with_neighbours;  ///< of every plane along z, and the end of the last
  std::vector<UniformRow> uniform;                                ///< the longest within each of `rows`
  std::vector<std::int64_t> neighbours;                           ///< cells with metal in the neighbours' layer
  LiquidConductivity liquid;

  double full_capacity() const { return 1 / (cell * cell); }  ///< per_capacity of a full cell [1/m^2]

  /// Joins a cell that has just melted with its neighbours.
  void melt(std::int64_t cell);
};

/// Conductivity [W/(m K)] of a layer one cell thick that stands for the contact of two bodies (as in HeatCells).
struct ContactLaw {
  using Pair = std::pair<std::int32_t, std::int32_t>;  ///< ascending

  double everywhere = 0;
  std::map<Pair, double> of_pair = {};  ///< where it differs

  ContactLaw(double conductivity) : everywhere(conductivity) {}
  double operator()(std::int32_t a, std::int32_t b) const {
    auto const found = of_pair.find(std::minmax(a, b));
    return found == of_pair.end() ? everywhere : found->second;
  }
};

Conduction make_conduction(HeatCells const& cells, LocalBox const& box, FarField const& far, double bulk_conductivity,
                           ContactLaw const& contact_conductivity);

/// Largest explicit step [s] that keeps every cell between the temperatures of its neighbours, with all faces molten
/// together and the table's largest diffusivity. \note not collective: the minimum over ranks is the caller's
double stable_step(Conduction const& conduction, EnthalpyTable const& table);

/// balance [W/m] of every own cell, from the enthalpy [J/m^3] and the conductivity integral [W/m] of all local cells.
/// Returns the heat flow to the far field [W].
double conduction_balance(Conduction const& conduction, EnthalpyTable const& table, std::span<double const> enthalpy,
                          std::span<double const> integral, std::span<double> balance);

}  // namespace layerloop::thermal
