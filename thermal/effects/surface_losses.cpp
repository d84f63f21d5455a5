#include "thermal/effects/surface_losses.hpp"

namespace layerloop::thermal {
namespace {
constexpr double stefan_boltzmann = 5.670374419e-8;  // [W/(m^2 K^4)]
}

SurfaceLosses::SurfaceLosses(Material const& material, double ambient, double convection, double strength)
    : ambient_(ambient),
      radiation_(strength * material.emissivity * stefan_boltzmann),
      convection_(strength * convection) {}

double SurfaceLosses::flux(double T) const {
  double const T2 = T * T, ambient2 = ambient_ * ambient_;
  return radiation_ * (T2 + ambient2) * (T2 - ambient2) + convection_ * (T - ambient_);
}

double SurfaceLosses::slope(double T) const { return 4 * radiation_ * T * T * T + convection_; }

}  // namespace layerloop::thermal
