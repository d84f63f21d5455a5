#pragma once
#include "core/case.hpp"
#include "core/material.hpp"
#include "thermal/conduction.hpp"
#include "thermal/effects/effect_strength.hpp"
#include "thermal/heat_cells.hpp"

namespace layerloop::thermal {

/// Gas between two surfaces, as heat sees it.
struct GapGas {
  double conductivity = 0;  ///< far from walls [W/(m K)]
  /// Distance behind each wall at which the gas seems to take on its temperature, for want of collisions [m]: a gap g
  /// conducts as one of g + 2 jump.
  double jump = 0;
  double radiation = 0;  ///< heat transfer coefficient between the surfaces [W/(m^2 K)]
};

/// Conductivity: (T / 300 K)^n through values of Lemmon & Jacobsen, Int. J. Thermophys. 25 (2004) 21 (argon, nitrogen)
/// and Kestin et al., J. Phys. Chem. Ref. Data 13 (1984) 229 (helium), within 3 % from 250 to 1500 K.
/// Jump: Kennard, Kinetic Theory of Gases (1938), sect. 184, (2 - A) / A sqrt(2 pi R T) k / (p (2 cp - R)), A the
/// `accommodation`. Radiation between grey walls: 4 sigma T^3 / (2 / emissivity - 1).
GapGas gap_gas(HeatSettings const& settings, double accommodation, double emissivity, double temperature);

/// Conductivity of the unit cell of two grains that touch, in parallel lines of flow through solid and gas, over that
/// of the gas (Zehner & Schluender, Chem. Ing. Tech. 42 (1970) 933, with the jump added to the gap):
///   int_0^1 2 u du / (1 + 2 jump / D - (1 - k_gas / k_solid) z),  z = B u / (1 + (B - 1) u),
/// z the height of solid over half the cell's, where sqrt(1 - u^2) is the distance from the axis over the cell's
/// radius. \param shape  B; 1: spheres
double touching_grains(double solid, GapGas const& gas, double diameter, double shape = 1);

/// Shape B of that unit cell for a random bed of spheres: 1.25 ((1 - porosity) / porosity)^(10/9) (ibid.).
double shape_in_bed(double porosity);

/// Effective conductivity of a bed [W/(m K)], k / k_gas = (1 - s)(1 + porosity r) + s (touching_grains + r) with
/// s = sqrt(1 - porosity) and r = radiation D / k_gas (Sih & Barlow, Part. Sci. Technol. 22 (2004) 427; measured
/// powders lie within 30 %).
double bed_conductivity(double porosity, double diameter, double solid, GapGas const& gas, double shape);

/// Effect `powder_conductivity`: what joins two grains, or a grain and the plate, conducts like two touching spheres
/// with gas around the contact, instead of heat.powder_contact_conductivity.
///
/// In a resolved bed the law above needs no porosity: two grains conduct pi R / 2 (touching_grains k_gas + radiation
/// 2R) from middle to middle, R the harmonic mean of their radii (Derjaguin), and the faces of cells at which they meet
/// share this among them, so that the cell size does not matter. Gas, jump and metal are taken half way between
/// ambient and solidus. A grain's radius follows from its metal on the grid; grains that the grid cuts count as
/// smaller. \param strength  share of the departure from the constant; 0: that constant
ContactLaw contact_law(HeatCells const& cells, HeatSettings const& settings, Material const& metal,
                       Effects const& effects);

}  // namespace layerloop::thermal
