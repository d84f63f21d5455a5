#include "core/material_table.hpp"

// The built-in metals. One block a metal, one row a property: key, phase, values over temperature, relative
// uncertainty, evidence, source, note. Temperatures in K, values in SI. `layerloop check --help-materials` shows it as
// a page.
namespace layerloop {
namespace {

using enum Phase;
using enum Evidence;

/// A value that belongs to one temperature, or to none.
PropertyTable at(double T, double value) { return {{T}, {value}}; }
PropertyTable fixed(double value) { return at(0, value); }

// clang-format off
MetalRows in718() {
  return {"IN718", "Ni (Johnson 1974)", {
    {"density", solid, at(298, 8190), 0.005, quoted, "Mills 2002", "Agazhanov 2019: 8170"},
    {"solid_density", solid, {{298, 1533}, {8190, 7706}}, 0.02, quoted, "Mills 2002", "8190 - 0.392 (T - 298)"},
    {"liquid_density", liquid, {{1609, 1873}, {7400, 7168}}, 0.04, quoted, "Mills 2002", "7400 - 0.88 (T - 1609)"},
    {"conductivity", solid, {{298, 550, 800, 1173, 1375, 1533}, {9.94, 14.07, 18.33, 23.37, 25.12, 26.43}}, 0.05, read, "Agazhanov 2019", "measured 298 to 800 and 1173 to 1375 K, straight between; its last fit carried on to the solidus"},
    {"conductivity", liquid, at(1609, 29.6), 0.3, read, "Mills 2002", "estimated there"},
    {"specific_heat", solid, {{298, 800, 1070, 1361, 1533}, {425, 531, 639, 639, 639}}, 0.05, read, "Agazhanov 2019", "362 + 0.2118 T to 800 K, some 639 from 1070 to 1361 K, straight between"},
    {"specific_heat", liquid, {{1609, 1873}, {720, 720}}, 0.08, read, "Mills 2002", ""},
    {"latent_heat", any, fixed(210e3), 0.08, read, "Mills 2002", "others: 227 kJ/kg"},
    {"solidus", any, fixed(1533), 0.01, read, "Mills 2002", ""},
    {"liquidus", any, fixed(1609), 0.005, read, "Mills 2002", ""},
    {"boiling_point", any, fixed(3190), 0.06, assumed, "CRC Handbook", "nickel's; models use 3000 to 3200 K"},
    {"heat_of_vaporisation", any, fixed(6.4e6), 0.1, assumed, "CRC Handbook", "nickel's"},
    {"molar_mass", any, fixed(0.0587), 0.03, read, "Agazhanov 2019", "from the composition; the vapour is richer in Cr"},
    {"emissivity", any, fixed(0.45), 0.3, assumed, "Lane 2020", "0.4 to 0.5 is usual"},
    {"viscosity", liquid, at(1609, 7.0e-3), 0.3, read, "Mills 2002", ""},
    {"surface_tension", liquid, at(1609, 1.85), 0.05, quoted, "Mills 2002", "low in oxygen and sulphur"},
    {"surface_tension_slope", liquid, at(1609, -0.37e-3), 0.7, read, "Wei 2015", "others: -0.11 mN/(m K); turns positive with sulphur"},
  }};
}

MetalRows in625() {
  return {"IN625", "Ni (Johnson 1974)", {
    {"density", solid, at(294, 8440), 0.005, read, "Special Metals 625", ""},
    {"solid_density", solid, {{294, 1200}, {8440, 8079}}, 0.01, quoted, "Special Metals 625", "from the mean expansion 16.2e-6 /K to 1200 K"},
    {"liquid_density", liquid, at(1623, 7750), 0.05, quoted, "Sabau 2020", "as models use it; no measurement known"},
    {"conductivity", solid, {{294, 589, 811, 1033, 1255, 1563}, {9.8, 14.1, 17.5, 20.8, 25.2, 29.5}}, 0.05, read, "Special Metals 625, Sabau 2020", "the data sheet ends at 1255 K; the solidus from 4.93 + 0.01575 T"},
    {"conductivity", liquid, at(1623, 30), 0.3, read, "Sabau 2020", ""},
    {"specific_heat", solid, {{294, 600, 900, 1255, 1563}, {410, 484, 562, 645, 645}}, 0.05, read, "Special Metals 625, Sabau 2020", "calculated there; kept beyond 1255 K"},
    {"specific_heat", liquid, at(1623, 700), 0.08, read, "Sabau 2020", ""},
    {"latent_heat", any, fixed(290e3), 0.15, read, "Sabau 2020", "others: 227 and 280 kJ/kg"},
    {"solidus", any, fixed(1563), 0.01, read, "Special Metals 625", ""},
    {"liquidus", any, fixed(1623), 0.01, read, "Special Metals 625", ""},
    {"boiling_point", any, fixed(3100), 0.06, assumed, "CRC Handbook", "between chromium and nickel; models use 3000 to 3170 K"},
    {"heat_of_vaporisation", any, fixed(6.46e6), 0.1, read, "Leonor 2024", "nickel's is 6.4 MJ/kg"},
    {"molar_mass", any, fixed(0.0598), 0.03, quoted, "Special Metals 625", "from the composition"},
    {"emissivity", any, fixed(0.5), 0.3, read, "Lane 2020", "effective 0.52 to 0.68 in the camera's band; total is lower"},
    {"viscosity", liquid, at(1623, 5.5e-3), 0.4, quoted, "Sabau 2020", "as models use it"},
    {"surface_tension", liquid, at(1623, 1.75), 0.1, quoted, "Sabau 2020", "as models use it"},
    {"surface_tension_slope", liquid, at(1623, -0.40e-3), 0.7, quoted, "Sabau 2020", "as models use it; turns positive with sulphur"},
  }};
}

MetalRows stainless_316l() {
  return {"316L", "Fe (Johnson 1974)", {
    {"density", solid, at(298, 7904), 0.025, read, "Pichler 2020", ""},
    {"solid_density", solid, {{298, 500, 1675}, {7904, 7770, 7107.3}}, 0.025, read, "Pichler 2020", "8052 - 0.564 T from 500 K"},
    {"liquid_density", liquid, {{1708, 2900}, {6936, 6148.1}}, 0.03, read, "Pichler 2020", "8065 - 0.661 T"},
    {"conductivity", solid, {{298, 1000, 1675}, {13.93, 24.96, 27.5}}, 0.1, quoted, "Kim 1975, Graves 1991, Pichler 2020", "9.248 + 0.01571 T (Kim) to 1000 K, where Graves agrees to 5 % on 304L; then straight to the electrical value at the solidus. Kim's line alone would end at 35.6. Open tables with 0.6658 + 0.01571 T shifted Kim's line between Celsius and kelvin: 5.4 instead of 14.0 at 300 K"},
    {"conductivity", liquid, {{1708, 2000, 2800}, {28, 32, 41}}, 0.3, read, "Pichler 2020", "Wiedemann-Franz from the resistivity measured on the melt. Kim's 12.4 + 0.0033 T = 18 is an estimate, a third below the solid at the solidus although the measured resistivity hardly jumps there: not taken"},
    {"specific_heat", solid, {{298, 500, 1250, 1300, 1350, 1450, 1675}, {502, 531, 638, 590, 640, 700, 714}}, 0.029, read, "Pichler 2020", "slope of H = -139 + 0.459 T + 7.16e-5 T^2 kJ/kg (500 to 1250 K) and near the solidus of -374 + 0.714 T (from 1350 K); lowered from 1250 to 1450 K, since these two fits lie 24 kJ/kg closer than their slopes would carry"},
    {"specific_heat", liquid, {{1708, 2900}, {847, 847}}, 0.029, read, "Pichler 2020", ""},
    {"latent_heat", any, fixed(264e3), 0.08, read, "Pichler 2020", "the enthalpy rises from 822 to 1112 kJ/kg between solidus and liquidus; 26 of these 290 are specific heat"},
    {"solidus", any, fixed(1675), 0.009, read, "Pichler 2020", ""},
    {"liquidus", any, fixed(1708), 0.018, read, "Pichler 2020", ""},
    {"boiling_point", any, fixed(3090), 0.05, read, "Kim 1975", "models use 2800 to 3100 K"},
    {"heat_of_vaporisation", any, fixed(7.41e6), 0.1, read, "Kim 1975", "models use 6.3 to 7.45 MJ/kg"},
    {"molar_mass", any, fixed(0.0558), 0.02, read, "Kim 1975", "the vapour is richer in Cr and Mn"},
    {"emissivity", any, fixed(0.35), 0.3, assumed, "Kim 1975", "0.3 to 0.4 is usual"},
    {"viscosity", liquid, {{1708, 1800, 1900, 2000, 2300, 2800}, {6.32e-3, 5.36e-3, 4.57e-3, 3.95e-3, 2.76e-3, 1.80e-3}}, 0.4, quoted, "Kim 1975", "10^(2385.2/T - 0.5958) mPa s; pure iron (Assael 2006) has 5.9 mPa s at 1811 K. Models with 2.2 and 3.25 mPa s exist"},
    {"surface_tension", liquid, at(1708, 1.7), 0.06, quoted, "Mills 2002", "low in sulphur"},
    {"surface_tension_slope", liquid, at(1708, -0.40e-3), 0.5, quoted, "Mills 2002", "low in sulphur; positive above some 50 ppm S"},
  }};
}

MetalRows ti6al4v() {
  return {"Ti-6Al-4V", "Ti (Johnson 1974)", {
    {"density", solid, at(298, 4420), 0.01, quoted, "Mills 2002", ""},
    {"solid_density", solid, {{298, 1877}, {4420, 4177}}, 0.02, quoted, "Mills 2002", "4420 - 0.154 (T - 298)"},
    {"liquid_density", liquid, {{1923, 2600}, {3920, 3460}}, 0.04, quoted, "Mills 2002, Gan 2021", "3920 - 0.68 (T - 1923)"},
    {"conductivity", solid, {{298, 1268, 1877}, {5.94, 20.4, 27.3}}, 0.1, quoted, "Mills 2002", "1.26 + 0.0157 T (alpha, to 1268 K), 3.51 + 0.0127 T (beta)"},
    {"conductivity", liquid, {{1923, 2400}, {33.4, 44.9}}, 0.2, quoted, "Mills 2002, Gan 2021", "-12.75 + 0.024 T"},
    {"specific_heat", solid, {{298, 1268, 1269, 1877}, {547, 756, 641, 751}}, 0.05, quoted, "Mills 2002", "483 + 0.215 T (alpha), 413 + 0.180 T (beta); the 48 kJ/kg of the transformation at 1268 K are left out"},
    {"specific_heat", liquid, {{1923, 2400}, {831, 831}}, 0.05, read, "Mills 2002", ""},
    {"latent_heat", any, fixed(286e3), 0.05, read, "Mills 2002", ""},
    {"solidus", any, fixed(1877), 0.005, read, "Mills 2002", ""},
    {"liquidus", any, fixed(1923), 0.005, read, "Mills 2002", ""},
    {"boiling_point", any, fixed(3533), 0.06, read, "Gan 2021", "others: 3315 K"},
    {"heat_of_vaporisation", any, fixed(9.83e6), 0.06, read, "Gan 2021", "9.26 to 9.83 MJ/kg in published models"},
    {"molar_mass", any, fixed(0.0475), 0.01, quoted, "CRC Handbook", "titanium's is 0.0479; the vapour is richer in Al"},
    {"emissivity", any, fixed(0.4), 0.25, assumed, "Mills 2002", "0.3 to 0.5 is usual"},
    {"viscosity", liquid, {{1923, 2000, 2100, 2200, 2400}, {3.25e-3, 2.92e-3, 2.58e-3, 2.29e-3, 1.87e-3}}, 0.2, read, "Mills 2002", "exp(-1.6 + 5346/T) mPa s"},
    {"surface_tension", liquid, at(1923, 1.55), 0.05, quoted, "Mills 2002", ""},
    {"surface_tension_slope", liquid, at(1923, -0.26e-3), 0.3, quoted, "Mills 2002", ""},
  }};
}

MetalRows alsi10mg() {
  return {"AlSi10Mg", "Al (Rakic 1995)", {
    {"density", solid, at(298, 2670), 0.005, quoted, "EN 1706", ""},
    {"liquid_density", liquid, at(867, 2380), 0.03, quoted, "Mills 2002", "of Al-Si casting alloys"},
    {"conductivity", solid, {{298, 830}, {115, 115}}, 0.15, quoted, "EN 1706", "as built 100 to 130, wrought 150 to 170 W/(m K)"},
    {"conductivity", liquid, at(867, 70), 0.3, quoted, "Mills 2002", "60 to 85 W/(m K); no measurement of this alloy known"},
    {"specific_heat", solid, {{300, 800, 830}, {900, 1100, 1100}}, 0.05, quoted, "Mills 2002", "of Al-Si casting alloys"},
    {"specific_heat", liquid, at(867, 1140), 0.05, quoted, "Mills 2002", "1090 to 1190 J/(kg K)"},
    {"latent_heat", any, fixed(400e3), 0.06, quoted, "Mills 2002", "389 to 425 kJ/kg"},
    {"solidus", any, fixed(830), 0.005, quoted, "Mills 2002", "eutectic"},
    {"liquidus", any, fixed(867), 0.005, quoted, "Mills 2002", ""},
    {"boiling_point", any, fixed(2743), 0.02, assumed, "CRC Handbook", "aluminium's; magnesium leaves first"},
    {"heat_of_vaporisation", any, fixed(10.7e6), 0.03, assumed, "CRC Handbook", "aluminium's"},
    {"molar_mass", any, fixed(0.027), 0.01, quoted, "CRC Handbook", ""},
    {"emissivity", any, fixed(0.15), 0.4, assumed, "CRC Handbook", "0.1 to 0.2 is usual"},
    {"viscosity", liquid, at(867, 1.15e-3), 0.2, quoted, "Mills 2002", "1.0 to 1.3 mPa s"},
    {"surface_tension", liquid, at(867, 0.85), 0.06, quoted, "Mills 2002", "oxidised"},
    {"surface_tension_slope", liquid, at(867, -0.25e-3), 0.4, quoted, "Mills 2002", "-0.15 to -0.35 mN/(m K)"},
  }};
}

MetalRows aluminium() {
  return {"Al", "Al (Rakic 1995)", {
    {"density", solid, at(298, 2700), 0.002, quoted, "CRC Handbook", ""},
    {"solid_density", solid, {{298, 933.4}, {2700, 2550}}, 0.01, quoted, "CRC Handbook", "straight line over the expansion to the melting point"},
    {"liquid_density", liquid, {{933.6, 1190}, {2377.2, 2297.4}}, 0.0065, quoted, "Assael 2006", "2377.23 - 0.311 (T - 933.47)"},
    {"conductivity", solid, {{300, 933.4}, {237, 211}}, 0.03, quoted, "Ho 1972", "pure metal; sheet of 99 % has 220 at 300 K"},
    {"conductivity", liquid, at(933.6, 91), 0.1, quoted, "Ho 1972", ""},
    {"specific_heat", solid, {{300, 933.4}, {897, 1255}}, 0.03, quoted, "Chase 1998", "straight between the ends"},
    {"specific_heat", liquid, at(933.6, 1177), 0.03, quoted, "Chase 1998", ""},
    {"latent_heat", any, fixed(397e3), 0.02, quoted, "Chase 1998", ""},
    {"solidus", any, fixed(933.5), 0.0005, quoted, "CRC Handbook", ""},
    {"liquidus", any, fixed(933.5), 0.0005, quoted, "CRC Handbook", ""},
    {"boiling_point", any, fixed(2743), 0.02, quoted, "CRC Handbook", "others: 2792 K"},
    {"heat_of_vaporisation", any, fixed(10.9e6), 0.03, quoted, "CRC Handbook", ""},
    {"molar_mass", any, fixed(0.02698), 0.0005, quoted, "CRC Handbook", ""},
    {"emissivity", any, fixed(0.1), 0.5, assumed, "CRC Handbook", "0.05 clean to 0.2 oxidised"},
    {"viscosity", liquid, {{933.6, 1000, 1100, 1190}, {1.34e-3, 1.18e-3, 1.00e-3, 0.88e-3}}, 0.14, quoted, "Assael 2006", "10^(803.49/T - 0.7324) mPa s"},
    {"surface_tension", liquid, at(933.6, 0.87), 0.1, quoted, "Keene 1993", "oxidised; 1.05 when clean"},
    {"surface_tension_slope", liquid, at(933.6, -0.16e-3), 0.4, quoted, "Keene 1993", "-0.27 mN/(m K) when clean"},
  }};
}

MetalRows copper() {
  return {"Cu", "Cu (Johnson 1972)", {
    {"density", solid, at(298, 8960), 0.002, quoted, "CRC Handbook", ""},
    {"liquid_density", liquid, {{1357.9, 1950}, {7997, 7512}}, 0.013, quoted, "Assael 2010", "7997 - 0.819 (T - 1357.77)"},
    {"conductivity", solid, {{300, 1357.7}, {401, 330}}, 0.03, quoted, "Ho 1972", "straight between the ends; pure metal"},
    {"conductivity", liquid, at(1357.9, 165), 0.05, quoted, "Ho 1972", ""},
    {"specific_heat", solid, {{300, 1357.7}, {385, 480}}, 0.03, quoted, "Chase 1998", "straight between the ends"},
    {"specific_heat", liquid, at(1357.9, 505), 0.03, quoted, "Chase 1998", "495 to 515 J/(kg K)"},
    {"latent_heat", any, fixed(207e3), 0.02, quoted, "Chase 1998", ""},
    {"solidus", any, fixed(1357.8), 0.0005, quoted, "CRC Handbook", ""},
    {"liquidus", any, fixed(1357.8), 0.0005, quoted, "CRC Handbook", ""},
    {"boiling_point", any, fixed(2835), 0.01, quoted, "CRC Handbook", ""},
    {"heat_of_vaporisation", any, fixed(4.73e6), 0.02, quoted, "CRC Handbook", ""},
    {"molar_mass", any, fixed(0.06355), 0.0005, quoted, "CRC Handbook", ""},
    {"emissivity", any, fixed(0.1), 0.5, assumed, "CRC Handbook", "0.05 to 0.15 of a clean melt"},
    {"viscosity", liquid, {{1357.9, 1450, 1600, 1800, 1950}, {4.02e-3, 3.46e-3, 2.81e-3, 2.25e-3, 1.96e-3}}, 0.08, quoted, "Assael 2010", "10^(1393.4/T - 0.422) mPa s"},
    {"surface_tension", liquid, at(1357.9, 1.30), 0.03, quoted, "Keene 1993", ""},
    {"surface_tension_slope", liquid, at(1357.9, -0.23e-3), 0.2, quoted, "Keene 1993", ""},
  }};
}
// clang-format on

}  // namespace

std::vector<MetalRows> const& material_table() {
  static std::vector<MetalRows> const metals{in718(),    in625(),     stainless_316l(), ti6al4v(),
                                             alsi10mg(), aluminium(), copper()};
  return metals;
}

std::vector<std::pair<std::string, std::string>> const& material_sources() {
  static std::vector<std::pair<std::string, std::string>> const sources{
      {"Agazhanov 2019", "A. Sh. Agazhanov et al., J. Phys.: Conf. Ser. 1382 (2019) 012175"},
      {"Assael 2006", "M. J. Assael et al., J. Phys. Chem. Ref. Data 35 (2006) 285"},
      {"Assael 2010", "M. J. Assael et al., J. Phys. Chem. Ref. Data 39 (2010) 033105"},
      {"CRC Handbook", "CRC Handbook of Chemistry and Physics, elements"},
      {"Chase 1998", "M. W. Chase, NIST-JANAF Thermochemical Tables, 4th ed. (1998)"},
      {"EN 1706", "EN 1706, aluminium castings, EN AC-43000; as-built values: data sheets of powder makers"},
      {"Gan 2021", "Z. Gan et al., Nat. Commun. 12 (2021) 2379"},
      {"Graves 1991", "R. S. Graves et al., Int. J. Thermophys. 12 (1991) 409 (304L, 300 to 1000 K)"},
      {"Ho 1972", "C. Y. Ho, R. W. Powell, P. E. Liley, J. Phys. Chem. Ref. Data 1 (1972) 279"},
      {"Keene 1993", "B. J. Keene, Int. Mater. Rev. 38 (1993) 157"},
      {"Kim 1975", "C. S. Kim, Thermophysical properties of stainless steels, ANL-75-55 (1975)"},
      {"Lane 2020", "B. Lane et al., Integr. Mater. Manuf. Innov. 9 (2020) 16"},
      {"Leonor 2024", "J. P. Leonor, G. J. Wagner, Comput. Methods Appl. Mech. Eng. 426 (2024) 116977"},
      {"Mills 2002",
       "K. C. Mills, Recommended Values of Thermophysical Properties for Selected Commercial Alloys (2002)"},
      {"Pichler 2020", "P. Pichler et al., J. Mater. Sci. 55 (2020) 4081 (NIST SRM 1155a)"},
      {"Sabau 2020", "A. S. Sabau et al., Metall. Mater. Trans. B 51 (2020) 1263"},
      {"Special Metals 625", "Special Metals, Inconel alloy 625, data sheet SMC-063"},
      {"Wei 2015", "H. L. Wei, J. Mazumder, T. DebRoy, Sci. Rep. 5 (2015) 16446"}};
  return sources;
}

std::vector<std::string> source_names(PropertyRow const& row) {
  std::vector<std::string> names;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 2) {
    end = row.source.find(", ", begin);
    names.push_back(row.source.substr(begin, end - begin));
  }
  return names;
}

}  // namespace layerloop
