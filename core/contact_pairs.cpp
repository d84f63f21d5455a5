#include "core/contact_pairs.hpp"

#include <algorithm>
#include <array>

namespace layerloop {
namespace {

/// What is given of a pair; nothing where it has no table.
PairSettings given_of(Case const& checked, std::string const& a, std::string const& b) {
  auto const pair = checked.pairs.find(std::array{std::min(a, b), std::max(a, b)});
  return pair != checked.pairs.end() ? pair->second : PairSettings{};
}

}  // namespace

ContactSettings contact_of_body(Case const& checked, std::string const& body) {
  ContactSettings contact = checked.contact;
  auto const found = checked.bodies.find(body);
  if (found == checked.bodies.end()) return contact;
  contact.youngs_modulus = found->second.youngs_modulus.value_or(contact.youngs_modulus);
  contact.poisson_ratio = found->second.poisson_ratio.value_or(contact.poisson_ratio);
  return contact;
}

ContactSettings contact_of_pair(Case const& checked, std::string const& first, std::string const& second) {
  ContactSettings contact = contact_of_body(checked, first);
  PairSettings const given = given_of(checked, first, second);
  contact.restitution = given.restitution.value_or(contact.restitution);
  contact.rolling_friction = given.rolling_friction.value_or(contact.rolling_friction);
  contact.cohesion_energy_density = given.cohesion_energy_density.value_or(contact.cohesion_energy_density);
  contact.surface_energy = given.surface_energy.value_or(contact.surface_energy);
  double& friction = second == walls_name ? contact.wall_friction : contact.sliding_friction;
  friction = given.sliding_friction.value_or(friction);
  if (second == walls_name)
    contact.sliding_friction = given_of(checked, first, first).sliding_friction.value_or(contact.sliding_friction);
  return contact;
}

}  // namespace layerloop
