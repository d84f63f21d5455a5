#include "thermal/enthalpy_table.hpp"

#include <cmath>

namespace layerloop::thermal {
namespace {

/// Points of the exact relation: between them cp and k are linear in T.
struct Curve {
  std::vector<double> h, T, theta;
};

/// Temperatures where a property bends, and every kelvin between: h(T) bends by less than 1e-6 of itself in between.
std::vector<double> knots(Material const& m, double ambient, double top) {
  std::vector<double> T;
  for (double t = ambient; t < top; t += 1) T.push_back(t);
  T.push_back(top);
  for (auto const* table : {&m.conductivity, &m.specific_heat}) {
    T.insert(T.end(), table->temperature.begin(), table->temperature.end());
  }
  T.insert(T.end(), {m.solidus, m.liquidus});
  std::erase_if(T, [&](double t) { return t < ambient || t > top; });
  std::sort(T.begin(), T.end());
  T.erase(std::unique(T.begin(), T.end()), T.end());
  return T;
}

Curve exact_curve(Material const& m, double ambient, double top) {
  std::vector<double> const T = knots(m, ambient, top);
  Curve curve{{0}, {ambient}, {0}};
  auto const add = [&](double dh, double t, double dtheta) {
    curve.h.push_back(curve.h.back() + dh);
    curve.T.push_back(t);
    curve.theta.push_back(curve.theta.back() + dtheta);
  };
  bool const jump = m.liquidus <= m.solidus;
  for (std::size_t i = 1; i < T.size(); ++i) {
    double const dT = T[i] - T[i - 1];
    double dh = m.density * dT * 0.5 * (m.specific_heat(T[i - 1]) + m.specific_heat(T[i]));
    if (!jump && T[i - 1] >= m.solidus && T[i] <= m.liquidus) {
      dh += m.density * m.latent_heat * dT / (m.liquidus - m.solidus);
    }
    add(dh, T[i], dT * 0.5 * (m.conductivity(T[i - 1]) + m.conductivity(T[i])));
    if (jump && T[i] == m.solidus && m.latent_heat > 0) add(m.density * m.latent_heat, T[i], 0);
  }
  return curve;
}

/// Linear interpolation along one column of the curve. \pre h ascending
double along(std::vector<double> const& h, std::vector<double> const& value, double at) {
  auto const above = std::clamp<std::ptrdiff_t>(std::upper_bound(h.begin(), h.end(), at) - h.begin(), 1,
                                                static_cast<std::ptrdiff_t>(h.size()) - 1);
  auto const i = static_cast<std::size_t>(above);
  return value[i - 1] + (value[i] - value[i - 1]) * (at - h[i - 1]) / (h[i] - h[i - 1]);
}

}  // namespace

EnthalpyTable::EnthalpyTable(Material const& m, double ambient, double top) {
  Curve const curve = exact_curve(m, ambient, top);
  double const step = curve.h.back() / intervals;
  per_step_ = 1 / step;
  temperature_.resize(intervals + 1);
  integral_.resize(intervals + 1);
  for (std::size_t i = 0; i < temperature_.size(); ++i) {
    temperature_[i] = along(curve.h, curve.T, static_cast<double>(i) * step);
    integral_[i] = along(curve.h, curve.theta, static_cast<double>(i) * step);
  }
  diffusivity_.resize(intervals);
  for (std::size_t i = 0; i < diffusivity_.size(); ++i) diffusivity_[i] = (integral_[i + 1] - integral_[i]) * per_step_;

  auto const first = std::lower_bound(curve.T.begin(), curve.T.end(), m.solidus) - curve.T.begin();
  auto const last = std::upper_bound(curve.T.begin(), curve.T.end(), m.liquidus) - curve.T.begin() - 1;
  solidus_ = curve.h[static_cast<std::size_t>(first)];
  liquidus_ = curve.h[static_cast<std::size_t>(last)];
}

double EnthalpyTable::enthalpy(double T) const {
  auto const above = std::clamp<std::ptrdiff_t>(
      std::lower_bound(temperature_.begin(), temperature_.end(), T) - temperature_.begin(), 1, intervals);
  auto const i = static_cast<std::size_t>(above);
  return (static_cast<double>(i - 1) + (T - temperature_[i - 1]) / (temperature_[i] - temperature_[i - 1])) / per_step_;
}

double EnthalpyTable::max_temperature_slope() const {
  double largest = 0;
  for (std::size_t i = 0; i + 1 < temperature_.size(); ++i) {
    largest = std::max(largest, (temperature_[i + 1] - temperature_[i]) * per_step_);
  }
  return largest;
}

}  // namespace layerloop::thermal
