#pragma once
#include "core/case.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// What stands on the plate before layer 1: nothing, a rough top, or the metal that machine.substrate encloses, filled
/// into the cells of the solid's lattice by 3 x 3 x 3 points a cell. It is there from the start: no ledger of the run
/// counts its mass. \throws InputError the mesh has a hole, is inside-out, intersects itself, or lies outside the
/// deposition zone \throws FileError  it cannot be read
SolidField solid_on_plate(Case const& checked);

}  // namespace layerloop::coupling
