#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/material.hpp"
#include "core/vec3.hpp"
#include "thermal/enthalpy_table.hpp"
#include "thermal/heat_cells.hpp"

namespace layerloop::thermal {

/// Where a beam stands, and out to where it may hold a keyhole open.
struct BeamReach {
  Vec3 centre;
  double radius;  ///< [m]
};

/// Effect `keyhole`: where the vapour pushes harder than surface tension holds, the melt's surface goes down.
///
/// Nothing is fitted. p(T) is the saturation pressure (Clausius-Clapeyron through the boiling point at 1 atm), sigma
/// the surface tension at the boiling point, p0 = 1 atm:
///   opening: vapour streams freely off a flat surface and pushes with 0.54 p(T) - p0 (Anisimov; Semak & Matsunawa, J.
///            Phys. D 30 (1997) 2541). The surface gives way once the mean of this over the part of it that is hotter
///            than T_w(R), R being that part's radius, exceeds 2 sigma / R, the most that a rim can hold.
///   wall:    a cavity with a mouth of radius R is full of vapour that holds it open at p(T_w) = p0 + sigma / R
///   (Kaplan,
///            J. Phys. D 27 (1994) 1805). Metal that reaches T_w gives way, from the top of its column down; what light
///            heats beyond T_w boils, and its vapour condenses where the cavity's wall is colder.
///   closing: where the light no longer reaches, surface tension closes the cavity within sqrt(density R^3 / sigma),
///            some 10 us: here, at once.
/// The metal in the way is pushed aside. It stays in its cells with its heat, hidden from the light, as if it flowed
/// round the cavity and back behind it at the temperature of the wall: mass and heat close exactly; the swelling of the
/// pool's rim, the flow in the pool and cavities that hang over are left out. What is lost through the mouth is the
/// effect `evaporation` of the cells at the top. Light is to be traced on the depressed surface: that is what raises
/// the absorptivity and brings the heat down.
class Keyhole {
 public:
  /// \param strength  scales the depth that light sees; 0: no depression
  Keyhole(Material const& material, HeatCells const& cells, double strength);
  bool acts() const { return strength_ != 0; }

  /// Opens, deepens or closes, and moves heat between the cells of `changed`, whose sum stays.
  /// \param enthalpy  of all cells [J/m^3], shape grid.size(), the same on every rank
  void update(std::span<double> enthalpy, EnthalpyTable const& table, BeamReach const& beam);

  /// Height of the surface over every column of the grid [m], x fastest; infinite beside the keyhole. Empty: no
  /// keyhole.
  std::vector<double> const& wall() const { return wall_; }
  std::vector<std::int64_t> const& changed() const { return changed_; }  ///< cells, some named twice
  double wall_temperature() const { return wall_temperature_; }          ///< of the open keyhole [K]
  double radius() const { return radius_; }                              ///< of the mouth [m]
  double depth() const { return depth_; }                                ///< of the deepest column [m]
  double deepest() const { return deepest_; }                            ///< of all depths so far [m]

  double saturation_pressure(double T) const;            ///< [Pa]
  double saturation_temperature(double pressure) const;  ///< its inverse [K]

 private:
  struct Column {
    std::int64_t top;    ///< highest cell with metal; -1: none
    std::int64_t floor;  ///< highest that is not hollow; -1: none
    bool is_open() const { return floor != top; }
  };
  bool reached(std::size_t column, BeamReach const& beam) const;
  std::int64_t next_below(std::int64_t cell) const;
  double height_of(std::int64_t cell, double share) const;
  double radius_of(std::size_t columns) const;
  double wall_temperature(std::size_t columns) const;
  std::size_t gives_way(std::span<double const> enthalpy, EnthalpyTable const& table) const;
  void sink(Column& column, std::span<double> enthalpy, double wall);
  std::vector<std::int64_t> cells_of_wall() const;
  void condense(std::span<double> enthalpy, double wall);
  void follow_wall(std::span<double const> enthalpy, EnthalpyTable const& table);

  HeatCells const& cells_;
  double strength_, surface_tension_;
  double boiling_, onset_;  ///< [K]
  std::vector<Column> columns_;
  std::vector<double> wall_;
  std::vector<std::int64_t> changed_;
  double wall_temperature_ = 0, radius_ = 0, depth_ = 0, deepest_ = 0;
};

}  // namespace layerloop::thermal
