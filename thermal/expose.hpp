#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/communicator.hpp"
#include "core/heat_source.hpp"
#include "core/melt_record.hpp"
#include "core/melt_state.hpp"
#include "thermal/effects/effect_strength.hpp"
#include "thermal/heat_cells.hpp"

namespace layerloop::thermal {

/// What one exposure did, the same on every rank. SI.
struct HeatOutcome {
  MeltRecord melt;
  double heat_in = 0;                     ///< absorbed by metal [J]
  double heat_stored = 0;                 ///< above ambient at the end [J]
  double heat_out = 0;                    ///< far field, vapour, radiation and convection [J]
  double heat_evaporated = 0;             ///< the vapour's part of `heat_out` [J]
  double heat_energy_relative_error = 0;  ///< largest |stored - in + out| / in seen at any check
  double moved_power_share = 0;  ///< of `heat_in` that landed in cells without an unknown and went to their host
  double mass_evaporated = 0;    ///< [kg]
  double peak_temperature = 0;   ///< [K]
  double keyhole_depth = 0;      ///< deepest that the surface was depressed to [m]; 0 without the effect `keyhole`
  double end_time = 0;           ///< when the last cell froze, or the source ended if that is later [s]
  std::int64_t explicit_steps = 0, implicit_steps = 0;
  std::int64_t cells = 0;  ///< with an unknown
};

enum class Report { progress, silent };

/// Called when a stretch of the source begins: sets what the cells absorb in it, power[stretch] of the source, from
/// what has become of the metal by then. \note Collective
using AbsorbedNow = std::function<void(std::size_t stretch, MeltState const& now)>;

/// Heats the cells with the source, starting from ambient, until the source has ended and nothing is above the solidus.
///
/// Enthalpy finite volumes (thermal/conduction.hpp) with the effects `evaporation`, `surface_losses`, `marangoni` and
/// `keyhole` as switched on. Far field: at ambient, heat.substrate_depth below the
/// bottom and heat.margin beyond the sides (the distance of the heated patch, which is exact for a steady point source
/// on a half space). HeatSolver::automatic steps explicitly; where the beam moves by less than a cell in many steps,
/// and with growing steps while it is off, it takes super steps. Metal that is still cold is left out.
///
/// \throws InputError    arrays and times that do not fit (before any computing)
/// \throws PhysicsError  NaN; metal above 1.5 boiling points, or with evaporation 2000 K above it; heat that does not
/// balance to 1e-9 \throws StoppedBySignal \note Collective. Explicit steps give the same bits for any number of ranks;
/// implicit ones agree to the solver's tolerance, 1e-12.
HeatOutcome expose(CellContent const& content, HeatSource const& source, Material const& metal,
                   HeatSettings const& settings, Effects const& effects, SideY side_y, Communicator const& comm,
                   Report report, AbsorbedNow const& absorbed_now = {});

/// A metal with the effects `latent_heat` and `variable_conductivity` as switched on.
Material with_effects(Material metal, Effects const& effects);

/// The same from a case, its metal with_effects() and then with its modifiers: y periodic when the grid spans the
/// machine's width, far field otherwise. \param absorbed_now where given, sets the powers of the source one by one
/// while it is heated
HeatOutcome expose(CellContent const& content, HeatSource const& source, Case const& settings, Communicator const& comm,
                   Report report, AbsorbedNow const& absorbed_now = {});

}  // namespace layerloop::thermal
