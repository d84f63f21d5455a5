#include "raytrace/bed_scene.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "scenes.hpp"

namespace layerloop::raytrace {
namespace {

Vec3 random_direction(std::uint64_t id) {
  auto const u = uniform4(3, RandomStream::ray_shift, id);
  double const z = 2 * u[0] - 1, angle = 2 * std::numbers::pi * u[1], r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

TEST(BedScene, HitsAreExactToDoublePrecision) {
  PowderBed bed;
  add_grain(bed, 1e-3, 2e-3, 3e-3, 13e-6);
  BedScene const scene(bed, {});
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Vec3 const n = random_direction(2 * i), side = random_direction(2 * i + 1);
    Vec3 const target = bed.position(0) + 13e-6 * n;
    Vec3 const from = target + 1e-4 * (n + 0.9 * side).normalized();
    Hit const hit = scene.first_hit({from, (target - from).normalized()});
    ASSERT_EQ(hit.target, Target::grain);
    EXPECT_LT((hit.point - target).norm(), 1e-16 + 1e-11 * 13e-6 / std::max(0.01, n.dot((from - target).normalized())));
    EXPECT_NEAR(hit.normal.norm(), 1, 1e-14);
  }
}

TEST(BedScene, ReflectedRaysNeverMeetTheirOwnGrain) {
  PowderBed const bed = random_bed(3e-4, 2e-4, 8e-5, 4000);
  BedScene const scene(bed, {});
  int hits = 0, own = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    auto const u = uniform4(5, RandomStream::ray_shift, i);
    Ray ray{{3e-4 * u[0], 2e-4 * u[1], 1e-3}, -Vec3::UnitZ()};
    for (Hit last, hit; (hit = scene.first_hit(ray)).target == Target::grain; last = hit) {
      own += hit.row == last.row;
      ++hits;
      ray.direction = (ray.direction - 2 * ray.direction.dot(hit.normal) * hit.normal).normalized();
      ray.origin = hit.point;
    }
  }
  EXPECT_GT(hits, 20000);
  EXPECT_EQ(own, 0);
}

TEST(BedScene, OverlappingGrainsAreSeenAsTheirUnion) {
  PowderBed bed;
  add_grain(bed, 0, 0, 0, 1);
  add_grain(bed, 1.9, 0, 0, 1);
  BedScene const scene(bed, {});
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Ray ray{{0.95, 0, 0}, random_direction(i)};
    ray.origin -= 5 * ray.direction;
    ray.origin += 0.3 * random_direction(100000 + i);
    for (Hit hit; (hit = scene.first_hit(ray)).target == Target::grain; ray.origin = hit.point) {
      EXPECT_GE((hit.point - bed.position(static_cast<std::size_t>(1 - hit.row))).norm(), 1 - 1e-12);
      ray.direction = (ray.direction - 2 * ray.direction.dot(hit.normal) * hit.normal).normalized();
    }
  }
}

TEST(BedScene, AMeshOfManyTrianglesDoesNotLeak) {
  // Mirrors above a black grain as large as the tile: whatever is absorbed has slipped between two triangles.
  TriangleSurface waves;
  int const n = 120;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i)
      waves.vertices.push_back({0.01 * i - 0.1, 0.01 * j - 0.1, 0.05 * std::sin(0.9 * i) * std::cos(1.1 * j)});
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      int const a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      waves.triangles.push_back({a, b, d});
      waves.triangles.push_back({a, d, c});
    }
  }
  PowderBed bed;
  bed.add(0, {0.5, 0.5, -3}, 2.5, 1);
  BedScene const scene(bed, waves);
  std::array const metals{std::complex<double>(1e-3, 1e3), black};
  AbsorbedPower const power = trace(scene, uniform_light({1, 1}), metals, 0, one_cell(scene), {.rays = 200000});
  EXPECT_GT(power.mean_bounces, 1.5);
  EXPECT_LT(power.absorptivity, 1e-6);
}

