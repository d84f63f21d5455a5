#pragma once
#include "core/case.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/run_record.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// The thesis' own substrate (sect. 3.5), without a laser: the grains with their centre in machine.frozen_zone freeze
/// where they are. Their mass joins the solid in the cells that they fill, not shrunk; the pores between them stay in
/// the field. The surface is the highest metal of each column of cells (the thesis' bins), meshed like any part. Grains
/// beside the zone are trapped or moved clear as in consolidate(). \pre machine.frozen_zone is set
Consolidation freeze_zone(SolidField& solid, PowderBed& bed, TriangleSurface& substrate, Case const& checked);

}  // namespace layerloop::coupling
