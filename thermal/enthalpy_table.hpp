#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/material.hpp"

namespace layerloop::thermal {

/// What the enthalpy per volume of metal h [J/m^3] says about it. h is zero at the ambient temperature.
///
/// h(T) = density (int cp dT + latent heat * liquid fraction), the liquid fraction rising linearly from solidus to
/// liquidus (a jump when both are equal). Conduction uses the integral Theta(T) = int k dT from ambient, so that the
/// flux between two cells, (Theta_1 - Theta_2) / distance, holds the mean of k over their temperatures exactly
/// (Kirchhoff's transformation). Both are tabulated at uniform steps of h: one look-up, no search, no division.
class EnthalpyTable {
 public:
  /// \param top  highest temperature that is tabulated [K]; beyond it the last slope goes on
  EnthalpyTable(Material const& material, double ambient, double top);

  double temperature(double h) const { return interpolate(temperature_, h); }         ///< [K]
  double conductivity_integral(double h) const { return interpolate(integral_, h); }  ///< [W/m]
  double temperature_slope(double h) const { return slope(temperature_, h); }         ///< dT/dh [K m^3/J]
  double integral_slope(double h) const { return slope(integral_, h); }  ///< dTheta/dh: diffusivity [m^2/s]
  double enthalpy(double T) const;  ///< lowest h at which the temperature is reached [J/m^3]

  double solidus() const { return solidus_; }    ///< h where melting begins [J/m^3]
  double liquidus() const { return liquidus_; }  ///< h where it ends [J/m^3]
  /// Of all that is hotter than `from` [J/m^3].
  double max_diffusivity(double from = 0) const {
    return *std::max_element(diffusivity_.begin() + interval(from), diffusivity_.end());
  }
  double max_temperature_slope() const;

 private:
  static constexpr std::int32_t intervals = 16384;

  std::int32_t interval(double h) const {  // std::clamp goes through addresses: loops would not become vectors
    auto const i = static_cast<std::int32_t>(h * per_step_);
    std::int32_t const positive = i > 0 ? i : 0;
    return positive < intervals - 1 ? positive : intervals - 1;
  }
  double interpolate(std::vector<double> const& values, double h) const {
    std::int32_t const i = interval(h);
    double const* const v = values.data();
    return v[i] + (h * per_step_ - i) * (v[i + 1] - v[i]);
  }
  double slope(std::vector<double> const& values, double h) const {
    double const* const v = values.data() + interval(h);
    return (v[1] - v[0]) * per_step_;
  }

  double per_step_ = 0;  ///< 1 / (step of h)
  double solidus_ = 0, liquidus_ = 0;
  std::vector<double> temperature_, integral_, diffusivity_;
};

}  // namespace layerloop::thermal
