#include "thermal/effects/powder_conductivity.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/effect_catalogue.hpp"

namespace layerloop::thermal {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double stefan_boltzmann = 5.670374419e-8;  // [W/(m^2 K^4)]
constexpr double gas_constant = 8.314462618;         // [J/(mol K)]

struct GasData {
  double conductivity, exponent;  ///< at 300 K [W/(m K)]; over temperature
  double molar_mass;              ///< [kg/mol]
  double heat_capacity;           ///< at constant pressure, in gas constants
};

GasData const& data_of(Gas gas) {
  static GasData const argon{0.0177, 0.735, 0.039948, 2.5}, nitrogen{0.0259, 0.77, 0.028013, 3.5},
      helium{0.1557, 0.69, 0.0040026, 2.5};
  return gas == Gas::helium ? helium : gas == Gas::nitrogen ? nitrogen : argon;
}

/// Radius [m] of the sphere that holds as much metal as each grain.
std::map<std::int32_t, double> radii(HeatCells const& cells) {
  std::map<std::int32_t, double> radius;
  for (std::size_t c = 0; c < cells.fill.size(); ++c)
    if (cells.body[c] >= 0) radius[cells.body[c]] += cells.fill[c];
  for (auto& [body, r] : radius) r = std::cbrt(0.75 / pi * r) * cells.grid.cell;
  return radius;
}

/// Area of the faces at which two bodies meet, in faces of a cell.
std::map<ContactLaw::Pair, double> meeting_faces(HeatCells const& cells) {
  std::map<ContactLaw::Pair, double> faces;
  for (std::int64_t c = 0; c < cells.grid.size(); ++c) {
    auto const at = static_cast<std::size_t>(c);
    if (cells.fill[at] == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      std::int64_t const neighbour = cells.neighbour(cells.grid.coordinates(c), axis, 1);
      if (neighbour < 0 || neighbour == c) continue;
      auto const next = static_cast<std::size_t>(neighbour);
      if (cells.fill[next] == 0 || cells.body[at] == cells.body[next]) continue;
      faces[std::minmax(cells.body[at], cells.body[next])] += std::min(1.0, 0.5 * (cells.fill[at] + cells.fill[next]));
    }
  }
  return faces;
}

}  // namespace

GapGas gap_gas(HeatSettings const& settings, double accommodation, double emissivity, double temperature) {
  GasData const& data = data_of(settings.gas);
  double const specific = gas_constant / data.molar_mass;
  GapGas gas;
  gas.conductivity = data.conductivity * std::pow(temperature / 300, data.exponent);
  gas.jump = (2 - accommodation) / accommodation * std::sqrt(2 * pi * specific * temperature) * gas.conductivity /
             (settings.gas_pressure * specific * (2 * data.heat_capacity - 1));
  gas.radiation = emissivity > 0 ? 4 * stefan_boltzmann * std::pow(temperature, 3) / (2 / emissivity - 1) : 0;
  return gas;
}

double touching_grains(double solid, GapGas const& gas, double diameter, double shape) {
  double const end = 1 + 2 * gas.jump / diameter, fall = 1 - gas.conductivity / solid;
  auto const line = [&](double u) { return 2 * u / (end - fall * shape * u / (1 + (shape - 1) * u)); };
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(line, 0.0, 1.0, 15, 1e-10);
}

double shape_in_bed(double porosity) { return 1.25 * std::pow((1 - porosity) / porosity, 10.0 / 9); }

double bed_conductivity(double porosity, double diameter, double solid, GapGas const& gas, double shape) {
  double const s = std::sqrt(1 - porosity), radiation = gas.radiation * diameter / gas.conductivity;
  return gas.conductivity *
         ((1 - s) * (1 + porosity * radiation) + s * (touching_grains(solid, gas, diameter, shape) + radiation));
}

ContactLaw contact_law(HeatCells const& cells, HeatSettings const& settings, Material const& metal,
                       Effects const& effects) {
  double const constant = settings.powder_contact_conductivity;
  double const strength = effect_strength(effects, "powder_conductivity");
  ContactLaw contacts(constant);
  if (strength == 0) return contacts;

  double const temperature = 0.5 * (settings.ambient_temperature + metal.solidus);
  double const solid = metal.conductivity(temperature);
  GapGas const gas = gap_gas(settings, effect_parameter(effects, "powder_conductivity", "accommodation"),
                             metal.emissivity, temperature);
  std::map<std::int32_t, double> const radius = radii(cells);
  for (auto const& [pair, faces] : meeting_faces(cells)) {
    auto const curvature = [&](std::int32_t body) { return body < 0 ? 0.0 : 1 / radius.at(body); };
    double const r = 2 / (curvature(pair.first) + curvature(pair.second));
    double const core = touching_grains(solid, gas, 2 * r) * gas.conductivity + gas.radiation * 2 * r;
    double const law = 0.5 * pi * r * core / (faces * cells.grid.cell);
    contacts.of_pair[pair] = (1 - strength) * constant + strength * law;
  }
  return contacts;
}

}  // namespace layerloop::thermal