TEST(BedScene, TrianglesAreSeenFromOutsideOnly) {
  BedScene const scene({}, flat_floor(0, 1, 0, 1, 0.25));
  Hit const above = scene.first_hit({{0.3, 0.3, 1}, Vec3(0.1, 0, -1).normalized()});
  ASSERT_EQ(above.target, Target::substrate);
  EXPECT_NEAR(above.point.z(), 0.25, 1e-15);
  EXPECT_NEAR(above.point.x(), 0.375, 1e-15);
  EXPECT_EQ(scene.first_hit({{0.3, 0.3, 0}, Vec3::UnitZ()}).target, Target::nothing);
}

TEST(BedScene, RaysGoRoundAPeriodicTile) {
  PowderBed bed;
  add_grain(bed, 0.5, 0.05, 0.5, 0.1);  // reaches over y = 0
  BedScene const scene(bed, {}, {0, 1});
  Hit const copy = scene.first_hit({{0.5, 0.97, 2}, -Vec3::UnitZ()});  // its copy at y = 1.05
  ASSERT_EQ(copy.target, Target::grain);
  EXPECT_EQ(copy.row, 0);
  EXPECT_NEAR(copy.point.z(), 0.5 + std::sqrt(0.01 - 0.08 * 0.08), 1e-14);

  Hit const round = scene.first_hit({{0.5, 0.5, 0.5}, Vec3::UnitY()});
  ASSERT_EQ(round.target, Target::grain);
  EXPECT_NEAR(round.point.y(), 0.95, 1e-14);

  // Rises towards the middle of the grain's fourth image, at y = 4.05; the point is given in the tile.
  Vec3 const slant = Vec3(0, 3.55, 0.4).normalized();
  Hit const far = scene.first_hit({Vec3(0.5, 0.5, 0.1), slant});
  ASSERT_EQ(far.target, Target::grain);
  EXPECT_LT((far.normal + slant).norm(), 1e-12);
  EXPECT_LT((far.point - (Vec3(0.5, 1.05, 0.5) - 0.1 * slant)).norm(), 1e-13);

  EXPECT_EQ(scene.first_hit({{0.5, 0.5, 0.7}, Vec3::UnitY()}).target, Target::nothing) << "above everything";
  EXPECT_EQ(scene.first_hit({{0.9, 0.5, 0.5}, Vec3::UnitY()}).target, Target::nothing)
      << "beside everything, along an open side";
}

TEST(BedScene, LevelRaysInAnEmptyGapAreNotFollowedForEver) {
  PowderBed bed;
  add_grain(bed, 0.2, 0.5, 0.2, 0.1);
  add_grain(bed, 0.8, 0.5, 0.8, 0.1);
  BedScene const scene(bed, {}, {0, 1});
  EXPECT_EQ(scene.first_hit({{0.5, 0.5, 0.5}, Vec3::UnitY()}).target, Target::undecided);
}

TEST(BedScene, BlockedWithinADistance) {
  PowderBed bed;
  add_grain(bed, 0, 0, 0, 1);
  BedScene const scene(bed, {});
  EXPECT_TRUE(scene.is_blocked({{0, 0, 3}, -Vec3::UnitZ()}, 2.5));
  EXPECT_FALSE(scene.is_blocked({{0, 0, 3}, -Vec3::UnitZ()}, 1.5));
  EXPECT_FALSE(scene.is_blocked({{0, 0, 1}, Vec3::UnitZ()}, 10));
}

TEST(BedScene, RefusesWhatCannotBeTraced) {
  EXPECT_THROW(BedScene({}, {}), InputError);
  PowderBed bed;
  add_grain(bed, 0, 1.5, 0, 0.1);
  EXPECT_THROW(BedScene(bed, {}, {0, 1}), InputError);
  bed.z[0] = std::nan("");
  EXPECT_THROW(BedScene(bed, {}), PhysicsError);
  TriangleSurface floor = flat_floor(0, 1, 0, 1, 0);
  floor.vertices[2].x() = std::nan("");
  EXPECT_THROW(BedScene({}, floor), PhysicsError);
}

}  // namespace
}  // namespace layerloop::raytrace
