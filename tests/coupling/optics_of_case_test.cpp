#include "coupling/optics_of_case.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/optical_constants.hpp"
#include "coupling/absorption_study.hpp"

namespace layerloop::coupling {
namespace {

/// A case for a bed that is there already.
Case case_with(std::vector<std::string> const& settings, std::string const& metal = "316L") {
  std::string const text =
      "[powder]\nmaterial = \"" + metal +
      "\"\n[laser]\nwavelength = \"1070 nm\"\n[optics]\nuniform_beam = true\n[absorb]\nbed = \"file\"\n";
  return case_of_text(text, "test", settings, Process::absorbing);
}

double flat(Case const& checked, std::size_t surface = 0) {
  raytrace::OpticalSet const set = optical_set(checked);
  return 1 - raytrace::reflectance(set.surface.at(surface), set.wavelength, 1);
}

TEST(OpticsOfCase, WavelengthPicksTheIndex) {
  EXPECT_NEAR(flat(case_with({})), .3725, 5e-5);  // iron at 1070 nm
  Case const green = with_wavelength(case_with({}), 521e-9);
  EXPECT_EQ(optical_set(green).surface[0].refractive_index, std::complex<double>(2.86, 2.91));  // a row of the table
  EXPECT_EQ(flat(case_with({"laser.wavelength=521 nm"})), flat(green));
  EXPECT_THROW(with_wavelength(case_with({}), 10.6e-6), InputError);
  EXPECT_THROW(with_wavelength(case_with({"optics.refractive_index=[3, 4]"}), 521e-9), InputError);
}

TEST(OpticsOfCase, SourceIsNamedAndBorrowingSaid) {
  EXPECT_NE(optical_source(case_with({}).material).find("Fe (Johnson 1974)"), std::string::npos);
  EXPECT_NE(optical_source(case_with({}).material).find("borrowed"), std::string::npos);
  EXPECT_EQ(optical_source(case_with({}, "Cu").material).find("borrowed"), std::string::npos);
  EXPECT_EQ(optical_source(case_with({"optics.refractive_index=[3, 4]"}).material), "given with the case");
  Case const other = case_with({"material.Cu.optical_data=Cu (Babar 2015)"}, "Cu");
  EXPECT_NEAR(flat(other), .0065, 6e-5);
}

TEST(OpticsOfCase, PowderOfAnotherMetalKeepsThePlaces) {
  Case const steel = case_with({"optics.floor=Al"});
  Case const copper = with_powder_of(steel, "Cu (Ordal 1985)");
  EXPECT_NEAR(flat(copper), .0430, 5e-5);
  EXPECT_NEAR(flat(copper, 1), .0490, 5e-5);
  EXPECT_EQ(surface_names(copper), surface_names(steel));
  EXPECT_NEAR(flat(with_powder_of(steel, "Al")), .0490, 5e-5);
  EXPECT_EQ(optical_set(with_powder_of(steel, "Al")).surface.size(), 2U);
  EXPECT_THROW(with_powder_of(steel, "Cu (Nobody 1900)"), InputError);
}

TEST(OpticsOfCase, FloorIsWhatIsAskedFor) {
  EXPECT_EQ(floor_index(case_with({})), 0);
  EXPECT_EQ(floor_index(case_with({"optics.floor=316L"})), 0);
  Case const black = case_with({"optics.floor=black"});
  EXPECT_EQ(floor_index(black), 1);
  EXPECT_EQ(flat(black, 1), 1);
  EXPECT_THROW(case_with({"optics.floor=wood"}), InputError);
}

TEST(OpticsOfCase, EffectsAtTheirNullValueChangeNoBit) {
  raytrace::OpticalSet const bare = optical_set(case_with({}));
  for (std::vector<std::string> const& settings :
       {std::vector<std::string>{"optics.oxide_thickness=50 nm", "effects.surface_oxide.strength=0"},
        {"optics.oxide_thickness=50 nm", "effects.surface_oxide.enabled=false"},
        {"optics.temperature=1500", "effects.optical_temperature.strength=0"},
        {"optics.temperature=300"},
        {"optics.diffuse_share=0.3", "effects.diffuse_scattering.strength=0"}}) {
    Case const checked = case_with(settings);
    raytrace::Surface const surface = optical_set(checked).surface[0];
    EXPECT_EQ(surface.refractive_index, bare.surface[0].refractive_index);
    EXPECT_EQ(surface.film_thickness, 0);
    EXPECT_EQ(diffuse_share(checked), 0);
  }
}

TEST(OpticsOfCase, OxideIsTheMetalsOwn) {
  Case const film = case_with({"optics.oxide_thickness=40 nm", "effects.surface_oxide.strength=0.5"}, "Al");
  raytrace::Surface const surface = optical_set(film).surface[0];
  EXPECT_DOUBLE_EQ(surface.film_thickness, 20e-9);
  EXPECT_NEAR(surface.film_index.real(), 1.7544, 5e-4);  // sapphire at 1070 nm
  EXPECT_THROW(optical_set(case_with({"optics.oxide_thickness=40 nm"}, "Cu")), InputError);
  Case const given = case_with({"optics.oxide_thickness=40 nm", "optics.oxide_index=[2.6, 0.4]"}, "Cu");
  EXPECT_EQ(optical_set(given).surface[0].film_index, std::complex<double>(2.6, 0.4));
}

TEST(OpticsOfCase, HotCopperFollowsItsResistivity) {
  // Wiedemann and Franz: resistivity ratio = T / conductivity(T) over that at 300 K, at 1200 K 4 * 401 / 345.9.
  Case const hot = case_with({"optics.temperature=1200"}, "Cu");
  double const ratio = 4 * 401.0 / hot.material.conductivity(1200);
  auto const expected =
      heated_index(hot.material.refractive_index, *free_electrons("Cu (Johnson 1972)"), 1070e-9, ratio);
  EXPECT_EQ(optical_set(hot).surface[0].refractive_index, expected);
  EXPECT_GT(flat(hot), flat(case_with({}, "Cu")));
}

TEST(AbsorptionFigure, RaysAndBedsAreToldApart) {
  // Spread of the values .01 (sd), of which the rays' errors of .006 explain .006: the beds differ by .008.
  std::vector<double> const values{.49, .5, .51};
  AbsorptionFigure const a = figure_over_beds(values, {.006, .006, .006});
  EXPECT_NEAR(a.value, .5, 1e-12);
  EXPECT_NEAR(a.sd_bed, std::sqrt(.01 * .01 - .006 * .006), 1e-12);
  EXPECT_NEAR(a.standard_error, .006 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(a.u_bed, 4.3027 * .01 / std::sqrt(3.0), 1e-5);
  EXPECT_EQ(figure_over_beds({.5}, {.01}).n, 1);
}

TEST(LitBed, SpotTakesTheCasesShape) {
  Case const checked = case_with({"optics.uniform_beam=false", "laser.spot_diameter=100 um",
                                  "laser.spot_definition=1/e2", "laser.focus_offset=3 mm", "laser.rayleigh_length=3 mm",
                                  "laser.polarisation=s", "laser.incidence_angle=30 deg"});
  raytrace::Beam const beam = spot_beam(checked.laser, Vec3(1, 2, 3), 5);
  EXPECT_NEAR(beam.radius, std::sqrt(2.0) * 50e-6, 1e-18);
  EXPECT_NEAR(1 / beam.front_curvature, 6e-3, 1e-15);
  EXPECT_EQ(beam.polarisation, raytrace::BeamPolarisation::s);
  EXPECT_EQ(polarisation_of(checked), raytrace::Polarisation::tracked);
  EXPECT_NEAR(beam.incidence_angle, std::acos(std::sqrt(.75)), 1e-15);
  Case const ring = case_with({"optics.uniform_beam=false", "laser.spot_diameter=100 um", "laser.spot_definition=1/e2",
                               "laser.profile=ring", "laser.ring_width=20 um"});
  EXPECT_TRUE(spot_beam(ring.laser, Vec3::Zero(), 1).table);
}

}  // namespace
}  // namespace layerloop::coupling
