#include "raytrace/fresnel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes.hpp"

namespace layerloop::raytrace {
namespace {

double cosine_of(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

TEST(Fresnel, AbsorptivityOfSteelAtFourAngles) {
  // 1 - |r|^2 with rs = (c - q)/(c + q), rp = (N^2 c - q)/(N^2 c + q), q = sqrt(N^2 - sin^2), worked out in 30 digits.
  struct {
    double angle, s, p;
  } const expected[] = {{0, .34148, .34148}, {30, .30302, .38292}, {60, .18738, .55418}, {80, .06940, .75075}};
  for (auto const& e : expected) {
    Reflectance const r = fresnel_reflectance(stainless_steel, cosine_of(e.angle));
    EXPECT_NEAR(1 - r.s, e.s, 6e-6) << e.angle;
    EXPECT_NEAR(1 - r.p, e.p, 6e-6) << e.angle;
  }
}

TEST(Fresnel, NormalIncidenceOfMetalsIsTheClosedForm) {
  for (std::complex<double> const metal : {stainless_steel, silver, std::complex<double>(1.244, 10.0)}) {
    double const n = metal.real(), k = metal.imag();
    EXPECT_NEAR(1 - fresnel_reflectance(metal, 1).average(), 4 * n / ((n + 1) * (n + 1) + k * k), 1e-13);
  }
}

TEST(Fresnel, GrazingLightIsReflected) {
  for (std::complex<double> const metal : {stainless_steel, silver}) {
    EXPECT_NEAR(fresnel_reflectance(metal, 0).s, 1, 1e-9);
    EXPECT_NEAR(fresnel_reflectance(metal, 0).p, 1, 1e-9);
  }
}

TEST(Fresnel, SilverAtEightyDegreesIsNotInflated) {
  EXPECT_NEAR(1 - fresnel_reflectance(silver, cosine_of(80)).average(), .033, 5e-4);
}

TEST(Fresnel, GlassAtBrewstersAngleReflectsNoP) {
  double const n = 1.5;
  EXPECT_NEAR(fresnel_reflectance({n, 0}, 1 / std::sqrt(1 + n * n)).p, 0, 1e-14);
}

TEST(Fresnel, AmplitudesSquareToReflectances) {
  for (double angle = 0; angle < 90; angle += 3.7) {
    Reflectance const r = fresnel_reflectance(stainless_steel, cosine_of(angle));
    FresnelAmplitudes const a = fresnel_amplitudes(stainless_steel, cosine_of(angle));
    EXPECT_NEAR(std::norm(a.s), r.s, 1e-13) << angle;
    EXPECT_NEAR(std::norm(a.p), r.p, 1e-13) << angle;
  }
  FresnelAmplitudes const normal = fresnel_amplitudes(stainless_steel, 1);
  EXPECT_NEAR(std::abs(normal.p + normal.s), 0, 1e-14);
}

}  // namespace
}  // namespace layerloop::raytrace
