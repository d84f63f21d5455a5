#pragma once
#include "core/case.hpp"
#include "coupling/build_state.hpp"
#include "coupling/effects/denudation.hpp"
#include "coupling/exposure.hpp"
#include "dem/energy_ledger.hpp"
#include "thermal/expose.hpp"

namespace layerloop::coupling {

/// Enters the light of one layer: powers are means over the exposures so far, the energy error is the worst position's.
void book_light(Ledger& ledger, Exposure const& exposure, std::int32_t layer);

/// Enters grains that were drawn away.
void book_lost(Ledger& ledger, Denuded const& lost);

/// Enters the heat of one layer: energies add, the relative error is the worst layer's.
void book_heat(Ledger& ledger, thermal::HeatOutcome const& heat);

/// Enters what became of the energy of the grains in one dosing or stroke: energies add, and the relative error is that
/// of the sums.
void book_motion(Ledger& ledger, dem::EnergyLedger const& energy);

/// Counts and weighs what is in the bed, closes the ledger of mass and particles, and checks it and the ledgers of
/// light and heat: particles exactly, mass to 1e-12, rays to 1e-12 with a residual below 1e-6, heat to 1e-6 (the
/// implicit solver's tolerance), energy of the grains, where it is booked, to 1e-3 of the work done. \throws
/// PhysicsError a ledger does not close: names it and by how much
void audit(BuildState& build, Case const& checked);

}  // namespace layerloop::coupling
