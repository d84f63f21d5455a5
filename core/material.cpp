#include "core/material.hpp"

#include <algorithm>

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

Material in718() {
  Material m;
  m.name = "IN718";
  m.density = 8190;
  m.conductivity = {{298, 550, 800, 1173, 1375, 1533, 1609}, {9.94, 14.07, 18.33, 23.37, 25.12, 26.43, 29.6}};
  m.specific_heat = {{298, 800, 1070, 1361, 1533, 1609}, {425, 531, 639, 639, 639, 720}};
  m.latent_heat = 210e3;
  m.solidus = 1533, m.liquidus = 1609, m.boiling_point = 3190;
  m.heat_of_vaporisation = 6.4e6, m.molar_mass = 0.0587, m.emissivity = 0.45;
  m.optical_data = "Ni (Johnson 1974)";
  m.source =
      "Conductivity, specific heat and latent heat: Agazhanov 2019 and Mills 2002; melting range: Mills 2002; boiling "
      "point and heat of vaporisation: those of nickel within the spread of published models; index: nickel's "
      "(no measured alloy value; chromium would absorb more).";
  return m;
}

Material in625() {
  Material m;
  m.name = "IN625";
  m.density = 8440;
  m.conductivity = {{294, 589, 811, 1033, 1255, 1563, 1623}, {9.8, 14.1, 17.5, 20.8, 25.2, 29.5, 30}};
  m.specific_heat = {{294, 600, 900, 1255, 1563, 1623}, {410, 484, 562, 645, 645, 700}};
  m.latent_heat = 290e3;
  m.solidus = 1563, m.liquidus = 1623, m.boiling_point = 3100;
  m.heat_of_vaporisation = 6.46e6, m.molar_mass = 0.0598, m.emissivity = 0.5;
  m.optical_data = "Ni (Johnson 1974)";
  m.source =
      "Solid: Special Metals data sheet; liquid, latent heat and melting range: Sabau 2020; heat of vaporisation: "
      "GO-MELT; "
      "emissivity: Lane 2020 (AMMT, effective); index: nickel's.";
  return m;
}

Material stainless_316l() {
  Material m;
  m.name = "316L";
  m.density = 7904;
  m.conductivity = {{298, 1675, 1708, 2000, 2800}, {13.9, 27.5, 28, 32, 41}};
  m.specific_heat = {{298, 500, 1250, 1350, 1675, 1708}, {502, 531, 638, 714, 714, 847}};
  m.latent_heat = 290e3;
  m.solidus = 1675, m.liquidus = 1708, m.boiling_point = 3090;
  m.heat_of_vaporisation = 7.41e6, m.molar_mass = 0.0558, m.emissivity = 0.35;
  m.optical_data = "Fe (Johnson 1974)";
  m.source =
      "Density, enthalpy, melting range and liquid conductivity (Wiedemann-Franz): Pichler 2020 (NIST SRM 1155a); "
      "solid conductivity, boiling point and heat of vaporisation: Kim 1975; index: iron's "
      "(no measured alloy value).";
  return m;
}

Material ti6al4v() {
  Material m;
  m.name = "Ti-6Al-4V";
  m.density = 4420;
  m.conductivity = {{298, 1268, 1877, 1923, 2400}, {5.94, 20.4, 27.3, 33.4, 44.9}};
  m.specific_heat = {{298, 1268, 1269, 1877, 1923}, {547, 756, 641, 751, 831}};
  m.latent_heat = 286e3;
  m.solidus = 1877, m.liquidus = 1923, m.boiling_point = 3533;
  m.heat_of_vaporisation = 9.83e6, m.molar_mass = 0.0475, m.emissivity = 0.4;
  m.optical_data = "Ti (Johnson 1974)";
  m.source =
      "Density, conductivity, specific heat, latent heat and melting range: Mills 2002; heat of vaporisation: "
      "published "
      "models; index: titanium's.";
  return m;
}

Material alsi10mg() {
  Material m;
  m.name = "AlSi10Mg";
  m.density = 2670;
  m.conductivity = {{298, 830, 867}, {115, 115, 70}};
  m.specific_heat = {{300, 800, 830, 867}, {900, 1100, 1100, 1140}};
  m.latent_heat = 400e3;
  m.solidus = 830, m.liquidus = 867, m.boiling_point = 2743;
  m.heat_of_vaporisation = 10.7e6, m.molar_mass = 0.027, m.emissivity = 0.15;
  m.optical_data = "Al (Rakic 1995)";
  m.source =
      "Typical published values of as-built AlSi10Mg; liquid conductivity uncertain by 30 %; index: "
      "aluminium's (real, oxidised surfaces absorb about three times more).";
  return m;
}

Material aluminium() {
  Material m;
  m.name = "Al";
  m.density = 2700;
  m.conductivity = {{300, 933.4, 933.6}, {237, 211, 91}};
  m.specific_heat = {{300, 933.4, 933.6}, {897, 1255, 1177}};
  m.latent_heat = 397e3;
  m.solidus = 933.5, m.liquidus = 933.5, m.boiling_point = 2743;
  m.heat_of_vaporisation = 10.9e6, m.molar_mass = 0.02698, m.emissivity = 0.1;
  m.optical_data = "Al (Rakic 1995)";
  m.source =
      "Mills 2002 and handbook values; index of clean metal (real, oxidised surfaces absorb about three times "
      "more).";
  return m;
}

Material copper() {
  Material m;
  m.name = "Cu";
  m.density = 8960;
  m.conductivity = {{300, 1357.7, 1357.9}, {401, 330, 165}};
  m.specific_heat = {{300, 1357.7, 1357.9}, {385, 480, 505}};
  m.latent_heat = 207e3;
  m.solidus = 1357.8, m.liquidus = 1357.8, m.boiling_point = 2835;
  m.heat_of_vaporisation = 4.73e6, m.molar_mass = 0.06355, m.emissivity = 0.1;
  m.optical_data = "Cu (Johnson 1972)";
  m.source = "Mills 2002 and handbook values; index of annealed films.";
  return m;
}

}  // namespace

std::map<std::string, Material> const& built_in_materials() {
  static std::map<std::string, Material> const table = [] {
    std::map<std::string, Material> metals;
    for (Material const& m : {in718(), in625(), stainless_316l(), ti6al4v(), alsi10mg(), aluminium(), copper()}) {
      metals.emplace(m.name, m);
    }
    return metals;
  }();
  return table;
}

}  // namespace layerloop
