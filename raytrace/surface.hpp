#pragma once
#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "raytrace/fresnel.hpp"

namespace layerloop::raytrace {

/// How one material reflects at one wavelength and temperature. What is not reflected counts as absorbed, also what a
/// transparent material (k = 0) would let through.
struct Surface {
  std::complex<double> refractive_index;     ///< n + ik, n > 0, k >= 0
  double film_thickness = 0;                 ///< of a transparent or absorbing film on it, such as oxide [m]
  std::complex<double> film_index{1, 0};     ///< n + ik of the film
  std::optional<double> grey_reflectance{};  ///< the same at any angle and polarisation; replaces the index
};

/// Surfaces of all materials under one light: several sets can share the paths of one trace.
struct OpticalSet {
  std::string name;
  std::vector<Surface> surface;  ///< by material
  double wavelength = 0;         ///< in vacuum [m]; only films need it
};

/// Share of unpolarised power that is reflected. \param cosine  of the angle of incidence
double reflectance(Surface const& surface, double wavelength, double cosine);

/// Ratio of reflected to incident field. A grey surface turns the phase as a perfect conductor does.
FresnelAmplitudes amplitudes(Surface const& surface, double wavelength, double cosine);

/// Derivative of the amplitudes with respect to the complex index of the metal; zero where it is grey.
FresnelAmplitudes amplitude_slopes(Surface const& surface, double wavelength, double cosine);

/// Derivatives of a power with respect to the two parts of a refractive index.
struct IndexSlope {
  double n = 0, k = 0;
};

/// Of the reflectance, with respect to the index of the metal.
IndexSlope reflectance_slope(Surface const& surface, double wavelength, double cosine);

/// \throws InputError  no set, a surface that cannot exist, sets of different length, or materials without a surface
void check_surfaces(std::span<OpticalSet const> sets, std::size_t materials);

}  // namespace layerloop::raytrace
