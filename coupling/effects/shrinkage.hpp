#pragma once
#include <span>

#include "core/case.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// Effect `shrinkage`: volume of the liquid at the liquidus over that of the solid at the solidus, the strength scaling
/// its excess over 1; 1 without the effect. Where material.solid_density is not known the density at room temperature
/// stands in. \throws InputError  the effect is on and material.liquid_density is not known
double liquid_expansion(Case const& checked);

/// A run of melt freezes, from its lowest cell upwards: what filled the run as liquid takes 1/expansion of its volume
/// and sinks on its base, and so its surface by (1 - 1/expansion) of its depth. That the sides hold it, and feed the
/// middle from a rim that freezes first, is left out. \param run  one column, ascending
void shrink(std::span<CellVolume> run, double expansion);

}  // namespace layerloop::coupling
