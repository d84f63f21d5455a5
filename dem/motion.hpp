#pragma once
#include <cstdint>

#include "core/case.hpp"
#include "dem/contact_law.hpp"
#include "dem/mixture.hpp"
#include "dem/user_attraction.hpp"

namespace layerloop::dem {

/// Settings of the grains' motion; see motion_of() for those of a case.
struct Motion {
  ContactLaw between_grains, at_walls;  ///< these three: of all grains, unless there is a mixture
  ContactSettings contact;              ///< for the form of the laws, and the guard on the duration of a contact
  double density = 0;                   ///< [kg/m^3]
  double time_step = 0;                 ///< [s]
  bool grains_sleep = false;         ///< whether grains that lie still are left alone until something moves near them
  bool keeps_energy_ledger = false;  ///< see Simulation::energy()
  Mixture mixture = {};
  std::vector<UserAttraction> user = {};  ///< effects of loaded libraries

  /// Of a grain of this PowderBed::material [kg/m^3].
  double density_of(std::int32_t material) const {
    return mixture.density.empty() ? density : mixture.density.at(static_cast<std::size_t>(material));
  }
};

/// Step: contact.time_step_fraction of the shortest Rayleigh time of the case's grains.
Motion motion_of(Case const& checked);

/// hertz_contact_time() of grains of this radius, the shortest over the materials [s].
double shortest_contact_time(Motion const& motion, double radius, double speed);

}  // namespace layerloop::dem
