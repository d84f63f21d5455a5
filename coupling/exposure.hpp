#pragma once
#include <cstdint>

#include "core/absorbed_power.hpp"
#include "core/area_map.hpp"
#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/communicator.hpp"
#include "core/heat_source.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::coupling {

/// One layer's exposure: what the beam brings at every position, and the mean over the exposure for the ledger.
struct Exposure {
  HeatSource source;
  AbsorbedPower mean;  ///< over the time that the beam is on
  double worst_ray_energy_error = 0;
};

/// Traces the beam at positions `optics.position_spacing` apart along every track (each stands for its stretch of the
/// track), shared out over the ranks by position, so that the result does not depend on their number. With
/// laser.absorptivity given, that share of the beam is put on the topmost metal of each column instead. \note
/// Collective
Exposure expose_tracks(Case const& checked, std::int32_t layer, raytrace::BedScene const& scene,
                       CellContent const& cells, Communicator const& comm, bool show_progress);

/// Energy absorbed per area, seen from above [J/m^2].
AreaMap absorbed_energy(HeatSource const& source, VoxelGrid const& grid);

}  // namespace layerloop::coupling
