#include "core/optical_constants.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"

namespace layerloop {
namespace {

double absorptivity(std::complex<double> N) {
  double const n = N.real(), k = N.imag();
  return 4 * n / ((n + 1) * (n + 1) + k * k);
}

TEST(OpticalConstants, AreThoseOfTheSetsAt1070nm) {
  struct Expected {
    char const* name;
    double n, k, absorptivity;
  };
  // Linear interpolation of the published tables to 1070 nm, and A = 4n / ((n+1)^2 + k^2).
  for (Expected const& e : {Expected{"Fe (Johnson 1974)", 2.961, 4.013, .3725},
                            {"Ti (Johnson 1974)", 3.474, 4.011, .3849},
                            {"Ni (Johnson 1974)", 2.621, 5.864, .2207},
                            {"Mo (Ordal 1988)", 2.284, 4.454, .2983},
                            {"Ta (Ordal 1988)", .949, 5.341, .1174},
                            {"Al (Rakic 1995)", 1.372, 10.314, .0490},
                            {"Cu (Johnson 1972)", .353, 7.08, .0272},
                            {"Cu (Babar 2015)", .089, 7.32, .0065},
                            {"Cu (Ordal 1985)", .558, 7.03, .0430},
                            {"Ag (Johnson 1972)", .040, 7.66, .0027},
                            {"Ag (Babar 2015)", .077, 7.69, .0051},
                            {"Au (Babar 2015)", .105, 6.91, .0086}}) {
    std::complex<double> const N = optical_data(e.name)(1070e-9);
    EXPECT_NEAR(N.real(), e.n, 6e-4) << e.name;
    EXPECT_NEAR(N.imag(), e.k, 6e-3) << e.name;
    EXPECT_NEAR(absorptivity(N), e.absorptivity, 6e-5) << e.name;
  }
}

TEST(OpticalConstants, EverySetIsSoundAndNamesItsPaper) {
  for (OpticalData const& set : optical_data()) {
    EXPECT_NE(set.name.find('('), std::string::npos) << set.name;
    EXPECT_GT(set.source.size(), 10U) << set.name;
    ASSERT_EQ(set.wavelength.size(), set.index.size());
    ASSERT_GE(set.wavelength.size(), 6U) << set.name;
    EXPECT_TRUE(set.covers(1030e-9) && set.covers(1080e-9)) << set.name;
    for (std::size_t i = 0; i < set.index.size(); ++i) {
      EXPECT_GT(set.wavelength[i], i > 0 ? set.wavelength[i - 1] : 0.0) << set.name;
      EXPECT_GT(set.index[i].real(), 0) << set.name;
      EXPECT_GE(set.index[i].imag(), 0) << set.name;
    }
  }
  // Blue and green lasers too, but for the three sets of the infrared.
  for (OpticalData const& set : optical_data()) {
    bool const infrared = set.name.find("Ordal") != std::string::npos;
    EXPECT_EQ(set.covers(450e-9) && set.covers(532e-9), !infrared) << set.name;
  }
}

TEST(OpticalConstants, NothingIsGuessedOutsideATable) {
  try {
    optical_data("Ta (Ordal 1988)")(450e-9);
    FAIL();
  } catch (InputError const& fault) {
    EXPECT_NE(std::string(fault.what()).find("from 0.667 to 1.25 um only"), std::string::npos) << fault.what();
  }
  EXPECT_NO_THROW(optical_data("Ta (Ordal 1988)")(0.667e-6));
  EXPECT_THROW(optical_data("copper"), InputError);
  EXPECT_THROW(optical_data("Cu"), InputError);  // which one?
}

TEST(OpticalConstants, HotMetalAbsorbsMoreByTheDrudeModel) {
  FreeElectrons const& copper = *free_electrons("Cu (Babar 2015)");
  std::complex<double> const cold = optical_data("Cu (Babar 2015)")(1070e-9);
  EXPECT_EQ(heated_index(cold, copper, 1070e-9, 1), cold);  // to the bit
  // A metal that is Drude's through and through stays one: N^2 = 1 - p^2 / (w (w + i g)).
  auto const drude = [&](double damping) {
    double const w = 1 / 1070e-9, p = copper.plasma_wavenumber;
    return std::sqrt(1.0 - p * p / (w * std::complex<double>(w, damping)));
  };
  double const g = copper.damping_wavenumber;
  std::complex<double> const hot = heated_index(drude(g), copper, 1070e-9, 5);
  EXPECT_NEAR(std::abs(hot - drude(5 * g)), 0, 1e-12);
  // Far below the plasma frequency and above the damping, A = 2 g / p: it grows by as much as the resistivity.
  EXPECT_NEAR(absorptivity(drude(5 * g)) / absorptivity(drude(g)), 5, 0.03);
  EXPECT_EQ(free_electrons("Ta (Ordal 1988)"), nullptr);
}

}  // namespace
}  // namespace layerloop
