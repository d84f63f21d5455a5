#include "raytrace/surface.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace layerloop::raytrace {
namespace {

Film film_on(Surface const& surface, double wavelength) {
  return {surface.film_index, 2 * std::numbers::pi * surface.film_thickness / wavelength};
}

void check_surface(Surface const& surface, OpticalSet const& set) {
  auto const exists = [](std::complex<double> N) {
    return N.real() > 0 && N.imag() >= 0 && std::isfinite(std::abs(N));
  };
  auto const fail = [&](std::string const& problem, char const* remedy) {
    throw InputError(problem + (set.name.empty() ? "" : " in optical set \"" + set.name + "\"") + ": " + remedy);
  };
  if (surface.grey_reflectance) {
    double const grey = *surface.grey_reflectance;
    if (!(grey >= 0 && grey <= 1))
      fail(fmt::format("a grey reflectance of {:g} cannot be (it is a share of the power, 0 to 1)", grey),
           "check optics.grey_reflectance");
    return;
  }
  std::complex<double> const N = surface.refractive_index, film = surface.film_index;
  if (!exists(N))
    fail(fmt::format("refractive index {:g} + {:g}i is not that of a metal (n > 0, k >= 0)", N.real(), N.imag()),
         "check optics.refractive_index");
  if (surface.film_thickness == 0) return;
  if (!(surface.film_thickness > 0 && std::isfinite(surface.film_thickness) && exists(film)))
    fail(fmt::format("a film of {:g} m and index {:g} + {:g}i cannot be (thickness >= 0, n > 0, k >= 0)",
                     surface.film_thickness, film.real(), film.imag()),
         "check optics.oxide_thickness");
  if (!(set.wavelength > 0)) fail("a film has no wavelength to be held against", "set laser.wavelength");
}

}  // namespace

double reflectance(Surface const& surface, double wavelength, double cosine) {
  if (surface.grey_reflectance) return *surface.grey_reflectance;
  if (surface.film_thickness == 0) return fresnel_reflectance(surface.refractive_index, cosine).average();
  FresnelAmplitudes const r = film_amplitudes(film_on(surface, wavelength), surface.refractive_index, cosine);
  return 0.5 * (std::norm(r.s) + std::norm(r.p));
}

FresnelAmplitudes amplitudes(Surface const& surface, double wavelength, double cosine) {
  if (surface.grey_reflectance) {
    double const amplitude = std::sqrt(*surface.grey_reflectance);
    return {-amplitude, amplitude};
  }
  if (surface.film_thickness == 0) return fresnel_amplitudes(surface.refractive_index, cosine);
  return film_amplitudes(film_on(surface, wavelength), surface.refractive_index, cosine);
}

FresnelAmplitudes amplitude_slopes(Surface const& surface, double wavelength, double cosine) {
  if (surface.grey_reflectance) return {0, 0};
  if (surface.film_thickness == 0) return fresnel_slopes(surface.refractive_index, cosine);
  return film_slopes(film_on(surface, wavelength), surface.refractive_index, cosine);
}

IndexSlope reflectance_slope(Surface const& surface, double wavelength, double cosine) {
  FresnelAmplitudes const r = amplitudes(surface, wavelength, cosine),
                          slope = amplitude_slopes(surface, wavelength, cosine);
  // d|r|^2 = 2 Re(conj(r) dr), averaged over s and p; dr/dk = i dr/dn.
  std::complex<double> const change = std::conj(r.s) * slope.s + std::conj(r.p) * slope.p;
  return {change.real(), -change.imag()};
}

void check_surfaces(std::span<OpticalSet const> sets, std::size_t materials) {
  if (sets.empty()) throw InputError("there is no optical set to trace: name the metals of bed and substrate");
  for (OpticalSet const& set : sets) {
    if (set.surface.size() < materials || set.surface.size() != sets[0].surface.size()) {
      throw InputError(fmt::format(
          "material {} has no refractive index ({} are given): name one for every material of bed and substrate",
          materials - 1, set.surface.size()));
    }
    for (Surface const& surface : set.surface) check_surface(surface, set);
  }
}

}  // namespace layerloop::raytrace
