#pragma once
#include <complex>
#include <map>
#include <string>
#include <vector>

namespace layerloop {

/// A property over temperature: linear between points, constant beyond the ends.
struct PropertyTable {
  std::vector<double> temperature;  ///< [K], ascending
  std::vector<double> value;

  double operator()(double T) const;
};

/// One metal. SI units. Density is one number: the heat grid does not move, so mass and volume change together.
struct Material {
  std::string name;
  double density = 0;                     ///< [kg/m^3]
  PropertyTable conductivity;             ///< [W/(m K)], solid and liquid in one table
  PropertyTable specific_heat;            ///< [J/(kg K)], without latent heat
  double latent_heat = 0;                 ///< [J/kg]
  double solidus = 0, liquidus = 0;       ///< [K]
  double boiling_point = 0;               ///< [K]
  double heat_of_vaporisation = 0;        ///< [J/kg]
  double molar_mass = 0;                  ///< [kg/mol]
  double emissivity = 0;                  ///< [-]
  std::complex<double> refractive_index;  ///< n + ik at the laser's wavelength, at room temperature
  std::string optical_data;  ///< the set that it comes from (core/optical_constants.hpp); empty: given by hand
  std::string source;        ///< where the values come from
};

/// The built-in metals by name, each value with its source in material.cpp.
std::map<std::string, Material> const& built_in_materials();

}  // namespace layerloop
