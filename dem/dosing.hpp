#pragma once
#include <cstdint>
#include <vector>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "dem/energy_ledger.hpp"

namespace layerloop::dem {

/// Radius of the grain with this id [m]: a pure function of seed and id, distributed as fed_powder() says. Fractions by
/// volume are turned into fractions by number first.
double draw_radius(Case const& checked, std::int64_t id);

/// Adds grains with ids next_id ... next_id + count - 1 as a loose cloud in the accumulation zone, between the bed that
/// is there and as high as it takes, falling slowly. Random sequential addition: no two grains overlap, and the result
/// depends on seed, ids and bed only.
void add_cloud(PowderBed& bed, Case const& checked, std::int64_t count, std::int64_t next_id);

/// Feeds the accumulation zone between the parked recoater and a gate, and lets everything come to rest: `count` new
/// grains rain into it; with count = 0 and Dosing::feed the piston rises by one dose first (see case_of_layer).
/// \param energy  where a ledger is kept and this is given: the energy of it is added here
/// Collective; every rank gets the same bed. \return the next free id \throws PhysicsError a guard of Simulation;
/// StoppedBySignal
std::int64_t dose(PowderBed& bed, Case const& checked, TriangleSurface const& substrate, std::int64_t count,
                  std::int64_t next_id, Communicator const& communicator, bool show_progress,
                  EnergyLedger* energy = nullptr);

class Simulation;

/// At rest: at most one grain in twenty is faster than this [m/s] (those roll on slowly for milliseconds: CDT stops a
/// rolling grain after some 15 radii).
inline constexpr double rest_speed = 1e-3;

/// Advances until the grains are at rest or `longest` [s] have passed.
void settle(Simulation& simulation, double longest, char const* stage, bool show_progress);

}  // namespace layerloop::dem
