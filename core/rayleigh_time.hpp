#pragma once
#include <cmath>
#include <numbers>

#include "core/case.hpp"

namespace layerloop {

/// Time of a Rayleigh wave over a grain: pi R sqrt(rho/G) / (0.1631 nu + 0.8766) [s], thesis eq. 12. Time steps are
/// shares of it.
inline double rayleigh_time(double radius, double density, ContactSettings const& contact) {
  double const shear_modulus = contact.youngs_modulus / (2 * (1 + contact.poisson_ratio));
  return std::numbers::pi * radius * std::sqrt(density / shear_modulus) / (0.1631 * contact.poisson_ratio + 0.8766);
}

}  // namespace layerloop
