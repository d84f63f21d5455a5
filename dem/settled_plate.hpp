#pragma once
#include <cstdint>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "core/powder_bed.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem {

/// A level plate at z = 0 that is periodic along x and y with `period` [m].
Rig plate_rig(double period);

/// Grains of the case as a loose cloud over such a plate, falling.
PowderBed cloud_over_plate(Case const& checked, double period, std::int64_t grains);

/// powder.particles grains at rest on a plate of period absorb.plate_length. Collective; every rank gets the same bed.
/// \throws PhysicsError a guard; StoppedBySignal
PowderBed settled_plate(Case const& checked, Communicator const& communicator, bool show_progress);

}  // namespace layerloop::dem
