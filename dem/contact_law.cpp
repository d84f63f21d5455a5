#include "dem/contact_law.hpp"

#include <algorithm>
#include <numbers>

namespace layerloop::dem {
namespace {
using std::numbers::pi;
constexpr double vacuum_permittivity = 8.8541878128e-12;  // [F/m]

/// E/(1 - nu^2): what a body has against a rigid one.
double plane_modulus(Body const& b) { return b.youngs_modulus / (1 - b.poisson_ratio * b.poisson_ratio); }
double tangential_modulus(Body const& b) {
  return b.youngs_modulus / (2 * (2 - b.poisson_ratio) * (1 + b.poisson_ratio));
}

/// 1/(1/first + 1/second); exactly half of either where they are alike, and the first where the second is infinite.
double in_series(double first, double second) { return first / (1 + first / second); }

/// Two bodies of the same material.
double reduced_youngs_modulus(ContactSettings const& contact) { return plane_modulus(body_of(contact)) / 2; }

double grain_mass(double radius, double density) { return 4.0 / 3.0 * pi * radius * radius * radius * density; }

bool has_energy_density(ContactSettings const& contact) {
  return contact.cohesion == Cohesion::sjkr || contact.cohesion == Cohesion::sjkr2;
}

/// \param area  contact area of sjkr2 / (R d); sjkr has half of it
ContactLaw law_between(ContactSettings const& contact, Body const& first, Body const& second, double friction,
                       double area) {
  double const E = in_series(plane_modulus(first), plane_modulus(second)),
               G = in_series(tangential_modulus(first), tangential_modulus(second));
  double const log_e = std::log(contact.restitution);
  double const damping = -2 * std::sqrt(5.0 / 6.0) * log_e / std::sqrt(log_e * log_e + pi * pi);
  double const work = 2 * contact.surface_energy;
  ContactLaw law{.normal_stiffness = 4.0 / 3.0 * E,
                 .tangential_stiffness = 8 * G,
                 .normal_damping = damping * std::sqrt(2 * E),
                 .tangential_damping = damping * std::sqrt(8 * G),
                 .sliding_friction = friction,
                 .rolling_friction = contact.rolling_friction,
                 .adhesion_in_coulomb = contact.coulomb_on == CoulombOn::total ? 1.0 : 0.0,
                 .keeps_spring = contact.sliding_spring == SlidingSpring::kept ? 1.0 : 0.0};
  if (has_energy_density(contact))
    law.cohesion = contact.cohesion_energy_density * (contact.cohesion == Cohesion::sjkr ? 0.5 : 1.0) * area;
  if (contact.cohesion == Cohesion::dmt) law.pull_off = 2 * pi * work;
  if (contact.cohesion == Cohesion::jkr) law.adhesion = std::sqrt(2 * pi * work / E);
  if (contact.liquid_volume > 0) {  // of a share of the cube of the radius 2 R
    law.bridge = {.force = 4 * pi * contact.surface_tension * std::cos(contact.contact_angle),
                  .steepness = 0.5 / std::sqrt(contact.liquid_volume),
                  .rupture = 2 * (1 + 0.5 * contact.contact_angle) * std::cbrt(contact.liquid_volume)};
  }
  if (contact.restitution_form == RestitutionForm::clamped) law.least_normal = 0;
  return law;
}
}  // namespace

LawForm law_form(ContactSettings const& contact) {
  bool const beyond = contact.liquid_volume > 0 || contact.charge_density > 0;
  Reach const attraction = contact.cohesion == Cohesion::jkr ? Reach::tear_off : Reach::touch;
  return {.reach = beyond ? Reach::beyond : attraction, .rolling = contact.rolling_model};
}

Body body_of(ContactSettings const& contact) { return {contact.youngs_modulus, contact.poisson_ratio}; }

ContactLaw grain_law(ContactSettings const& contact) { return grain_law(contact, body_of(contact), body_of(contact)); }
ContactLaw wall_law(ContactSettings const& contact) { return wall_law(contact, body_of(contact), body_of(contact)); }

ContactLaw grain_law(ContactSettings const& contact, Body const& first, Body const& second) {
  ContactLaw law = law_between(contact, first, second, contact.sliding_friction, 4 * pi);
  law.charge = -4 * pi * contact.charge_density * contact.charge_density / vacuum_permittivity;
  return law;
}

ContactLaw wall_law(ContactSettings const& contact, Body const& grain, Body const& wall) {
  double const area = contact.wall_cohesion_area == WallCohesionArea::eq6 ? 4 * pi : 2 * pi;
  ContactSettings at_wall = contact;
  at_wall.cohesion_energy_density *= contact.wall_cohesion;
  at_wall.surface_energy *= contact.wall_cohesion;
  ContactLaw law = law_between(at_wall, grain, wall, contact.wall_friction, area);
  law.charge = pi * contact.charge_density * contact.charge_density / vacuum_permittivity;  // image in a conductor
  return law;
}

double hertz_contact_time(double radius, double density, double speed, ContactSettings const& contact) {
  double const mass = grain_mass(radius, density) / 2, E = reduced_youngs_modulus(contact);
  return 2.868 * std::pow(mass * mass / (radius / 2 * E * E * speed), 0.2);
}

double bond_number(double radius, double density, ContactSettings const& contact) {
  double const R = radius / 2, E = reduced_youngs_modulus(contact), work = 2 * contact.surface_energy;
  double const k = contact.cohesion_energy_density * (contact.cohesion == Cohesion::sjkr ? 0.5 : 1.0);
  double pull_off = 0;
  if (has_energy_density(contact)) pull_off = 16 * pi * pi * pi / 3 * k * k * k * R * R / (E * E);
  if (contact.cohesion == Cohesion::dmt) pull_off = 2 * pi * work * R;
  if (contact.cohesion == Cohesion::jkr) pull_off = 1.5 * pi * work * R;
  return pull_off / (grain_mass(radius, density) * standard_gravity);
}

double reach_gap(ContactLaw const& law, double reduced_radius) {
  double const tear_off = 0.75 * law.adhesion * std::cbrt(law.adhesion * reduced_radius / 4);
  return std::max({tear_off, law.bridge.rupture * reduced_radius, law.charge != 0 ? reduced_radius : 0.0});
}

}  // namespace layerloop::dem
