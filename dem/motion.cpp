#include "dem/motion.hpp"

#include <algorithm>
#include <limits>

#include "core/grain_size.hpp"
#include "core/rayleigh_time.hpp"

namespace layerloop::dem {

Motion motion_of(Case const& checked) {
  double const smallest = std::ranges::min(fed_powder(checked).diameters) / 2;
  std::string const& name = checked.material.name;
  return {.between_grains = grain_law(checked, name, name),
          .at_walls = wall_law(checked, name),
          .contact = contact_between(checked, name, name),
          .density = checked.material.density,
          .time_step = checked.contact.time_step_fraction * shortest_rayleigh_time(checked, smallest),
          .grains_sleep = checked.run.grains_sleep,
          .keeps_energy_ledger = checked.run.energy_ledger,
          .mixture = mixture_of(checked),
          .user = user_attractions(checked)};
}

double shortest_contact_time(Motion const& motion, double radius, double speed) {
  if (motion.mixture.density.empty()) return hertz_contact_time(radius, motion.density, speed, motion.contact);
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < motion.mixture.materials(); ++m)
    shortest =
        std::min(shortest, hertz_contact_time(radius, motion.mixture.density[m], speed, motion.mixture.contact[m]));
  return shortest;
}

}  // namespace layerloop::dem
