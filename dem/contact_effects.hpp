#pragma once
#include "core/case.hpp"

namespace layerloop::dem {

/// The case's contact values with its effects: `cohesion`, `rolling_resistance`, `wall_friction` and `wall_cohesion`
/// scale what [contact] gives (on unless they are switched off; null value 0: there is none of it, and walls rub as
/// grains do); `capillary_bridge`, `electrostatic_charge` and `gas_drag` add what it does not have. Each at its null
/// value leaves every bit as it is without it.
ContactSettings contact_with_effects(Case const& checked);
/// The same for the contact values of a material or pair.
ContactSettings with_effects(ContactSettings contact, Case const& checked);

}  // namespace layerloop::dem
