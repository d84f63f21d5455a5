#pragma once
#include <complex>
#include <map>
#include <string>
#include <vector>

namespace layerloop {

/// A property over temperature: linear between points, constant beyond the ends. Two or more points say what is known:
/// from the first to the last; a single one is a constant for any temperature.
struct PropertyTable {
  std::vector<double> temperature;  ///< [K], ascending
  std::vector<double> value;

  double operator()(double T) const;
};

/// One metal. SI units. Heat grid and grains take `density` alone: the grid does not move, so mass and volume change
/// together. What a metal has not got is 0 or empty.
struct Material {
  std::string name;
  double density = 0;                     ///< at room temperature [kg/m^3]
  PropertyTable solid_density;            ///< [kg/m^3]
  PropertyTable liquid_density;           ///< [kg/m^3]
  PropertyTable conductivity;             ///< [W/(m K)], solid and liquid in one table
  PropertyTable specific_heat;            ///< [J/(kg K)], without latent heat
  double latent_heat = 0;                 ///< beside the specific heat between solidus and liquidus [J/kg]
  double solidus = 0, liquidus = 0;       ///< [K]
  double boiling_point = 0;               ///< [K]
  double heat_of_vaporisation = 0;        ///< [J/kg]
  double molar_mass = 0;                  ///< [kg/mol]
  double emissivity = 0;                  ///< [-]
  PropertyTable viscosity;                ///< of the liquid [Pa s]
  double surface_tension = 0;             ///< at the liquidus [N/m]
  double surface_tension_slope = 0;       ///< over temperature [N/(m K)]; negative: the melt flows away from the beam
  std::complex<double> refractive_index;  ///< n + ik at the laser's wavelength, at room temperature
  std::string optical_data;  ///< the set that it comes from (core/optical_constants.hpp); empty: given by hand
  std::string source;        ///< where the values come from
};

/// The built-in metals by name, from core/material_table.cpp.
std::map<std::string, Material> const& built_in_materials();

/// One sentence for each property of heat conduction that is used where its table says nothing, between these
/// temperatures [K]. A table that begins at room temperature counts down to 10 K below its first point.
std::vector<std::string> uses_beyond_range(Material const& material, double coldest, double hottest);

}  // namespace layerloop
