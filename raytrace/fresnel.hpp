#pragma once
#include <complex>

namespace layerloop::raytrace {

/// Share of the power that a smooth metal surface reflects, by polarisation.
struct Reflectance {
  double s;  ///< field perpendicular to the plane of incidence
  double p;  ///< field in the plane of incidence

  double average() const { return 0.5 * (s + p); }  ///< unpolarised light
};

/// Fresnel reflectance of a metal of refractive index n + ik in vacuum or gas.
/// \param cosine  of the angle of incidence, in [0, 1]
/// Source: Born & Wolf, Principles of Optics, 7th ed., 14.4.1; in the real form of Siegel & Howell, Thermal Radiation
/// Heat Transfer, which needs no complex root.
Reflectance fresnel_reflectance(std::complex<double> refractive_index, double cosine);

/// Ratio of reflected to incident field, for light whose phase and direction of polarisation are followed.
struct FresnelAmplitudes {
  std::complex<double> s;
  std::complex<double> p;  ///< sign: at normal incidence p = -s (the p direction turns with the ray)
};
FresnelAmplitudes fresnel_amplitudes(std::complex<double> refractive_index, double cosine);

}  // namespace layerloop::raytrace
