#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/contact_pairs.hpp"

namespace layerloop {

/// Time of a Rayleigh wave over a grain: pi R sqrt(rho/G) / (0.1631 nu + 0.8766) [s], thesis eq. 12. Time steps are
/// shares of it. Part of its caller, so that the motion has the same bits whatever the rest is compiled with.
[[gnu::always_inline]] inline double rayleigh_time(double radius, double density, ContactSettings const& contact) {
  double const shear_modulus = contact.youngs_modulus / (2 * (1 + contact.poisson_ratio));
  return std::numbers::pi * radius * std::sqrt(density / shear_modulus) / (0.1631 * contact.poisson_ratio + 0.8766);
}

/// The shortest over the materials of the powder, of grains of this radius [s].
[[gnu::always_inline]] inline double shortest_rayleigh_time(Case const& checked, double radius) {
  double shortest = std::numeric_limits<double>::infinity();
  for (Material const& metal : checked.materials())
    shortest = std::min(shortest, rayleigh_time(radius, metal.density, contact_of_body(checked, metal.name)));
  return shortest;
}

}  // namespace layerloop
