#include "raytrace/fresnel.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::raytrace {

Reflectance fresnel_reflectance(std::complex<double> refractive_index, double cosine) {
  double const n = refractive_index.real(), k = refractive_index.imag();
  double const c = std::clamp(cosine, 1e-12, 1.0);  // exactly grazing light on n = 1 would be 0/0
  double const sine2 = 1 - c * c;

  // q = a + ib = sqrt(N^2 - sin^2)
  double const real = n * n - k * k - sine2;
  double const modulus = std::sqrt(real * real + 4 * n * n * k * k);  // a^2 + b^2
  double const a = std::sqrt(std::max(0.5 * (modulus + real), 0.0));

  double const s = (modulus - 2 * a * c + c * c) / (modulus + 2 * a * c + c * c);
  double const even = modulus * c * c + sine2 * sine2, odd = 2 * a * c * sine2;
  double const p = s * (even - odd) / (even + odd);
  return {s, p};
}

FresnelAmplitudes fresnel_amplitudes(std::complex<double> refractive_index, double cosine) {
  double const c = std::clamp(cosine, 1e-12, 1.0);
  std::complex<double> const permittivity = refractive_index * refractive_index;
  std::complex<double> const q = std::sqrt(permittivity - (1 - c * c));
  return {(c - q) / (c + q), (permittivity * c - q) / (permittivity * c + q)};
}

}  // namespace layerloop::raytrace
