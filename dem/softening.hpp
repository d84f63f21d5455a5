#pragma once
#include <string>

#include "core/case.hpp"

namespace layerloop::dem {

/// Stiffness that softened grains are compared with: that of steels and nickel alloys [Pa].
inline constexpr double metal_modulus = 200e9;

/// What a cohesion energy density k becomes when Young's modulus E is scaled by a factor.
struct CohesionScaling {
  double same_pull_off;  ///< k E^(2/3): the pull-off force of SJKR2, ~ k^3/E^2, stays
  double
      same_sticking;  ///< k E^(4/5): the fastest impact that sticks stays, F ~ E^(2/5) with k ~ F^2 in Hertz contacts
};
CohesionScaling scale_cohesion(double cohesion_energy_density, double stiffness_factor);

/// A softened modulus leaves flow as it is only when cohesion goes along: what this case's cohesion stands for at the
/// stiffness of metal, by both scalings. Empty when grains are at least a tenth as stiff as metal or not cohesive.
/// Dynamic scaling: Chen, Liu & Li, arXiv 1805.03025.
std::string softening_note(Case const& checked);

}  // namespace layerloop::dem
