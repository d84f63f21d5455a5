#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/error.hpp"
#include "raytrace/bed_scene.hpp"
#include "scenes.hpp"

// What must hold for both ways to find the grain that a ray meets first, and between them.
namespace layerloop::raytrace {
namespace {

constexpr double length = 4e-4, width = 2e-4;

Vec3 direction_of(std::uint64_t id) {
  auto const u = uniform4(11, RandomStream::ray_shift, id);
  double const z = 2 * u[0] - 1, angle = 2 * std::numbers::pi * u[1], r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

Ray mirrored(Ray const& ray, Hit const& hit) {
  return {hit.point, (ray.direction - 2 * ray.direction.dot(hit.normal) * hit.normal).normalized()};
}

/// Falls on the bed at a slant.
Ray slanted_ray(std::uint64_t id, double height) {
  auto const u = uniform4(12, RandomStream::ray_shift, id);
  Vec3 direction = direction_of(id);
  direction.z() = -std::abs(direction.z()) - 0.2;
  return {{length * u[2], width * u[3], height}, direction.normalized()};
}

/// The hits of a path, the last of which may be none.
std::vector<Hit> path(BedScene const& scene, Ray ray, int bounces) {
  std::vector<Hit> hits;
  for (int b = 0; b < bounces; ++b) {
    hits.push_back(scene.first_hit(ray));
    if (hits.back().target == Target::nothing || hits.back().target == Target::undecided) break;
    ray = mirrored(ray, hits.back());
  }
  return hits;
}

bool grazing(Ray const& ray, Hit const& hit) {
  return hit.target == Target::grain && -ray.direction.dot(hit.normal) < 0.1;
}

PowderBed with_radii(std::vector<double> const& radii, int tries) {
  PowderBed bed;
  for (int t = 0; t < tries; ++t) {
    auto const u = uniform4(8, RandomStream::grain_position, static_cast<std::uint64_t>(t));
    double const r = radii[static_cast<std::size_t>(t) * radii.size() / static_cast<std::size_t>(tries)];
    Vec3 const p(u[0] * length, u[1] * width, r + u[2] * 1e-4);
    bool free = true;
    for (std::size_t i = 0; i < bed.size() && free; ++i) {
      Vec3 d = p - bed.position(i);
      d.x() -= length * std::round(d.x() / length);
      d.y() -= width * std::round(d.y() / width);
      free = d.norm() > 0.97 * (r + bed.radius[i]);  // some overlap
    }
    if (free) add_grain(bed, p.x(), p.y(), p.z(), r);
  }
  return bed;
}

/// Periodic on both sides.
PowderBed const& powder() {
  static PowderBed const bed = with_radii({21e-6, 14e-6, 10.5e-6, 6.5e-6}, 6000);
  return bed;
}

TriangleSurface plate() { return flat_floor(-length, 2 * length, -width, 2 * width, 0); }

/// Hills of triangles that reach up among the grains and fit together at the sides of the tile.
TriangleSurface hills() {
  TriangleSurface surface;
  int const n = 24;
  double const wave = 2 * std::numbers::pi;
  for (int j = -n; j <= 2 * n; ++j) {
    for (int i = -n; i <= 2 * n; ++i) {
      double const x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      surface.vertices.push_back(
          {length * x, width * y, 2e-5 * (std::sin(wave * (2 * x + y)) + std::cos(wave * (y - 3 * x)))});
    }
  }
  for (int j = 0; j < 3 * n; ++j) {
    for (int i = 0; i < 3 * n; ++i) {
      int const a = j * (3 * n + 1) + i, b = a + 1, c = a + 3 * n + 1, d = c + 1;
      surface.triangles.push_back({a, b, d});
      surface.triangles.push_back({a, d, c});
    }
  }
  return surface;
}

class OfBackend : public testing::TestWithParam<Backend> {};
INSTANTIATE_TEST_SUITE_P(Backends, OfBackend, testing::Values(Backend::grid, Backend::embree),
                         [](auto const& info) { return info.param == Backend::grid ? "Grid" : "Embree"; });

TEST(Backends, GridAndEmbreeMeetTheSameSurface) {
  struct Case {
    char const* name;
    PowderBed bed;
    TriangleSurface substrate;
    std::array<double, 2> period;
  };
  std::vector<Case> const cases{{"periodic", powder(), {}, {length, width}},
                                {"on a plate", powder(), plate(), {length, width}},
                                {"among hills", powder(), hills(), {length, width}},
                                {"open along x", powder(), plate(), {0, width}},
                                {"open", powder(), plate(), {0, 0}},
                                {"sizes of 1 to 20", with_radii({4e-5, 1e-5, 2e-6}, 4000), plate(), {length, width}}};
  for (Case const& c : cases) {
    BedScene const grid(c.bed, c.substrate, c.period, Backend::grid),
        embree(c.bed, c.substrate, c.period, Backend::embree);
    ASSERT_EQ(grid.backend(), Backend::grid);
    ASSERT_EQ(embree.backend(), Backend::embree);
    int rays = 0, differing = 0, plainly = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      Ray ray = slanted_ray(i, 3e-4);
      for (int bounce = 0; bounce < 20; ++bounce) {
        ++rays;
        Hit const one = grid.first_hit(ray), other = embree.first_hit(ray);
        if (one.target != other.target || one.row != other.row) {
          ++differing;
          plainly += !grazing(ray, one) && !grazing(ray, other);
        } else if (one.target != Target::nothing) {
          // The plane of a triangle and the tile edge that was crossed cost a few digits.
          EXPECT_LT((one.point - other.point).norm(), 1e-15) << c.name;
        }
        if (other.target == Target::nothing) break;
        ray = mirrored(ray, other);
      }
    }
    EXPECT_GT(rays, 8000) << c.name;
    EXPECT_EQ(plainly, 0) << c.name;
    EXPECT_LE(differing, 1) << c.name;
  }
}

TEST(Backends, PicturesShowTheCopiesThatStickOut) {
  BedScene const grid(powder(), {}, {length, width}, Backend::grid),
      embree(powder(), {}, {length, width}, Backend::embree);
  int outside = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    auto const u = uniform4(13, RandomStream::ray_shift, i);
    Vec3 const target(length * (1.2 * u[0] - 0.1), width * (1.4 * u[1] - 0.2), 1e-4 * u[2]);
    Ray const ray{target - 1e-3 * direction_of(i), direction_of(i)};
    Hit const one = grid.first_hit_in_tile(ray), other = embree.first_hit_in_tile(ray);
    ASSERT_EQ(one.target, other.target);
    ASSERT_EQ(one.row, other.row);
    EXPECT_EQ(grid.is_blocked(ray, 1e-3), embree.is_blocked(ray, 1e-3));
    outside += one.target == Target::grain && (one.point.y() < 0 || one.point.y() > width);
  }
  EXPECT_GT(outside, 200);
}

TEST(Backends, TheGridServesUnlessItsCellsAreCrowded) {
  EXPECT_EQ(BedScene(powder(), plate(), {length, width}).backend(), Backend::grid);
  PowderBed scattered = powder();
  add_grain(scattered, 1, 1, 1, 10e-6);  // a metre away: all others share a cell
  EXPECT_EQ(BedScene(scattered, {}).backend(), Backend::embree);
  EXPECT_EQ(BedScene({}, plate()).backend(), Backend::embree);
}

TEST_P(OfBackend, GapsOfBlackLatticesAreExact) {
  // Lattice planes seen from above: what gets through is a matter of areas alone.
  Lattice const hexagonal = hexagonal_layers(1), cubic = simple_cubic(7);
  auto const through = [&](Lattice const& lattice) {
    BedScene const scene(lattice.bed, {}, lattice.period, GetParam());
    AbsorbedPower const power = trace_uniform(scene, black, 200000);
    EXPECT_LT(power.standard_error, 2e-4);
    return std::array{1 - power.absorptivity, 3 * power.standard_error};
  };
  auto const [one, one_error] = through(hexagonal);
  EXPECT_NEAR(one, 1 - std::numbers::pi / (2 * std::sqrt(3.0)), one_error);
  auto const [deep, deep_error] = through(cubic);
  EXPECT_NEAR(deep, 1 - std::numbers::pi / 4, deep_error);
}

TEST_P(OfBackend, LatticesAbsorbAsInAnotherTracer) {
  // Reference: built-in Embree spheres, random rays, 4e5 paths, with the standard errors given.
  struct Case {
    Lattice lattice;
    std::complex<double> metal;
    double expected, error;
  } const cases[] = {{hexagonal_layers(1), stainless_steel, .4892, .0005},
                     {hexagonal_layers(2), silver, .0864, .0005},
                     {face_centred_cubic(16), stainless_steel, .61876, .00047}};
  for (Case const& c : cases) {
    BedScene const scene(c.lattice.bed, {}, c.lattice.period, GetParam());
    AbsorbedPower const power = trace_uniform(scene, c.metal, 100000);
    EXPECT_LT(power.standard_error, 4e-4);
    EXPECT_NEAR(power.absorptivity, c.expected, 3 * std::hypot(power.standard_error, c.error));
  }
}

TEST_P(OfBackend, OverlappingGrainsHaveTheShadowOfTheirUnion) {
  // Two unit spheres whose centres are h apart as seen from above: 2 pi less the lens that the two discs share.
  for (double const h : {0.2, 1.0, 1.9}) {
    double const lens = 2 * std::acos(h / 2) - h / 2 * std::sqrt(4 - h * h);
    PowderBed bed;
    add_grain(bed, 0, 0, 0, 1);
    add_grain(bed, 0.8 * h, 0.6 * h, 0.3, 1);
    BedScene const scene(bed, {}, {0, 0}, GetParam());
    Beam const light{.centre = {0.5, 0.5, 0}, .power = 1, .profile = BeamProfile::uniform, .size_x = 5, .size_y = 5};
    AbsorbedPower const power = trace(scene, light, std::array{black}, 0, one_cell(scene), {.rays = 100000});
    EXPECT_LT(power.standard_error, 3e-4);
    EXPECT_NEAR(power.absorptivity, (2 * std::numbers::pi - lens) / 25, 3 * power.standard_error) << h;
  }
}

TEST_P(OfBackend, AGrainInsideAnotherChangesNothing) {
  PowderBed twice = powder();
  for (std::size_t i = 0; i < powder().size(); ++i) {
    Vec3 const centre = powder().position(i);
    add_grain(twice, centre.x(), centre.y(), centre.z(), 0.9 * powder().radius[i]);
  }
  BedScene const one(powder(), plate(), {length, width}, GetParam()),
      other(twice, plate(), {length, width}, GetParam());
  EXPECT_EQ(trace_uniform(one, silver, 3200).absorbed, trace_uniform(other, silver, 3200).absorbed);
}

TEST_P(OfBackend, ACarpetOfOverlappingGrainsIsTight) {
  Lattice carpet = hexagonal_layers(1);
  for (double& r : carpet.bed.radius) r = 0.6;  // holes close at 1 / sqrt(3) of the spacing
  BedScene const scene(carpet.bed, {}, carpet.period, GetParam());
  AbsorbedPower const power = trace_uniform(scene, black, 100000);
  EXPECT_NEAR(power.absorptivity, 1, 1e-12);
  for (std::uint64_t i = 0; i < 30000; ++i) {
    auto const u = uniform4(14, RandomStream::ray_shift, i);
    Ray ray{{u[0], u[1], 2}, -Vec3::UnitZ()};
    for (Hit hit; (hit = scene.first_hit(ray)).target == Target::grain;) ray = mirrored(ray, hit);
    ASSERT_GT(ray.direction.z(), 0) << "left through the carpet";
  }
}

TEST_P(OfBackend, AGrainLargerThanTheTile) {
  // One grain in a narrow tile is a row of them in a wide one.
  PowderBed one, row;
  add_grain(one, 0.1, 0.2, 0.5, 0.5);
  for (int i = 0; i < 4; ++i) add_grain(row, 0.1, 0.2 + 0.3 * i, 0.5, 0.5);
  BedScene const narrow(one, {}, {2, 0.3}, GetParam()), wide(row, {}, {2, 1.2}, GetParam());
  for (std::uint64_t i = 0; i < 5000; ++i) {
    auto const u = uniform4(15, RandomStream::ray_shift, i);
    Ray const ray{{2 * u[0], u[1], 1.5}, Vec3(u[2] - 0.5, u[3] - 0.5, -1).normalized()};
    Hit const hit = narrow.first_hit(ray), other = wide.first_hit(ray);
    ASSERT_EQ(hit.target, other.target);
    if (hit.target == Target::nothing) continue;
    EXPECT_NEAR(hit.point.z(), other.point.z(), 1e-12);
    EXPECT_LT((hit.normal - other.normal).norm(), 1e-10);
  }
}

TEST_P(OfBackend, FarFromTheOriginIsTheSame) {
  BedScene const scene(powder(), plate(), {0, 0}, GetParam());
  for (double const away : {3.6e-3, 50e-3}) {
    Vec3 const offset(away, -away, 0.5 * away);
    PowderBed bed = powder();
    TriangleSurface floor = plate();
    for (std::size_t i = 0; i < bed.size(); ++i) bed.x[i] += offset.x(), bed.y[i] += offset.y(), bed.z[i] += offset.z();
    floor.shift(offset);
    BedScene const far(bed, floor, {0, 0}, GetParam());
    int hits = 0;
    for (std::uint64_t i = 0; i < 5000; ++i) {
      Ray ray = slanted_ray(i, 3e-4);
      for (int bounce = 0; bounce < 10; ++bounce) {
        Hit const hit = scene.first_hit(ray), other = far.first_hit({ray.origin + offset, ray.direction});
        if (hit.target == Target::nothing) break;
        ++hits;
        if (grazing(ray, hit)) break;
        ASSERT_EQ(hit.target, other.target);
        ASSERT_EQ(hit.row, other.row);
        EXPECT_LT((other.point - offset - hit.point).norm(), 1e-9 * 20e-6);
        EXPECT_LT((other.normal - hit.normal).norm(), 1e-9);
        ray = mirrored(ray, hit);
      }
    }
    EXPECT_GT(hits, 5000);
  }
}

TEST_P(OfBackend, SizeDoesNotMatter) {
  auto const scaled = [](double by) {
    PowderBed bed = powder();
    for (auto* values : {&bed.x, &bed.y, &bed.z, &bed.radius}) {
      for (double& v : *values) v *= by;
    }
    TriangleSurface floor = plate();
    for (Vec3& v : floor.vertices) v *= by;
    return BedScene(bed, floor, {by * length, by * width}, GetParam());
  };
  BedScene const scene = scaled(1);
  EXPECT_EQ(trace_uniform(scene, silver, 3200).absorbed, trace_uniform(scaled(1024), silver, 3200).absorbed);
  EXPECT_EQ(trace_uniform(scene, silver, 3200).absorbed, trace_uniform(scaled(0x1p-20), silver, 3200).absorbed);
  // Not a power of two: rounding, which grows from bounce to bounce, but no bias.
  AbsorbedPower const one = trace_uniform(scene, stainless_steel, 16000),
                      other = trace_uniform(scaled(1e6), stainless_steel, 16000);
  EXPECT_NEAR(one.absorptivity, other.absorptivity, 2e-4);
}

TEST_P(OfBackend, TurnedByARightAngle) {
  PowderBed turned;
  for (std::size_t i = 0; i < powder().size(); ++i)
    add_grain(turned, width - powder().y[i], powder().x[i], powder().z[i], powder().radius[i]);
  TriangleSurface const floor = flat_floor(-width, 2 * width, -length, 2 * length, 0);
  BedScene const scene(powder(), plate(), {length, width}, GetParam()),
      other(turned, floor, {width, length}, GetParam());
  auto const turn = [](Vec3 const& v) { return Vec3(-v.y(), v.x(), v.z()); };
  for (std::uint64_t i = 0; i < 5000; ++i) {
    Ray const ray = slanted_ray(i, 3e-4);
    Ray const same{turn(ray.origin) + width * Vec3::UnitX(), turn(ray.direction)};
    std::vector<Hit> const hits = path(scene, ray, 4), turned_hits = path(other, same, 4);
    for (std::size_t h = 0; h < std::min(hits.size(), turned_hits.size()); ++h) {
      if (h > 0 && hits[h - 1].normal.dot(ray.direction) > -0.1) break;  // after grazing, rounding has grown
      if (hits[h].target != Target::grain || turned_hits[h].target != Target::grain) break;
      EXPECT_LT((turn(hits[h].normal) - turned_hits[h].normal).norm(), 1e-6);
    }
    ASSERT_EQ(hits[0].target, turned_hits[0].target);
    EXPECT_TRUE(hits[0].target != Target::grain || hits[0].row == turned_hits[0].row);
  }
  AbsorbedPower const one = trace_uniform(scene, stainless_steel, 60000),
                      two = trace_uniform(other, stainless_steel, 60000);
  EXPECT_NEAR(one.absorptivity, two.absorptivity, 3 * std::hypot(one.standard_error, two.standard_error));
}

TEST_P(OfBackend, TheOrderOfGrainsDoesNotChangeABit) {
  std::vector<std::size_t> order(powder().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [](std::size_t a, std::size_t b) {
    return uniform4(16, RandomStream::ray_shift, a)[0] < uniform4(16, RandomStream::ray_shift, b)[0];
  });
  PowderBed shuffled;
  for (std::size_t const i : order)
    add_grain(shuffled, powder().x[i], powder().y[i], powder().z[i], powder().radius[i]);
  BedScene const scene(powder(), plate(), {length, width}, GetParam()),
      other(shuffled, plate(), {length, width}, GetParam());
  AbsorbedPower const one = trace_uniform(scene, silver, 3200), two = trace_uniform(other, silver, 3200);
  EXPECT_EQ(one.absorbed, two.absorbed);
  EXPECT_EQ(one.escaped, two.escaped);
  EXPECT_EQ(one.mean_bounces, two.mean_bounces);
}

TEST_P(OfBackend, FourTilesAreOne) {
  PowderBed four;
  for (double const dx : {0.0, length}) {
    for (double const dy : {0.0, width}) {
      for (std::size_t i = 0; i < powder().size(); ++i)
        add_grain(four, powder().x[i] + dx, powder().y[i] + dy, powder().z[i], powder().radius[i]);
    }
  }
  BedScene const scene(powder(), plate(), {length, width}, GetParam()),
      wide(four, flat_floor(-length, 3 * length, -width, 3 * width, 0), {2 * length, 2 * width}, GetParam());
  // The same light on both: one tile of it.
  VoxelGrid const cells = one_cell(wide);
  Beam const light = uniform_light({length, width});
  TraceSettings const settings{.rays = 16000};
  double const one = trace(scene, light, std::array{stainless_steel}, 0, cells, settings).absorptivity;
  double const two = trace(wide, light, std::array{stainless_steel}, 0, cells, settings).absorptivity;
  EXPECT_NEAR(one, two, 1e-4) << "rounding, amplified from bounce to bounce";
}

TEST_P(OfBackend, LevelRaysInAGapEndUndecided) {
  PowderBed bed;
  add_grain(bed, 0.2, 0.2, 0.2, 0.1);
  add_grain(bed, 0.8, 0.8, 0.8, 0.1);
  BedScene const scene(bed, {}, {1, 1}, GetParam());
  EXPECT_EQ(scene.first_hit({{0.5, 0.5, 0.5}, Vec3::UnitY()}).target, Target::undecided);
  EXPECT_EQ(scene.first_hit({{0.5, 0.5, 0.5}, Vec3(-1, -0.3, 0).normalized()}).target, Target::undecided);
  EXPECT_EQ(scene.first_hit({{0.5, 0.5, 0.95}, Vec3::UnitX()}).target, Target::nothing) << "above everything";
  Hit const hit = scene.first_hit({{0.5, 0.5, 0.2}, Vec3(1, 0.001, 0).normalized()});  // in time it meets one
  EXPECT_EQ(hit.target, Target::grain);
}

TEST_P(OfBackend, ManyGrains) {
  int const n = 50;  // 125 000 grains of a cubic lattice, in any order
  PowderBed bed;
  for (int i = 0; i < n * n * n; ++i) {
    int const j = static_cast<int>(std::int64_t{i} * 7919 % (n * n * n));
    add_grain(bed, j % n + 0.5, j / n % n + 0.5, j / n / n + 0.5, 0.5);
  }
  BedScene const scene(bed, {}, {n, n}, GetParam());
  AbsorbedPower const power = trace_uniform(scene, black, 50000);
  EXPECT_LT(power.standard_error, 2e-3);
  EXPECT_NEAR(power.absorptivity, std::numbers::pi / 4, 3 * power.standard_error);
}

TEST_P(OfBackend, RefusesWhatIsNoNumber) {
  double const nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (double const wrong : {nan, inf}) {
    for (auto values : {&PowderBed::x, &PowderBed::z, &PowderBed::radius}) {
      PowderBed bed = powder();
      (bed.*values)[5] = wrong;
      EXPECT_THROW(BedScene(bed, {}, {0, 0}, GetParam()), PhysicsError);
    }
    EXPECT_THROW(BedScene(powder(), {}, {wrong, 0}, GetParam()), InputError);
  }
  BedScene const scene(powder(), plate(), {length, width}, GetParam());
  for (Ray const& ray : {Ray{{nan, 0, 0}, Vec3::UnitX()}, Ray{{0, 0, 0}, {nan, 0, 1}}, Ray{{0, 0, 1}, {nan, nan, nan}}})
    EXPECT_NE(scene.first_hit(ray).target, Target::grain);
}

}  // namespace
}  // namespace layerloop::raytrace
