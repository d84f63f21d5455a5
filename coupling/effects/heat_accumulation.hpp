#pragma once
#include <span>

#include "core/case.hpp"

namespace layerloop::coupling {

/// What a slab of metal is to heat that comes in layer by layer.
struct Slab {
  double thickness;     ///< from the heated top to the bottom that stays at its temperature [m]
  double conductivity;  ///< [W/(m K)]
  double capacity;      ///< density times specific heat [J/(m^3 K)]
};

/// Rise of the slab's top, `time` after a heat per area came in there at once, with no heat lost upwards:
///   2 E / (capacity d) sum_n exp(-((n + 1/2) pi / d)^2 a t)
/// (Carslaw & Jaeger, Conduction of Heat in Solids (1959), 14.3), a the diffusivity. [K]
double pulse_rise(Slab const& slab, double energy_per_area, double time);

/// Effect `heat_accumulation`: plate and part do not cool down to heat.ambient_temperature between two layers.
///
/// The plate and the part on it are one slab, heated evenly over the part's cross-section, whose bottom is held at
/// heat.ambient_temperature; the pulses of all earlier layers, one every `layer_time`, are superposed. The sum is the
/// temperature of metal, powder and far field from which the next layer's exposure starts. Only what lies between
/// layers is modelled thus: between the tracks of a layer the heat grid itself keeps the heat. Metal values are those
/// at heat.ambient_temperature. \param layer_energy  absorbed in each of the layers that were computed, per area of the
/// part [J/m^2], the oldest first; the case may name earlier ones \return heat.ambient_temperature where the effect is
/// off \throws PhysicsError  the layer would start above the solidus
double start_temperature(Case const& checked, std::span<double const> layer_energy);

/// Area of the part that a layer's tracks stand for: their length times tracks times scan.hatch_spacing [m^2].
double part_area(Case const& checked);

}  // namespace layerloop::coupling
