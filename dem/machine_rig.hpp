#pragma once
#include "core/case.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem {

/// What stands on the machine besides its platforms.
enum class Tools { blade_and_gate, moving_blade, none };

/// Edges of the platforms, wider than the blade's [m]: a sharp edge would cut into grains that the blade drags over it.
inline constexpr double platform_edge_radius = 20e-6;
/// From the blade's last position to where the end platform ends [m].
inline constexpr double sink_distance = 100e-6;

/// The blade where it waits, its front at x = 0.
RoundedBlock parked_blade(MachineSettings const& machine);

/// Distance that the blade travels: its front starts at x = 0, its rear edge ends at the end of the deposition zone
/// [m].
double blade_stroke(MachineSettings const& machine);

/// The machine: rear wall, left platform (its edge is sharp: nothing may lodge under the parked blade), accumulation
/// pit, gap platform, deposition pit over the substrate, end platform with the sink behind it. The blade is parked with
/// its front at x = 0 (it moves with Tools::moving_blade). The gate closes the accumulation zone at its far end while
/// the feed is dosed; it stands on the gap platform, or on grains that lie there.
Rig machine_rig(Case const& checked, TriangleSurface const& substrate, PowderBed const& bed, Tools tools);

}  // namespace layerloop::dem
