#pragma once
#include <complex>

namespace layerloop::raytrace {

/// Share of the power that a smooth surface reflects, by polarisation.
struct Reflectance {
  double s;  ///< field perpendicular to the plane of incidence
  double p;  ///< field in the plane of incidence

  double average() const { return 0.5 * (s + p); }  ///< unpolarised light
};

/// Fresnel reflectance of a half-space of refractive index n + ik in vacuum or gas.
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

/// Derivatives of the amplitudes with respect to the complex index N = n + ik. They are analytic functions of N:
/// d/dn is this, d/dk is i times this.
FresnelAmplitudes fresnel_slopes(std::complex<double> refractive_index, double cosine);

/// A plane film, transparent or absorbing, between gas and metal.
struct Film {
  std::complex<double> refractive_index;
  double phase_thickness;  ///< 2 pi times thickness over the wavelength in vacuum
};

/// Amplitudes of metal under a film: the coherent sum over all reflections in it.
/// Source: Born & Wolf, Principles of Optics, 7th ed., 1.6.4 (57) with complex indices.
FresnelAmplitudes film_amplitudes(Film const& film, std::complex<double> refractive_index, double cosine);

/// Their derivatives with respect to the index of the metal.
FresnelAmplitudes film_slopes(Film const& film, std::complex<double> refractive_index, double cosine);

}  // namespace layerloop::raytrace
