#pragma once
#include <cstdint>
#include <memory>

#include "core/absorbed_power.hpp"
#include "core/area_map.hpp"
#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/communicator.hpp"
#include "core/heat_source.hpp"
#include "core/melt_state.hpp"
#include "core/modifier.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/effects/plume_attenuation.hpp"
#include "raytrace/beam.hpp"
#include "raytrace/bed_scene.hpp"
#include "raytrace/surface.hpp"

namespace layerloop::coupling {

/// A stretch of track, lit as from its middle.
struct BeamStop {
  Vec3 centre;
  Vec3 along;  ///< direction of the scan, of length 1
  double begin_time, end_time;
  double power;
  double on_time = 0;  ///< for which the beam has been on before [s]
};

/// One layer's exposure: positions `optics.position_spacing` apart along every track, and what was absorbed there.
struct Exposure {
  raytrace::Beam beam;          ///< but for place and power
  raytrace::OpticalSet optics;  ///< of bed and part; none with laser.absorptivity given
  std::vector<BeamStop> stops;
  double on_time = 0;                         ///< of all stops [s]
  std::size_t stops_per_levelling = 1;        ///< a keyhole moves at every stop, the melt levels after some travel
  std::vector<std::int64_t> stop_of_stretch;  ///< of the source; -1: the beam is off
  HeatSource source;                          ///< powers empty until their stretch has been exposed
  AbsorbedPower mean;                         ///< over the time that the beam is on
  Plume plume;
  std::shared_ptr<ModifiedAbsorption const> modified;  ///< by effects of the user's
  double worst_ray_energy_error = 0;
};

/// Where and when the beam stands; nothing is absorbed yet.
Exposure plan_exposure(Case const& checked, std::int32_t layer);

/// Traces the beam at the position of a stretch, on what is left of it by the plume of `now`, and books it. With
/// laser.absorptivity given, that share of the beam is put on the topmost metal of each column instead or, in a
/// keyhole, the share that a cone of its size absorbs (Gouffe, Rev. Opt. 24 (1945) 1) on its wall. Ranks share the
/// rays. \note Collective
void expose_stretch(Exposure& exposure, std::size_t stretch, MeltState const& now, raytrace::BedScene const& scene,
                    CellContent const& cells, Case const& checked, std::int32_t layer, Communicator const& comm);

/// Energy absorbed per area, seen from above [J/m^2].
AreaMap absorbed_energy(HeatSource const& source, VoxelGrid const& grid);

}  // namespace layerloop::coupling
