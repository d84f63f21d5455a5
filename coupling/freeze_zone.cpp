#include "coupling/freeze_zone.hpp"

#include "coupling/consolidation.hpp"

namespace layerloop::coupling {

Consolidation freeze_zone(SolidField& solid, PowderBed& bed, TriangleSurface& substrate, Case const& checked) {
  Consolidation figures;
  auto const [from, to] = *checked.machine.frozen_zone;
  double const mass_before = metal_mass(solid);
  auto const grains = grains_on_lattice(solid, bed, checked, from, to);
  std::vector<char> frozen(bed.size(), 0);
  for (std::size_t g = 0; g < bed.size(); ++g) {
    frozen[g] = bed.x[g] >= from && bed.x[g] <= to && !grains[g].cells.empty();
    if (frozen[g]) add_metal(solid, grains[g].cells, checked.material.density);
  }
  take_from_bed(bed, frozen, Fate::melted, checked, figures);
  embed(solid, bed, substrate, checked, figures);
  check_mass(solid, mass_before, figures);
  return figures;
}

}  // namespace layerloop::coupling
