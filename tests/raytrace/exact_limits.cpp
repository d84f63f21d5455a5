#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <functional>

#include "raytrace/fresnel.hpp"
#include "scenes.hpp"

// Bodies whose absorptivity theory gives in closed form.
namespace layerloop::raytrace {
namespace {

constexpr double pi = std::numbers::pi;

TEST(ExactLimits, AGrooveOfAnyAngleUnfolds) {
  // Light that falls straight into a V of half angle a meets its walls while (2i - 1) a < 180 degrees, at an angle of
  // incidence of |90 - (2i - 1) a|, always with the same s and p.
  std::array const steel{bare(stainless_steel)};
  for (double const degrees : {14.0, 20.0, 25.0, 30.0, 40.0, 45.0, 70.0}) {
    double const a = degrees * pi / 180, top = 1 / std::tan(a);
    TriangleSurface groove;
    groove.vertices = {{-1, -1, top}, {0, -1, 0}, {1, -1, top}, {-1, 2, top}, {0, 2, 0}, {1, 2, top}};
    groove.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    BedScene const scene({}, groove, {0, 1});
    double s = 1, p = 1, averaged = 1, lit = 1;
    for (int i = 1; (2 * i - 1) * a < pi; ++i) {
      Reflectance const r = fresnel_reflectance(stainless_steel, std::abs(std::sin((2 * i - 1) * a)));
      s *= r.s, p *= r.p, averaged *= r.average();
      lit = std::min(lit, std::sin((2 * i - 1) * a) / std::sin(a));  // so that every hit lies below the edges
    }
    auto const absorptivity = [&](BeamPolarisation light, Polarisation followed) {
      Beam const beam{.centre = {0, 0.5, 0},
                      .power = 1,
                      .profile = BeamProfile::uniform,
                      .size_x = 1.9 * lit,
                      .size_y = 1,
                      .polarisation = light};
      return absorb(scene, beam, steel, 0, {.rays = 1000, .polarisation = followed}).sets[0].absorptivity;
    };
    // The groove runs along y: the field along y is s.
    auto const tracked = Polarisation::tracked;
    EXPECT_NEAR(absorptivity(BeamPolarisation::unpolarised, tracked), 1 - 0.5 * (s + p), 1e-6) << degrees;
    EXPECT_NEAR(absorptivity(BeamPolarisation::circular, tracked), 1 - 0.5 * (s + p), 1e-6) << degrees;
    EXPECT_NEAR(absorptivity(BeamPolarisation::y, tracked), 1 - s, 1e-6) << degrees;
    EXPECT_NEAR(absorptivity(BeamPolarisation::x, tracked), 1 - p, 1e-6) << degrees;
    EXPECT_NEAR(absorptivity(BeamPolarisation::unpolarised, Polarisation::averaged), 1 - averaged, 1e-6) << degrees;
    if (degrees == 45) {
      EXPECT_NEAR(1 - 0.5 * (s + p), .568139, 1e-6);
      EXPECT_NEAR(1 - averaged, .577152, 1e-6);
      EXPECT_NEAR(1 - s, .444670, 1e-6);
      EXPECT_NEAR(1 - p, .691608, 1e-6);
    }
  }
}

TEST(ExactLimits, OneSphereAbsorbsTheSameOfAnyPolarisation) {
  PowderBed bed;
  add_grain(bed, 0.5, 0.5, 0.5, 0.5);
  BedScene const scene(bed, {}, {0, 0});
  std::array const metals{bare(stainless_steel), bare({3.45, 4.00}), bare({1.244, 10.0}), bare(silver)};
  std::array const expected{.35862, .40049, .05596, .02049};  // int 2 c A(c) dc
  for (BeamPolarisation const light :
       {BeamPolarisation::unpolarised, BeamPolarisation::x, BeamPolarisation::y, BeamPolarisation::circular}) {
    Beam beam = uniform_light({1, 1});
    beam.polarisation = light;
    Absorption const result = absorb(scene, beam, metals, 0, {.rays = 60000, .polarisation = Polarisation::tracked});
    for (std::size_t k = 0; k < metals.size(); ++k) {
      SetAbsorption const& metal = result.sets[k];
      EXPECT_NEAR(metal.absorptivity / (pi / 4), expected[k], 3 * metal.standard_error / (pi / 4) + 5e-6) << k;
      EXPECT_LT(metal.standard_error, 3e-4);
    }
  }
}

/// Inside of a sphere of radius 1 about the origin, open above `rim`.
TriangleSurface cavity(double rim, int rings, int around) {
  TriangleSurface wall;
  auto const corner = [&](int i, int j) { return static_cast<std::int32_t>(i * around + j % around); };
  for (int i = 0; i <= rings; ++i) {
    double const polar = (pi - std::acos(rim)) * i / rings;  // from the bottom
    for (int j = 0; j < around; ++j) {
      double const angle = 2 * pi * j / around;
      wall.vertices.push_back({std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), -std::cos(polar)});
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      if (i > 0) wall.triangles.push_back({corner(i, j), corner(i + 1, j), corner(i, j + 1)});
      wall.triangles.push_back({corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1)});
    }
  }
  return wall;
}

