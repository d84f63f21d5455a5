#include "core/material.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/material_table.hpp"

namespace layerloop {

double PropertyTable::operator()(double T) const {
  if (temperature.empty()) return 0;
  auto const above = std::upper_bound(temperature.begin(), temperature.end(), T);
  if (above == temperature.begin()) return value.front();
  if (above == temperature.end()) return value.back();
  auto const i = static_cast<std::size_t>(above - temperature.begin());
  double const share = (T - temperature[i - 1]) / (temperature[i] - temperature[i - 1]);
  return value[i - 1] + share * (value[i] - value[i - 1]);
}

namespace {

std::map<std::string, double Material::*> const numbers{{"density", &Material::density},
                                                        {"latent_heat", &Material::latent_heat},
                                                        {"solidus", &Material::solidus},
                                                        {"liquidus", &Material::liquidus},
                                                        {"boiling_point", &Material::boiling_point},
                                                        {"heat_of_vaporisation", &Material::heat_of_vaporisation},
                                                        {"molar_mass", &Material::molar_mass},
                                                        {"emissivity", &Material::emissivity},
                                                        {"surface_tension", &Material::surface_tension},
                                                        {"surface_tension_slope", &Material::surface_tension_slope}};

std::map<std::string, PropertyTable Material::*> const tables{{"solid_density", &Material::solid_density},
                                                              {"liquid_density", &Material::liquid_density},
                                                              {"conductivity", &Material::conductivity},
                                                              {"specific_heat", &Material::specific_heat},
                                                              {"viscosity", &Material::viscosity}};

Material joined(MetalRows const& metal) {
  Material m;
  m.name = metal.name, m.optical_data = metal.optical_data;
  for (PropertyRow const& row : metal.rows) {
    if (auto const number = numbers.find(row.key); number != numbers.end()) {
      m.*number->second = row.values.value.front();
    } else {
      PropertyTable& table = m.*tables.at(row.key);
      table.temperature.insert(table.temperature.end(), row.values.temperature.begin(), row.values.temperature.end());
      table.value.insert(table.value.end(), row.values.value.begin(), row.values.value.end());
    }
    for (std::string const& name : source_names(row))
      if (m.source.find(name) == std::string::npos) m.source += (m.source.empty() ? "" : ", ") + name;
  }
  m.source += "; each value in docs/materials.md";
  return m;
}

}  // namespace

std::map<std::string, Material> const& built_in_materials() {
  static std::map<std::string, Material> const metals = [] {
    std::map<std::string, Material> all;
    for (MetalRows const& metal : material_table()) all.emplace(metal.name, joined(metal));
    return all;
  }();
  return metals;
}

std::vector<std::string> uses_beyond_range(Material const& material, double coldest, double hottest) {
  std::vector<std::string> uses;
  for (char const* const key : {"conductivity", "specific_heat"}) {
    PropertyTable const& table = material.*tables.at(key);
    if (table.temperature.size() < 2) continue;
    auto const add = [&](char const* side, double end) {
      uses.push_back(fmt::format(
          "the {} of {} is used {} {:g} K (where its table ends; the value there is kept) [material.{}] may "
          "give more points",
          key, material.name, side, end, material.name));
    };
    if (coldest < table.temperature.front() - 10) add("below", table.temperature.front());
    if (hottest > table.temperature.back()) add("above", table.temperature.back());
  }
  return uses;
}

}  // namespace layerloop
