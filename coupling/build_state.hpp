#pragma once
#include <cstdint>

#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/run_record.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// Everything that one layer hands to the next; what a checkpoint holds. The same on every rank.
struct BuildState {
  std::int32_t layers_done = 0;
  std::int64_t next_id = 0;  ///< of the next grain that is fed
  PowderBed bed;
  SolidField solid;           ///< what solidified on the plate, and where the plate is
  TriangleSurface substrate;  ///< outer surface of plate and part
  RunRecord record;
};

}  // namespace layerloop::coupling
