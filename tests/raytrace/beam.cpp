#include "raytrace/beam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/error.hpp"
#include "raytrace/radial_profile.hpp"

namespace layerloop::raytrace {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Moments of where the rays cross z = 0, about the beam's centre.
struct Footprint {
  double inside = 0;  ///< share within `radius`
  double mean_x = 0, mean_y = 0, square_x = 0, square_y = 0;
};
Footprint footprint(Beam const& beam, double radius, std::int64_t rays = 1 << 16) {
  Footprint f;
  for (std::int64_t i = 0; i < rays; ++i) {
    Ray const ray = beam_ray(beam, 1.0, i, {0.3, 0.8});
    EXPECT_EQ(ray.origin.z(), 1.0);
    Vec3 const p = ray.origin - ray.origin.z() / ray.direction.z() * ray.direction - beam.centre;
    double const share = 1.0 / static_cast<double>(rays);
    f.inside += share * (std::hypot(p.x(), p.y()) < radius);
    f.mean_x += share * p.x(), f.mean_y += share * p.y();
    f.square_x += share * p.x() * p.x(), f.square_y += share * p.y() * p.y();
  }
  return f;
}

TEST(Beam, GaussianHoldsTheSharesOfItsDefinition) {
  // Inside radius r: 1 - exp(-2 r^2/w^2), 86.5 % inside w; standard deviation of each coordinate: w/2 (D4sigma = 2 w).
  Beam const beam{.centre = {3, -2, 0}, .power = 1, .radius = 5};
  Footprint const f = footprint(beam, 5);
  EXPECT_NEAR(f.inside, 0.8646647, 1e-4);
  EXPECT_NEAR(f.square_y, 6.25, 6.25e-3);
  EXPECT_NEAR(f.square_x, 6.25, 1.2e-2);
  EXPECT_NEAR(f.mean_x, 0, 2e-3);
  // Half of the peak intensity lies at FWHM / 2 = w sqrt(ln 2 / 2), which holds half of the power.
  EXPECT_NEAR(footprint(beam, 5 * std::sqrt(0.5 * std::numbers::ln2)).inside, 0.5, 1e-4);
  Ray const ray = beam_ray(beam, 1, 7, {0.3, 0.8});
  EXPECT_EQ(ray.direction, -Vec3::UnitZ());
}

TEST(Beam, UniformFillsItsRectangleEvenly) {
  Beam const beam{.centre = {1, 1, 0}, .power = 1, .profile = BeamProfile::uniform, .size_x = 2, .size_y = 2};
  int quarter = 0;
  for (std::int64_t i = 0; i < 4096; ++i) {
    Vec3 const p = beam_ray(beam, 1, i, {0.1, 0.2}).origin;
    ASSERT_TRUE(p.x() >= 0 && p.x() <= 2 && p.y() >= 0 && p.y() <= 2);
    quarter += p.x() < 1 && p.y() < 1;
  }
  EXPECT_NEAR(quarter / 4096.0, 0.25, 2e-3);
}

TEST(Beam, TopHatIsFlat) {
  // Share inside r: (r/R)^2; <x^2> = R^2/4, so that D4sigma = 2 R, as any level of the intensity.
  Beam const beam{.power = 1, .radius = 2, .profile = BeamProfile::top_hat};
  EXPECT_NEAR(footprint(beam, 1).inside, 0.25, 1e-4);
  EXPECT_EQ(footprint(beam, 2.0000001).inside, 1);
  EXPECT_NEAR(footprint(beam, 1).square_x, 1, 1e-3);
}

TEST(Beam, TableOfAGaussianIsTheGaussian) {
  std::vector<double> radius, intensity;
  for (int p = 0; p <= 800; ++p) {
    radius.push_back(0.005 * p);
    intensity.push_back(7 * std::exp(-2 * radius.back() * radius.back()));  // w = 1, any scale
  }
  RadialProfile const table(radius, intensity);
  for (double const share : {1e-6, 0.01, 0.3, 0.5, 0.8646647, 0.99, 0.99999}) {
    EXPECT_NEAR(table.radius_holding(share), std::sqrt(-0.5 * std::log1p(-share)), 2e-5) << share;
    EXPECT_NEAR(table.power_inside(table.radius_holding(share)), share, 1e-12);
  }
  EXPECT_NEAR(table.second_moment_diameter(), 2, 1e-4);
  Beam const beam{.power = 1, .profile = BeamProfile::tabulated, .table = std::make_shared<RadialProfile>(table)};
  EXPECT_NEAR(footprint(beam, 1).inside, 0.8646647, 1e-4);
}

TEST(Beam, TruncatedTableIsNormalised) {
  // Cut at w: all of the power, shared out as (1 - exp(-2 r^2)) / (1 - exp(-2)).
  std::vector<double> radius, intensity;
  for (int p = 0; p <= 1000; ++p) radius.push_back(0.001 * p), intensity.push_back(std::exp(-2e-6 * p * p));
  RadialProfile const table(radius, intensity);
  EXPECT_EQ(table.power_inside(1), 1);
  EXPECT_NEAR(table.power_inside(0.5), (1 - std::exp(-0.5)) / (1 - std::exp(-2.0)), 1e-6);
}

TEST(Beam, RingHasItsMoments) {
  // exp(-2 (r - c)^2 / d^2): the power holds r exp(...), whose mean of r^2 is (c^4 + 6 c^2 s^2 + 3 s^4) over ... with
  // s = d/2, for a ring that is narrow against its radius: <r^2> = c^2 + 3 s^2.
  double const c = 10, d = 2, s = d / 2;
  RadialProfile const ring = ring_profile(c, d);
  EXPECT_NEAR(ring.second_moment_diameter(), 4 * std::sqrt(0.5 * (c * c + 3 * s * s)), 1e-3);
  // Half of the power lies inside the radius whose mean is shifted outwards: 1/2 + s/(c sqrt(2 pi)) of it beyond c.
  EXPECT_NEAR(1 - ring.power_inside(c), 0.5 + s / (c * std::sqrt(2 * std::numbers::pi)), 1e-4);
}

TEST(Beam, TableThatCannotBeUsedIsRefused) {
  EXPECT_THROW(RadialProfile({0}, {1}), InputError);
  EXPECT_THROW(RadialProfile({0, 0}, {1, 1}), InputError);
  EXPECT_THROW(RadialProfile({0, 1}, {1, -1}), InputError);
  EXPECT_THROW(RadialProfile({0, 1}, {0, 0}), InputError);
  EXPECT_THROW(RadialProfile({0, 1}, {std::nan(""), 1}), InputError);
}

TEST(Beam, TableIsReadFromAFile) {
  auto const path = std::filesystem::temp_directory_path() / "layerloop_profile_test.csv";
  std::ofstream(path) << "r [um],intensity [W/m2]\n0,5\n10,5\n20,0\n";
  RadialProfile const table = read_radial_profile(path);
  EXPECT_EQ(table.power_inside(20e-6), 1);
  // Cone frustum: (1/2 + integral of s (2 - s) from 1 to 2 = 2/3) in units of 5 (10 um)^2.
  EXPECT_NEAR(table.power_inside(10e-6), 0.5 / (0.5 + 2.0 / 3), 1e-12);
  std::ofstream(path) << "r,intensity\n0,5\n10,5\n";
  EXPECT_THROW(read_radial_profile(path), InputError);
  std::filesystem::remove(path);
}

TEST(Beam, EllipseKeepsItsArea) {
  Beam const beam{.power = 1, .radius = 2, .ellipticity = 4};
  Footprint const f = footprint(beam, 2);
  EXPECT_NEAR(f.square_x, 0.25, 1e-3);  // w_x = 1, w_y = 4
  EXPECT_NEAR(f.square_y, 4, 1e-2);
}

TEST(Beam, ObliqueFootprintIsStretchedByTheCosine) {
  for (double const angle : {0.0, 30.0, 60.0}) {
    Beam const beam{.centre = {1, 2, 0}, .power = 1, .radius = 2, .incidence_angle = angle * degree};
    Footprint const f = footprint(beam, 2);
    double const stretch = 1 / std::cos(angle * degree);
    EXPECT_NEAR(f.square_x, stretch * stretch, 2e-3 * stretch * stretch) << angle;
    EXPECT_NEAR(f.square_y, 1, 2e-3) << angle;
    EXPECT_NEAR(f.mean_x, 0, 2e-3);  // about where the axis meets the plane
    Vec3 const travel = beam_ray(beam, 1, 0, {0.5, 0.5}).direction;
    EXPECT_NEAR(travel.x(), std::sin(angle * degree), 1e-15);
    EXPECT_NEAR(travel.z(), -std::cos(angle * degree), 1e-15);
  }
  Beam const sideways{.power = 1, .radius = 2, .incidence_angle = 60 * degree, .incidence_azimuth = 90 * degree};
  EXPECT_NEAR(footprint(sideways, 1).square_y, 4, 8e-3);
  EXPECT_NEAR(footprint(sideways, 1).square_x, 1, 2e-3);
  // Level light of any incidence fills the same rectangle.
  Beam const level{.power = 1, .profile = BeamProfile::uniform, .size_x = 3, .size_y = 2, .incidence_angle = 1};
  EXPECT_NEAR(footprint(level, 1).square_x, 9.0 / 12, 1e-3);
}

TEST(Beam, FocusIsWhereTheRaysMeet) {
  // At one Rayleigh length: w = sqrt(2) w0, R = 2 zR. Rays normal to that front meet 2 zR before it.
  Defocus const at = defocus(3.0, 3.0);
  EXPECT_NEAR(at.widening, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(1 / at.front_curvature, 6.0, 1e-14);
  EXPECT_EQ(defocus(0, 3.0).front_curvature, 0);
  EXPECT_EQ(defocus(0, 3.0).widening, 1);
  EXPECT_LT(defocus(-1, 3.0).front_curvature, 0);
  Beam const beam{.power = 1, .radius = 0.1, .front_curvature = at.front_curvature};
  for (std::int64_t i = 0; i < 100; ++i) {
    Ray const ray = beam_ray(beam, 1, i, {0.1, 0.7});
    Vec3 const focus = ray.origin + (6.0 - 1.0) / ray.direction.z() * ray.direction;
    EXPECT_NEAR(std::hypot(focus.x(), focus.y()), 0, 1e-14);
  }
  // The radius holds on the bed.
  EXPECT_NEAR(footprint(beam, 0.1).inside, 0.8646647, 1e-4);
}

TEST(Beam, FieldsLieAcrossTheRayAndCarryItsPower) {
  using enum BeamPolarisation;
  for (BeamPolarisation const polarisation : {unpolarised, s, p, x, y, circular}) {
    for (double const angle : {0.0, 0.7}) {
      Beam const beam{.power = 1,
                      .radius = 1,
                      .incidence_angle = angle,
                      .incidence_azimuth = 0.4,
                      .front_curvature = 0.1,
                      .polarisation = polarisation};
      Ray const ray = beam_ray(beam, 1, 5, {0.2, 0.1});
      auto const fields = ray_fields(beam, ray.direction);
      EXPECT_NEAR(fields[0].squaredNorm() + fields[1].squaredNorm(), 1, 1e-14);
      for (auto const& e : fields) EXPECT_NEAR(std::abs(e.dot(ray.direction.cast<std::complex<double>>())), 0, 1e-14);
    }
  }
  Beam oblique{.power = 1, .radius = 1, .incidence_angle = 0.7, .incidence_azimuth = 0.4, .polarisation = s};
  Vec3 const travel = beam_ray(oblique, 1, 0, {0.2, 0.1}).direction;
  EXPECT_NEAR(std::abs(ray_fields(oblique, travel)[0].z()), 0, 1e-15);  // s is level
  oblique.polarisation = p;
  EXPECT_NEAR(std::abs(ray_fields(oblique, travel)[0].z()), std::sin(0.7), 1e-14);
  Beam const down{.power = 1, .radius = 1};
  auto const fields = ray_fields(down, -Vec3::UnitZ());
  EXPECT_EQ(fields[0], std::sqrt(0.5) * Eigen::Vector3cd::UnitX());
  EXPECT_EQ(fields[1], std::sqrt(0.5) * Eigen::Vector3cd::UnitY());
}

TEST(Beam, BadBeamsAreRefused) {
  EXPECT_THROW(check_beam({.power = 0, .radius = 1}), InputError);
  EXPECT_THROW(check_beam({.power = 1, .radius = 0}), InputError);
  EXPECT_THROW(check_beam({.power = 1, .radius = 1, .profile = BeamProfile::tabulated}), InputError);
  EXPECT_THROW(check_beam({.power = 1, .radius = 1, .incidence_angle = 1.6}), InputError);
  EXPECT_THROW(check_beam({.centre = {std::nan(""), 0, 0}, .power = 1, .radius = 1}), InputError);
  EXPECT_NO_THROW(check_beam({.power = 1, .radius = 1}));
}

}  // namespace
}  // namespace layerloop::raytrace
