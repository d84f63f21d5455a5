#pragma once
#include <cstddef>
#include <cstdint>

#include "dem/contact_law.hpp"

namespace layerloop::dem {

/// One law for eight contacts.
inline BasicContactLaw<Numbers> filled_law(ContactLaw const& law) {
  auto const all = [](double value) { return filled<Numbers>(value); };
  return {all(law.normal_stiffness), all(law.tangential_stiffness),
          all(law.normal_damping),   all(law.tangential_damping),
          all(law.sliding_friction), all(law.rolling_friction),
          all(law.cohesion),         all(law.pull_off),
          all(law.adhesion),         {all(law.bridge.force), all(law.bridge.steepness), all(law.bridge.rupture)},
          all(law.charge),           all(law.adhesion_in_coulomb),
          all(law.least_normal),     all(law.keeps_spring)};
}

/// The laws of eight contacts: as many numbers, in the same order, as in one law.
inline BasicContactLaw<Numbers> gathered_law(ContactLaw const* laws, std::int64_t const* which) {
  constexpr std::size_t numbers = sizeof(ContactLaw) / sizeof(double);
  static_assert(sizeof(BasicContactLaw<Numbers>) == numbers * sizeof(Numbers));
  BasicContactLaw<Numbers> gathered;
  auto* to = reinterpret_cast<double*>(&gathered);
  for (std::size_t l = 0; l < lanes_at_once; ++l) {
    auto const* from = reinterpret_cast<double const*>(laws + which[l]);
    for (std::size_t n = 0; n < numbers; ++n) to[n * lanes_at_once + l] = from[n];
  }
  return gathered;
}

}  // namespace layerloop::dem