TEST(ExactLimits, ASphericalCavityWithLambertWalls) {
  // Every point of a sphere lights all others alike: a / (1 - (1 - a)(1 - f)), f = opening over full sphere (geometric
  // series; DeVos, Physica 20 (1954) 669).
  double const rim = 0.8, f = 0.5 * (1 - rim);
  TriangleSurface const wall = cavity(rim, 120, 240);
  ASSERT_LT(wall.normal(0).z() * wall.corner(0, 0).z(), 0) << "normals point inwards";
  BedScene const scene({}, wall, {0, 0});
  std::array const a{.05, .2, .5, .9};
  std::vector<OpticalSet> walls;
  for (double const share : a) walls.push_back(grey(share));
  Beam beam = uniform_light({0.8, 0.8});  // within the opening of radius 0.6
  beam.centre = Vec3::Zero();
  Absorption const result =
      absorb(scene, beam, walls, 0, {.rays = 8000, .diffuse_share = 1, .target_standard_error = 1.5e-3});
  for (std::size_t k = 0; k < a.size(); ++k) {
    double const exact = a[k] / (1 - (1 - a[k]) * (1 - f));
    EXPECT_NEAR(result.sets[k].absorptivity, exact, 3 * result.sets[k].standard_error + 2e-4) << a[k];
  }
}

/// Chandrasekhar's H function for isotropic scattering at mu = 1, from 1/H = sqrt(1 - w) + w/2 int mu' H / (mu + mu')
/// dmu' (Radiative Transfer, V (16) and (36)), iterated on Gauss points.
double h_function_at_one(double albedo) {
  using Gauss = boost::math::quadrature::gauss<double, 40>;
  std::vector<double> mu, weight;
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
    for (double const side : {-1.0, 1.0}) {
      mu.push_back(0.5 * (1 + side * Gauss::abscissa()[i]));
      weight.push_back(0.5 * Gauss::weights()[i]);
    }
  }
  std::vector<double> h(mu.size(), 1.0);
  auto const at = [&](double m) {
    double integral = 0;
    for (std::size_t j = 0; j < mu.size(); ++j) integral += weight[j] * mu[j] * h[j] / (m + mu[j]);
    return 1 / (std::sqrt(1 - albedo) + 0.5 * albedo * integral);
  };
  for (int iteration = 0; iteration < 200; ++iteration) {
    std::vector<double> next;
    for (double const m : mu) next.push_back(at(m));
    h = next;
  }
  return at(1);
}

