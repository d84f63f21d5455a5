#include "dem/contact_effects.hpp"

namespace layerloop::dem {
namespace {

/// Of an effect that is there unless it is switched off; a case made without the schema has it too.
double strength_of_standing(Case const& checked, std::string const& effect) {
  return checked.effects.contains(effect) ? checked.effect_strength(effect) : 1.0;
}

double parameter(Case const& checked, std::string const& effect, std::string const& name) {
  return checked.effects.at(effect).parameters.at(name);
}
}  // namespace

ContactSettings contact_with_effects(Case const& checked) { return with_effects(checked.contact, checked); }

ContactSettings with_effects(ContactSettings contact, Case const& checked) {
  double const cohesion = strength_of_standing(checked, "cohesion");
  contact.cohesion_energy_density *= cohesion;
  contact.surface_energy *= cohesion;
  if (cohesion == 0) contact.cohesion = Cohesion::none;
  contact.rolling_friction *= strength_of_standing(checked, "rolling_resistance");
  contact.wall_cohesion = strength_of_standing(checked, "wall_cohesion");
  double const own_friction = strength_of_standing(checked, "wall_friction");
  if (own_friction != 1)
    contact.wall_friction =
        contact.sliding_friction + own_friction * (contact.wall_friction - contact.sliding_friction);

  if (double const strength = checked.effect_strength("capillary_bridge"); strength > 0) {
    contact.liquid_volume = strength * parameter(checked, "capillary_bridge", "liquid_volume");
    contact.surface_tension = parameter(checked, "capillary_bridge", "surface_tension");
    contact.contact_angle = parameter(checked, "capillary_bridge", "contact_angle");
  }
  if (double const strength = checked.effect_strength("electrostatic_charge"); strength > 0)
    contact.charge_density = strength * parameter(checked, "electrostatic_charge", "charge_density");
  if (double const strength = checked.effect_strength("gas_drag"); strength > 0)
    contact.gas_viscosity = strength * parameter(checked, "gas_drag", "viscosity");
  return contact;
}

}  // namespace layerloop::dem
