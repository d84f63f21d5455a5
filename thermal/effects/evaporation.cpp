#include "thermal/effects/evaporation.hpp"

#include <cmath>
#include <numbers>

namespace layerloop::thermal {
namespace {
constexpr double gas_constant = 8.314462618;  // [J/(mol K)]
constexpr double atmosphere = 101325;         // [Pa]
constexpr double net_share = 0.82;
}  // namespace

Evaporation::Evaporation(Material const& m, double strength)
    : heat_(m.heat_of_vaporisation),
      boiling_(m.boiling_point),
      onset_(m.heat_of_vaporisation * m.molar_mass / gas_constant),
      factor_(strength * net_share * m.heat_of_vaporisation * atmosphere *
              std::sqrt(m.molar_mass / (2 * std::numbers::pi * gas_constant))) {}

double Evaporation::flux(double T) const { return factor_ * std::exp(onset_ * (1 / boiling_ - 1 / T)) / std::sqrt(T); }

double Evaporation::slope(double T, double flux_at_T) const { return flux_at_T * (onset_ / T - 0.5) / T; }

}  // namespace layerloop::thermal