/// Spheres of radius 1 dropped at random without overlap (random sequential addition) into a periodic tile.
PowderBed random_spheres(double packing, double width, double depth, std::uint64_t seed) {
  auto const wanted = static_cast<std::size_t>(packing * width * width * depth / (4 * pi / 3));
  int const across = static_cast<int>(width / 2), up = static_cast<int>(depth / 2) + 1;
  double const edge = width / across;
  std::vector<std::vector<std::size_t>> cells(static_cast<std::size_t>(across * across * up));
  auto const cell = [&](int i, int j, int k) -> std::vector<std::size_t>& {
    return cells[static_cast<std::size_t>(((i + across) % across) + across * (((j + across) % across) + across * k))];
  };
  PowderBed bed;
  for (std::uint64_t t = 0; bed.size() < wanted; ++t) {
    auto const u = uniform4(seed, RandomStream::grain_position, t);
    Vec3 const p(width * u[0], width * u[1], 1 + (depth - 2) * u[2]);
    int const ci = static_cast<int>(p.x() / edge), cj = static_cast<int>(p.y() / edge),
              ck = static_cast<int>(p.z() / 2);
    bool free = true;
    for (int i = ci - 1; i <= ci + 1; ++i) {
      for (int j = cj - 1; j <= cj + 1; ++j) {
        for (int k = std::max(ck - 1, 0); k <= std::min(ck + 1, up - 1); ++k) {
          for (std::size_t const other : cell(i, j, k)) {
            Vec3 d = p - bed.position(other);
            for (Eigen::Index axis = 0; axis < 2; ++axis) d[axis] -= width * std::round(d[axis] / width);
            free = free && d.squaredNorm() > 4;
          }
        }
      }
    }
    if (!free) continue;
    cell(ci, cj, ck).push_back(bed.size());
    add_grain(bed, p.x(), p.y(), p.z(), 1);
  }
  return bed;
}

/// Absorptivity of deep random beds of grey mirrors for several sets, over independent beds.
std::vector<Sample> over_beds(double packing, double width, int beds, std::span<OpticalSet const> sets) {
  double const free_path = 4 / (3 * packing);
  std::vector<std::vector<double>> found(sets.size());
  for (int b = 0; b < beds; ++b) {
    BedScene const scene(random_spheres(packing, width, 25 * free_path, static_cast<std::uint64_t>(100 + b)), {},
                         {width, width});
    Absorption const result = absorb(scene, uniform_light({width, width}), sets, 0, {.rays = 3200, .cut_off = 1e-5});
    for (std::size_t k = 0; k < sets.size(); ++k) found[k].push_back(result.sets[k].absorptivity);
  }
  std::vector<Sample> samples;
  for (std::vector<double> const& values : found) samples.push_back(sample_of(values));
  return samples;
}

TEST(ExactLimits, ADiluteHalfSpaceIsChandrasekhars) {
  // A grey specular sphere scatters isotropically: A = sqrt(a) H(1) as the packing goes to zero. At .005 it is lower by
  // .0012 for a = .36 (60 beds: .8240 +- .0007; at .001: .8252 +- .0006), less than the error of the beds here.
  std::array const a{.10, .36, .60}, known{.5851, .8252, .9166};
  std::array const sets{grey(a[0]), grey(a[1]), grey(a[2])};
  int const beds = 12;
  std::vector<Sample> const found = over_beds(.005, 40, beds, sets);
  for (std::size_t k = 0; k < a.size(); ++k) {
    double const exact = std::sqrt(a[k]) * h_function_at_one(1 - a[k]);
    EXPECT_NEAR(exact, known[k], 6e-5);
    double const error = found[k].sd / std::sqrt(static_cast<double>(beds));
    EXPECT_NEAR(found[k].mean, exact, 3 * error) << a[k];
    EXPECT_LT(error, 4e-3);
  }
}

TEST(ExactLimits, DenserPackingOfGreyMirrorsAbsorbsLess) {
  struct {
    double packing, width;
    int beds;
    double expected;  ///< from another tracer and other random beds
  } const cases[] = {{.005, 40, 4, .827}, {.05, 30, 4, .813}, {.15, 24, 4, .786}, {.30, 20, 4, .744}};
  std::array const sets{grey(.36)};
  double before = 1;
  for (auto const& c : cases) {
    Sample const found = over_beds(c.packing, c.width, c.beds, sets)[0];
    EXPECT_LT(found.mean, before - 5e-3) << c.packing;
    before = found.mean;
    double const error = found.sd / std::sqrt(static_cast<double>(c.beds)), their_error = .003;
    EXPECT_NEAR(found.mean, c.expected, 3 * std::hypot(error, their_error)) << c.packing;
  }
}

}  // namespace
}  // namespace layerloop::raytrace
