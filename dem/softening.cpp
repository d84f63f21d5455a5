#include "dem/softening.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/units.hpp"

namespace layerloop::dem {

CohesionScaling scale_cohesion(double cohesion_energy_density, double stiffness_factor) {
  return {cohesion_energy_density * std::pow(stiffness_factor, 2.0 / 3.0),
          cohesion_energy_density * std::pow(stiffness_factor, 4.0 / 5.0)};
}

std::string softening_note(Case const& checked) {
  ContactSettings const& contact = checked.contact;
  double const softer = metal_modulus / contact.youngs_modulus, k = contact.cohesion_energy_density;
  if (contact.cohesion == Cohesion::none || k == 0 || softer < 10) return {};
  CohesionScaling const real = scale_cohesion(k, softer), soft = scale_cohesion(k, 1 / softer);
  auto const modulus = [](double value) { return format_quantity(value, Dimension::pressure); };
  return fmt::format(
      "contact.youngs_modulus = {} is softened {:.3g} times and cohesion is taken as given: {:.3g} J/m3 stand for "
      "{:.3g} "
      "J/m3 (same pull-off force, k ~ E^(2/3)) or {:.3g} J/m3 (same sticking speed, k ~ E^(4/5)) at {}; a value found "
      "at "
      "that stiffness would have to be lowered to {:.3g} or {:.3g} J/m3 here",
      modulus(contact.youngs_modulus), softer, k, real.same_pull_off, real.same_sticking, modulus(metal_modulus),
      soft.same_pull_off, soft.same_sticking);
}

}  // namespace layerloop::dem
