#pragma once
#include "core/case.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem {

/// What stands on the machine besides its platforms, and moves.
enum class Tools {
  parked_and_gate,  ///< the recoater waits and a gate closes the accumulation zone
  parked,           ///< without the gate: the piston's powder stands free
  moving_recoater,
  none
};

/// From the recoater's last position to where the end platform ends [m].
inline constexpr double sink_distance = 100e-6;

/// Adds the recoater where it waits: its front at x = 0.
void add_parked_recoater(Walls& walls, MachineSettings const& machine);

/// Distance that the recoater travels [m]. A blade's rear edge ends at the end of the deposition zone, and a roller
/// where it has left the layer; before a high end wall either stops short by two layers.
double blade_stroke(MachineSettings const& machine);

/// The case as it stands when this layer is made: the piston has lifted the accumulation zone's floor.
Case case_of_layer(Case const& checked, std::int64_t layer);

/// The machine: rear wall, left platform (its edge is sharp: nothing may lodge under the parked blade), accumulation
/// pit, gap platform, deposition pit over the substrate, end platform with the sink behind it. The recoater is parked
/// with its front at x = 0. The gate closes the accumulation zone at its far end while the feed is dosed; it stands on
/// the gap platform, or on grains that lie there. A roller, under which grains could roll, is replaced by a gate then.
Rig machine_rig(Case const& checked, TriangleSurface const& substrate, PowderBed const& bed, Tools tools);

}  // namespace layerloop::dem
