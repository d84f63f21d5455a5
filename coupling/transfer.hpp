#pragma once
#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/powder_bed.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// What the heat solver finds in its cells: plate (solid 1), consolidated metal and powder. The grid lies on the
/// solid's lattice: x from x_from to x_to, clipped to the deposition zone and widened to whole cells; the full width in
/// y; z from heat.substrate_depth (rounded up to cells) below the plate's top to two cells above the highest grain or
/// metal. Transfer is conservative but for overlap: where a cell's metal and grains (DEM overlaps) sum to more than the
/// cell, its powder is cut to the room that the metal leaves. \throws InputError the range does not touch the
/// deposition zone
CellContent cell_content(SolidField const& solid, PowderBed const& bed, Case const& checked, double x_from,
                         double x_to);

}  // namespace layerloop::coupling
