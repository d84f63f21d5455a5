#pragma once
#include <string>
#include <string_view>

namespace layerloop {

/// What a quantity measures; the SI unit is what a bare number means.
enum class Dimension {
  none,
  length,
  speed,
  time,
  mass,
  density,
  pressure,
  energy_density,
  surface_energy,
  power,
  temperature,
  angle,
  angular_speed,
  conductivity,
  specific_heat,
  specific_energy,
  molar_mass,
  frequency,
  linear_density,
  viscosity,
  charge_density,
  surface_tension_slope,
  heat_transfer,
  mass_rate
};

std::string_view si_unit(Dimension dimension);  ///< for example "m/s"; empty for none

/// "30 um" -> 3.0e-5 for Dimension::length.
/// \throws InputError when the text is not a number and a unit, or the unit measures something else; names units that
/// fit
double parse_quantity(std::string_view text, Dimension dimension);

/// An SI value for people, in the unit they would use: 3.0e-5 m -> "30 um".
std::string format_quantity(double value, Dimension dimension);

}  // namespace layerloop
