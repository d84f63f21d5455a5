#include "dem/contact_law.hpp"

#include <numbers>

namespace layerloop::dem {
namespace {
using std::numbers::pi;

/// Two bodies of the same material.
double reduced_youngs_modulus(ContactSettings const& contact) {
  return contact.youngs_modulus / (2 * (1 - contact.poisson_ratio * contact.poisson_ratio));
}

double reduced_shear_modulus(ContactSettings const& contact) {
  return contact.youngs_modulus / (4 * (2 - contact.poisson_ratio) * (1 + contact.poisson_ratio));
}

double grain_mass(double radius, double density) { return 4.0 / 3.0 * pi * radius * radius * radius * density; }

/// \param area  contact area / (R d)
ContactLaw law_between(ContactSettings const& contact, double friction, double area) {
  double const E = reduced_youngs_modulus(contact), G = reduced_shear_modulus(contact);
  double const log_e = std::log(contact.restitution);
  double const damping = -2 * std::sqrt(5.0 / 6.0) * log_e / std::sqrt(log_e * log_e + pi * pi);
  double const cohesion = contact.cohesion == Cohesion::none ? 0.0 : contact.cohesion_energy_density * area;
  return {.normal_stiffness = 4.0 / 3.0 * E,
          .tangential_stiffness = 8 * G,
          .normal_damping = damping * std::sqrt(2 * E),
          .tangential_damping = damping * std::sqrt(8 * G),
          .sliding_friction = friction,
          .rolling_friction = contact.rolling_friction,
          .cohesion = cohesion,
          .cohesion_in_coulomb = contact.coulomb_on == CoulombOn::total ? cohesion : 0.0};
}
}  // namespace

ContactLaw grain_law(ContactSettings const& contact) { return law_between(contact, contact.sliding_friction, 4 * pi); }

ContactLaw wall_law(ContactSettings const& contact) {
  double const area = contact.wall_cohesion_area == WallCohesionArea::eq6 ? 4 * pi : 2 * pi;
  return law_between(contact, contact.wall_friction, area);
}

double rayleigh_time(double radius, double density, ContactSettings const& contact) {
  double const shear_modulus = contact.youngs_modulus / (2 * (1 + contact.poisson_ratio));
  return pi * radius * std::sqrt(density / shear_modulus) / (0.1631 * contact.poisson_ratio + 0.8766);
}

double hertz_contact_time(double radius, double density, double speed, ContactSettings const& contact) {
  double const mass = grain_mass(radius, density) / 2, E = reduced_youngs_modulus(contact);
  return 2.868 * std::pow(mass * mass / (radius / 2 * E * E * speed), 0.2);
}

double bond_number(double radius, double density, ContactSettings const& contact) {
  if (contact.cohesion == Cohesion::none) return 0;
  double const k = contact.cohesion_energy_density, R = radius / 2, E = reduced_youngs_modulus(contact);
  double const pull_off = 16 * pi * pi * pi / 3 * k * k * k * R * R / (E * E);
  return pull_off / (grain_mass(radius, density) * 9.81);
}

}  // namespace layerloop::dem
