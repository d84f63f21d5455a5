#include "raytrace/fresnel.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::raytrace {
namespace {

using Complex = std::complex<double>;

constexpr double grazing = 1e-12;  ///< exactly grazing light on n = 1 would be 0/0

/// Light of a given angle of incidence inside a medium.
struct Medium {
  Medium(Complex index, double cosine)
      : refractive_index(index), permittivity(index * index), q(std::sqrt(permittivity - 1.0 + cosine * cosine)) {}

  Complex refractive_index, permittivity;
  Complex q;  ///< sqrt(N^2 - sin^2): N times the cosine in the medium
};

FresnelAmplitudes interface_amplitudes(Medium const& a, Medium const& b) {
  Complex const from = b.permittivity * a.q, to = a.permittivity * b.q;
  return {(a.q - b.q) / (a.q + b.q), (from - to) / (from + to)};
}

/// d/dN_b, from dq/dN = N/q.
FresnelAmplitudes interface_slopes(Medium const& a, Medium const& b) {
  Complex const dq = b.refractive_index / b.q, sum_s = a.q + b.q;
  Complex const sum_p = b.permittivity * a.q + a.permittivity * b.q;
  return {-2.0 * a.q * dq / (sum_s * sum_s),
          2.0 * a.permittivity * a.q * (2.0 * b.refractive_index * b.q - b.permittivity * dq) / (sum_p * sum_p)};
}

}  // namespace

Reflectance fresnel_reflectance(Complex refractive_index, double cosine) {
  double const n = refractive_index.real(), k = refractive_index.imag();
  double const c = std::clamp(cosine, grazing, 1.0);
  double const sine2 = 1 - c * c;

  // q = a + ib = sqrt(N^2 - sin^2); the larger part first, the other from ab = nk, which does not cancel
  double const real = (n - 1) * (n + 1) - k * k + c * c;
  double const modulus = std::sqrt(real * real + 4 * n * n * k * k);  // a^2 + b^2
  double const larger = std::sqrt(0.5 * (modulus + std::abs(real)));
  double const a = real >= 0 ? larger : n * k / larger;

  double const s = std::max(modulus - 2 * a * c + c * c, 0.0) / (modulus + 2 * a * c + c * c);
  double const even = modulus * c * c + sine2 * sine2, odd = 2 * a * c * sine2;
  double const p = s * std::max(even - odd, 0.0) / (even + odd);
  return {s, p};
}

FresnelAmplitudes fresnel_amplitudes(Complex refractive_index, double cosine) {
  double const c = std::clamp(cosine, grazing, 1.0);
  return interface_amplitudes({1, c}, {refractive_index, c});
}

FresnelAmplitudes fresnel_slopes(Complex refractive_index, double cosine) {
  double const c = std::clamp(cosine, grazing, 1.0);
  return interface_slopes({1, c}, {refractive_index, c});
}

FresnelAmplitudes film_amplitudes(Film const& film, Complex refractive_index, double cosine) {
  double const c = std::clamp(cosine, grazing, 1.0);
  Medium const coat(film.refractive_index, c);
  FresnelAmplitudes const top = interface_amplitudes({1, c}, coat),
                          bottom = interface_amplitudes(coat, {refractive_index, c});
  Complex const there_and_back = std::exp(Complex(0, 2 * film.phase_thickness) * coat.q);
  auto const sum = [&](Complex r, Complex below) {
    return (r + below * there_and_back) / (1.0 + r * below * there_and_back);
  };
  return {sum(top.s, bottom.s), sum(top.p, bottom.p)};
}

FresnelAmplitudes film_slopes(Film const& film, Complex refractive_index, double cosine) {
  double const c = std::clamp(cosine, grazing, 1.0);
  Medium const coat(film.refractive_index, c), metal(refractive_index, c);
  FresnelAmplitudes const top = interface_amplitudes({1, c}, coat), bottom = interface_amplitudes(coat, metal),
                          slope = interface_slopes(coat, metal);
  Complex const there_and_back = std::exp(Complex(0, 2 * film.phase_thickness) * coat.q);
  auto const passed = [&](Complex r, Complex below, Complex below_slope) {
    Complex const denominator = 1.0 + r * below * there_and_back;
    return there_and_back * (1.0 - r * r) / (denominator * denominator) * below_slope;
  };
  return {passed(top.s, bottom.s, slope.s), passed(top.p, bottom.p, slope.p)};
}

}  // namespace layerloop::raytrace
