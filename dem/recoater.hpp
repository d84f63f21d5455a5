#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "dem/energy_ledger.hpp"
#include "dem/moving_walls.hpp"

namespace layerloop::dem {

/// What one stroke of the blade did.
struct SpreadOutcome {
  std::int64_t overflow_grains =
      0;  ///< taken out: over the sink, thrown high, or beside the zones when the blade has passed
  std::int64_t nipped_grains = 0;  ///< of the overflow: crushed between blade and platform, see Simulation
  double overflow_volume = 0;      ///< [m^3]
  double overflow_mass = 0;        ///< [kg]
  std::string blade_note;          ///< empty, or where and how far raised solid stands in the blade's way
  std::string stiffness_note;      ///< empty, or what softened contacts do to cohesion; see softening_note()
  std::int64_t steps = 0;
  double time_step = 0;                    ///< [s]
  double largest_overlap = 0;              ///< over the grain's diameter
  std::vector<ForceSample> force_history;  ///< of the recoater: z upwards, x along the stroke (against it: negative)
  double blade_force = 0;       ///< largest force of the grains against the stroke [N], a mean over every few steps
  double mean_blade_force = 0;  ///< the same, mean over the stroke [N]
  double bond_number = 0;  ///< of the median grain by number, of the main material: SJKR2 pull-off force over weight
  double steps_per_contact = 0;  ///< of the smallest grain at the recoating speed
  EnergyLedger energy;           ///< of stroke and rest, where a ledger is kept
};

/// Sees the bed during the stroke, on every rank. \param blade_front  x of the recoater's foremost line [m]
using StrokeWatch = std::function<void(PowderBed const& bed, double blade_front)>;

/// Moves the blade over accumulation zone, gap and deposition zone, clears the end platform and lets the layer settle.
/// The blade is rigid: before it moves, the substrate is searched for solid above its lower edge.
/// Collective; every rank gets the same bed.
/// \throws PhysicsError raised solid and BladeCollision::stop; a guard of Simulation
/// \throws StoppedBySignal
/// \param watch  called every 50 um of travel; see StrokeWatch
SpreadOutcome spread(PowderBed& bed, Case const& checked, TriangleSurface const& substrate,
                     Communicator const& communicator, bool show_progress, StrokeWatch const& watch = {});

/// Lowers the grains of the deposition zone with the plate, by one layer thickness (the caller lowers plate and part).
/// A grain that would be pushed into a wall, or onto a grain that stays, stays too and falls in later: no overlap is
/// made. Springs between what moved and what did not, and all springs to the substrate (which may be a new mesh), are
/// dropped.
void lower_plate(PowderBed& bed, Case const& checked);

/// Lifts the grains of the accumulation zone with its piston, by one dose, as one body: friction at the walls of the
/// zone is left out. Grains beside the zone that lie in the way are lifted too. \pre the case's floor is where it comes
/// to (case_of_layer)
void raise_feed(PowderBed& bed, Case const& checked);

}  // namespace layerloop::dem
