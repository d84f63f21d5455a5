#include "dem/mixture.hpp"

#include <algorithm>

#include "core/contact_pairs.hpp"
#include "core/random.hpp"
#include "dem/contact_effects.hpp"

namespace layerloop::dem {

ContactSettings contact_between(Case const& checked, std::string const& first, std::string const& second) {
  return with_effects(contact_of_pair(checked, first, second), checked);
}

ContactLaw grain_law(Case const& checked, std::string const& first, std::string const& second) {
  return grain_law(contact_between(checked, first, second), body_of(contact_of_body(checked, first)),
                   body_of(contact_of_body(checked, second)));
}

ContactLaw wall_law(Case const& checked, std::string const& material) {
  return wall_law(contact_between(checked, material, walls_name), body_of(contact_of_body(checked, material)),
                  body_of(contact_of_body(checked, walls_name)));
}

Mixture mixture_of(Case const& checked) {
  Mixture mixture;
  if (checked.admixtures.empty()) return mixture;
  std::vector<Material> const metals = checked.materials();
  for (std::size_t a = 0; a < metals.size(); ++a) {
    std::string const& name = metals[a].name;
    mixture.density.push_back(metals[a].density);
    mixture.contact.push_back(contact_between(checked, name, name));
    mixture.at_walls.push_back(wall_law(checked, name));
    for (std::size_t b = 0; b < metals.size(); ++b)  // each pair in one order, so that both entries have the same bits
      mixture.between_grains.push_back(grain_law(checked, metals[std::min(a, b)].name, metals[std::max(a, b)].name));
  }
  return mixture;
}

std::int32_t draw_material(Case const& checked, std::int64_t id) {
  if (checked.admixtures.empty()) return 0;
  std::vector<double> number;
  double total = 0;
  for (Material const& metal : checked.materials()) {
    number.push_back(checked.powder.mixture.at(metal.name) / metal.density);
    total += number.back();
  }
  double left = total * uniform4(checked.seed, RandomStream::grain_material, static_cast<std::uint64_t>(id))[0];
  for (std::size_t m = 0; m < number.size(); ++m) {
    left -= number[m];
    if (left < 0) return static_cast<std::int32_t>(m);
  }
  return static_cast<std::int32_t>(number.size() - 1);
}

}  // namespace layerloop::dem
