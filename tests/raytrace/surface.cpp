#include "raytrace/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/error.hpp"
#include "scenes.hpp"

namespace layerloop::raytrace {
namespace {

using Complex = std::complex<double>;

constexpr double wavelength = 1.07e-6;
constexpr Complex aluminium{1.244, 10.0}, alumina{1.75, 0}, lossy{2.4, 0.3};
double const cosines[] = {1.0, 0.9, 0.6, 0.3, 0.1, 0.01, 1e-6};

Surface coated(Complex metal, double thickness, Complex film) {
  return {.refractive_index = metal, .film_thickness = thickness, .film_index = film};
}

void expect_near(Complex found, Complex expected, double tolerance) {
  EXPECT_NEAR(std::abs(found - expected), 0, tolerance) << found << " instead of " << expected;
}

TEST(Surface, AFilmOfNoThicknessIsBareMetalToTheBit) {
  for (double const c : cosines) {
    EXPECT_EQ(reflectance(coated(aluminium, 0, alumina), wavelength, c), fresnel_reflectance(aluminium, c).average());
    EXPECT_EQ(amplitudes(coated(aluminium, 0, alumina), wavelength, c).p, fresnel_amplitudes(aluminium, c).p);
  }
}

TEST(Surface, AFilmOfTheMetalItselfIsBareMetal) {
  for (double const c : cosines) {
    FresnelAmplitudes const bare = fresnel_amplitudes(aluminium, c);
    for (double const thickness : {1e-9, 1e-7, 1e-5}) {
      FresnelAmplitudes const film = amplitudes(coated(aluminium, thickness, aluminium), wavelength, c);
      expect_near(film.s, bare.s, 1e-12);
      expect_near(film.p, bare.p, 1e-12);
    }
  }
}

TEST(Surface, AFilmOfGasIsBareMetalFurtherAway) {
  for (double const c : cosines) {
    EXPECT_NEAR(reflectance(coated(stainless_steel, 2e-7, 1), wavelength, c),
                fresnel_reflectance(stainless_steel, c).average(), 1e-11);
  }
}

TEST(Surface, AQuarterWaveAtNormalIncidenceIsTheClosedForm) {
  // The film turns the admittance N into n1^2 / N.
  for (Complex const below : {Complex(2.25, 0), stainless_steel, aluminium}) {
    double const quarter = wavelength / (4 * alumina.real());
    Complex const r = (alumina * alumina - below) / (alumina * alumina + below);
    EXPECT_NEAR(reflectance(coated(below, quarter, alumina), wavelength, 1), std::norm(r), 1e-12);
    EXPECT_NEAR(reflectance(coated(below, 2 * quarter, alumina), wavelength, 1),
                fresnel_reflectance(below, 1).average(), 1e-12)
        << "half a wave is as if it were not there";
  }
  EXPECT_NEAR(reflectance(coated({2.25, 0}, wavelength / 6, {1.5, 0}), wavelength, 1), 0, 1e-12) << "perfect blooming";
}

TEST(Surface, AnOpaqueFilmHidesTheMetal) {
  for (double const c : cosines) {
    EXPECT_NEAR(reflectance(coated(aluminium, 2e-5, lossy), wavelength, c), fresnel_reflectance(lossy, c).average(),
                1e-12);
  }
}

/// Reflected share by Abeles' characteristic matrix (Born & Wolf, 7th ed., 1.6.2), which knows no multiple reflections.
double matrix_reflectance(Complex metal, double thickness, Complex film, double c, bool s_polarised) {
  auto const q = [&](Complex N) { return std::sqrt(N * N - 1.0 + c * c); };
  auto const admittance = [&](Complex N) { return s_polarised ? q(N) : N * N / q(N); };
  Complex const delta = 2 * std::numbers::pi * thickness / wavelength * q(film), i(0, 1);
  Complex const field = std::cos(delta) - i * std::sin(delta) * admittance(metal) / admittance(film);
  Complex const flow = admittance(metal) * std::cos(delta) - i * std::sin(delta) * admittance(film);
  Complex const outside = admittance(1);
  return std::norm((outside * field - flow) / (outside * field + flow));
}

TEST(Surface, AFilmAtAnyAngleIsItsCharacteristicMatrix) {
  for (Complex const film : {alumina, lossy}) {
    for (double const thickness : {3e-9, 5e-8, 1.3e-7, 4e-7}) {
      for (double const c : cosines) {
        FresnelAmplitudes const r = amplitudes(coated(aluminium, thickness, film), wavelength, c);
        EXPECT_NEAR(std::norm(r.s), matrix_reflectance(aluminium, thickness, film, c, true), 1e-11);
        EXPECT_NEAR(std::norm(r.p), matrix_reflectance(aluminium, thickness, film, c, false), 1e-11);
      }
    }
  }
}

TEST(Surface, ReflectsNoMoreThanFallsOnIt) {
  for (std::uint64_t i = 0; i < 20000; ++i) {
    auto const u = uniform4(11, RandomStream::ray_scatter, i), v = uniform4(12, RandomStream::ray_scatter, i);
    Surface const surface =
        coated({0.01 + 5 * u[0], 10 * u[1] * u[1]}, 1e-6 * u[2] * u[2], {0.1 + 3 * v[0], v[1] < 0.5 ? 0.0 : v[1]});
    for (Surface const& s : {surface, coated(surface.refractive_index, 0, 1)}) {
      double const share = reflectance(s, wavelength, u[3]);
      FresnelAmplitudes const r = amplitudes(s, wavelength, u[3]);
      EXPECT_GE(share, 0);
      EXPECT_LE(std::max({share, std::norm(r.s), std::norm(r.p)}), 1 + 1e-12);
      EXPECT_NEAR(share, 0.5 * (std::norm(r.s) + std::norm(r.p)), 1e-11);
    }
  }
}

TEST(Surface, ReflectsNothingWhereTheIndexIsThatOfGas) {
  for (double const c : cosines) EXPECT_NEAR(reflectance({.refractive_index = black}, wavelength, c), 0, 1e-15);
}

TEST(Surface, SlopeOfTheReflectanceAtNormalIncidenceIsTheClosedForm) {
  // A = 4n / ((n + 1)^2 + k^2)
  double const n = stainless_steel.real(), k = stainless_steel.imag(), d = (n + 1) * (n + 1) + k * k;
  IndexSlope const slope = reflectance_slope({.refractive_index = stainless_steel}, wavelength, 1);
  EXPECT_NEAR(-slope.n, 4 / d - 8 * n * (n + 1) / (d * d), 1e-14);
  EXPECT_NEAR(-slope.k, -8 * n * k / (d * d), 1e-14);
}

TEST(Surface, SlopesAreDifferenceQuotients) {
  double const h = 1e-5;
  for (double const thickness : {0.0, 1e-7}) {
    for (double const c : {1.0, 0.7, 0.2}) {
      auto const share = [&](Complex N) { return reflectance(coated(N, thickness, lossy), wavelength, c); };
      auto const field = [&](Complex N) { return amplitudes(coated(N, thickness, lossy), wavelength, c); };
      Complex const N = stainless_steel;
      IndexSlope const slope = reflectance_slope(coated(N, thickness, lossy), wavelength, c);
      EXPECT_NEAR(slope.n, (share(N + h) - share(N - h)) / (2 * h), 1e-9);
      EXPECT_NEAR(slope.k, (share(N + Complex(0, h)) - share(N - Complex(0, h))) / (2 * h), 1e-9);
      FresnelAmplitudes const by_index = amplitude_slopes(coated(N, thickness, lossy), wavelength, c);
      expect_near(by_index.s, (field(N + h).s - field(N - h).s) / (2 * h), 1e-9);
      expect_near(by_index.p, (field(N + h).p - field(N - h).p) / (2 * h), 1e-9);
    }
  }
}

TEST(Surface, RefusesWhatCannotBe) {
  auto const check = [](Surface const& surface, double at) {
    OpticalSet const set{"x", {surface}, at};
    check_surfaces({&set, 1}, 1);
  };
  EXPECT_NO_THROW(check(coated(aluminium, 1e-8, alumina), wavelength));
  EXPECT_THROW(check(coated(aluminium, 1e-8, alumina), 0), InputError) << "no wavelength";
  EXPECT_THROW(check(coated(aluminium, -1e-8, alumina), wavelength), InputError);
  EXPECT_THROW(check(coated(aluminium, 1e-8, {1.75, -1}), wavelength), InputError);
  EXPECT_THROW(check({.refractive_index = {std::nan(""), 1}}, wavelength), InputError);
  EXPECT_THROW(check({.refractive_index = {3, -1}}, wavelength), InputError) << "k has the other sign here";
  EXPECT_THROW(check({.refractive_index = 1, .grey_reflectance = 1.1}, wavelength), InputError);
  EXPECT_THROW(check_surfaces({}, 1), InputError);
  OpticalSet const one{"", {{.refractive_index = aluminium}}, 0};
  EXPECT_THROW(check_surfaces({&one, 1}, 2), InputError) << "two materials, one surface";
}

}  // namespace
}  // namespace layerloop::raytrace
