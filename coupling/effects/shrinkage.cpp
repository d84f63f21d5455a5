#include "coupling/effects/shrinkage.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace layerloop::coupling {

double liquid_expansion(Case const& checked) {
  double const strength = checked.effect_strength("shrinkage");
  if (strength == 0) return 1;
  Material const& metal = checked.material;
  if (metal.liquid_density.value.empty())
    throw InputError("effects.shrinkage.enabled = true (how dense the liquid is is not known) give material." +
                     metal.name + ".liquid_density");
  double const solid = metal.solid_density.value.empty() ? metal.density : metal.solid_density(metal.solidus);
  return 1 + strength * (solid / metal.liquid_density(metal.liquidus) - 1);
}

void shrink(std::span<CellVolume> run, double expansion) {
  if (expansion == 1) return;
  double left = 0;
  for (CellVolume const& piece : run) left += piece.volume / expansion;
  for (CellVolume& piece : run) {
    piece.volume = std::min(piece.volume, left);
    left -= piece.volume;
  }
}

}  // namespace layerloop::coupling
