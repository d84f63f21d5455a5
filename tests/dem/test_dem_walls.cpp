// Rounded blocks and triangle meshes: shapes, seams, history across triangles, the period.
#include <gtest/gtest.h>

#include <cmath>

#include "support.hpp"

namespace layerloop::dem {
namespace {
using namespace test;
constexpr double radius = 12.5e-6;

TEST(RoundedBlock, DistanceAndNormal) {
  RoundedBlock const block{"block", 0, 100e-6, 0, 50e-6, 10e-6, 0};
  auto const expect = [&](double x, double z, double distance, double nx, double nz) {
    WallPoint const near = nearest(block, x, z);
    EXPECT_NEAR(near.distance, distance, 1e-18);
    EXPECT_NEAR(near.nx, nx, 1e-12);
    EXPECT_NEAR(near.nz, nz, 1e-12);
  };
  double const s = std::sqrt(0.5);
  expect(50e-6, 60e-6, 10e-6, 0, 1);
  expect(-5e-6, 20e-6, 5e-6, -1, 0);
  expect(110e-6, 60e-6, 20e-6 * std::sqrt(2.0) - 10e-6, s, s);  // corner: centre of the arc at (90, 40) um
  expect(50e-6, 45e-6, -5e-6, 0, 1);                            // inside
  expect(20e-6, 25e-6, -20e-6, -1, 0);
  EXPECT_NEAR(nearest(block, 25e-6 - 30e-6, 20e-6).distance, 5e-6, 1e-18);  // moved by 30 um
}

/// Velocity after an impact on a wall.
Vec3 rebound(Rig const& rig, Vec3 const& from, Vec3 const& velocity, ContactSettings const& contact) {
  PowderBed bed;
  bed.add(0, from, radius, 0);
  set_velocity(bed, 0, velocity);
  Simulation simulation(motion(contact, radius), rig, alone());
  simulation.scatter(bed);
  simulation.advance(static_cast<std::int64_t>(20e-6 / simulation.time_step()));
  bed = simulation.gather();
  EXPECT_TRUE(bed.contacts.empty());
  return {bed.vx[0], bed.vy[0], bed.vz[0]};
}

TEST(RoundedBlock, EdgeReturnsRestitutionAlongItsNormal) {
  ContactSettings contact = plain_contact();
  contact.time_step_fraction = 0.02;
  Rig rig = empty_space();
  rig.walls.blocks = {{"block", 0, 100e-6, -100e-6, 0, 10e-6, 0}};
  Vec3 const out = Vec3(-1, 0, 1).normalized(), arc(10e-6, 50e-6, -10e-6);
  Vec3 const after = rebound(rig, arc + (10e-6 + 1.001 * radius) * out, -0.1 * out, contact);
  EXPECT_LT((after - 0.07 * out).norm(), 2e-3 * 0.1);
}

/// Flat surface at z = 0 cut into triangles of uneven shape, closed below.
TriangleSurface uneven_plate(double cell) {
  TriangleSurface plate;
  constexpr int n = 24;
  auto const row = [&](int i, int j, int level) {
    return static_cast<std::int32_t>(level * (n + 1) * (n + 1) + i + (n + 1) * j);
  };
  for (int level = 0; level < 2; ++level)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        bool const inner = i > 0 && i < n && j > 0 && j < n;
        double const dx = inner ? 0.3 * std::sin(7.0 * i + 3.0 * j) : 0,
                     dy = inner ? 0.3 * std::sin(5.0 * j - 2.0 * i) : 0;
        plate.vertices.emplace_back((i - 2 + dx) * cell, (j - n / 2 + dy) * cell + 50e-6, level == 1 ? 0.0 : -50e-6);
      }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      plate.triangles.push_back({row(i, j, 1), row(i + 1, j, 1), row(i + 1, j + 1, 1)});
      plate.triangles.push_back({row(i, j, 1), row(i + 1, j + 1, 1), row(i, j + 1, 1)});
      plate.triangles.push_back({row(i, j, 0), row(i + 1, j + 1, 0), row(i + 1, j, 0)});
      plate.triangles.push_back({row(i, j, 0), row(i, j + 1, 0), row(i + 1, j + 1, 0)});
    }
  for (int i = 0; i < n; ++i) {
    plate.triangles.push_back({row(i, 0, 0), row(i + 1, 0, 0), row(i + 1, 0, 1)});
    plate.triangles.push_back({row(i, 0, 0), row(i + 1, 0, 1), row(i, 0, 1)});
    plate.triangles.push_back({row(i, n, 0), row(i + 1, n, 1), row(i + 1, n, 0)});
    plate.triangles.push_back({row(i, n, 0), row(i, n, 1), row(i + 1, n, 1)});
    plate.triangles.push_back({row(0, i, 0), row(0, i, 1), row(0, i + 1, 1)});
    plate.triangles.push_back({row(0, i, 0), row(0, i + 1, 1), row(0, i + 1, 0)});
    plate.triangles.push_back({row(n, i, 0), row(n, i + 1, 1), row(n, i, 1)});
    plate.triangles.push_back({row(n, i, 0), row(n, i + 1, 0), row(n, i + 1, 1)});
  }
  return plate;
}

/// A grain that bounces, slides and rolls along x.
PowderBed travel(Rig rig, double y) {
  ContactSettings contact = plain_contact();
  contact.cohesion = Cohesion::sjkr2;
  contact.rolling_friction = 0.15;
  rig.gravity = {0, 0, -standard_gravity};
  PowderBed bed;
  bed.add(5, {0, y, 1.01 * radius}, radius, 0);
  set_velocity(bed, 0, {0.03, 0.002, -0.002});
  Simulation simulation(motion(contact, radius), rig, alone());
  simulation.scatter(bed);
  simulation.advance(60000);
  return simulation.gather();
}

TEST(TriangleMesh, RollingOverSeamsEqualsThePlane) {
  TriangleSurface const plate = uneven_plate(5e-6);
  ASSERT_EQ(count_open_edges(plate), 0);
  Rig plane = empty_space(), mesh = empty_space();
  plane.walls.blocks = {floor_block()};
  mesh.walls.substrate = plate;
  PowderBed const on_plane = travel(plane, 50.3e-6), on_mesh = travel(mesh, 50.3e-6);
  EXPECT_GT(on_plane.x[0], 30e-6);  // over a dozen triangles
  ASSERT_EQ(on_mesh.contacts.size(), 1U);
  ASSERT_EQ(on_plane.contacts.size(), 1U);
  EXPECT_NEAR(on_mesh.x[0], on_plane.x[0], 1e-15);
  EXPECT_NEAR(on_mesh.z[0], on_plane.z[0], 1e-16);
  EXPECT_NEAR(on_mesh.vx[0], on_plane.vx[0], 1e-10);
  EXPECT_NEAR(on_mesh.wy[0], on_plane.wy[0], 1e-5);
  for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(on_mesh.contacts[0].spring[d], on_plane.contacts[0].spring[d], 1e-17);
}

TEST(TriangleMesh, RollingOverALongDiagonalEqualsThePlane) {
  Rig plane = empty_space(), mesh = empty_space();
  plane.walls.blocks = {floor_block()};
  mesh.walls.substrate = box({-30e-6, 0, -50e-6}, {100e-6, 100e-6, 0});  // the diagonal of the top crosses the path
  PowderBed const on_plane = travel(plane, 30e-6), on_mesh = travel(mesh, 30e-6);
  EXPECT_NEAR(on_mesh.x[0], on_plane.x[0], 1e-15);
  EXPECT_NEAR(on_mesh.z[0], on_plane.z[0], 1e-16);
}

TEST(TriangleMesh, ConvexEdgeAndCornerPushOnce) {
  TriangleSurface const cube = box({0, 0, -100e-6}, {100e-6, 100e-6, 0});
  double const depth = 0.1e-6;
  for (Vec3 const& out : {Vec3(Vec3(-1, 0, 1).normalized()), Vec3(Vec3(-1, -1, 1).normalized())}) {
    Vec3 const corner = out.y() < 0 ? Vec3(0, 0, 0) : Vec3(0, 40e-6, 0);
    Vec3 const centre = corner + (radius - depth) * out;
    std::vector<TriangleContact> contacts;
    for (std::int32_t t = 0; t < 12; ++t) {
      TriangleContact const contact = contact_with(cube, t, centre);
      if (std::abs(contact.distance) < radius) contacts.push_back(contact);
    }
    EXPECT_GE(contacts.size(), 2U);
    merge_contacts(cube, contacts);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].distance, radius - depth, 1e-18);
    EXPECT_NEAR(contacts[0].normal.dot(out), 1, 1e-12);
  }
}

TEST(TriangleMesh, ConcaveCornerPushesFromBothSides) {
  // floor z = 0 and wall x = 0 that share an edge: an open book is enough for the contact search
  TriangleSurface book;
  book.vertices = {{0, -1e-3, 0}, {0, 1e-3, 0}, {1e-3, -1e-3, 0}, {1e-3, 1e-3, 0}, {0, -1e-3, 1e-3}, {0, 1e-3, 1e-3}};
  book.triangles = {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}};
  Vec3 const centre(radius - 0.1e-6, 0, radius - 0.2e-6);
  std::vector<TriangleContact> contacts;
  for (std::int32_t t = 0; t < 4; ++t) {
    TriangleContact const contact = contact_with(book, t, centre);
    if (std::abs(contact.distance) < radius) contacts.push_back(contact);
  }
  merge_contacts(book, contacts);
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_NEAR(contacts[0].normal.z(), 1, 1e-12);
  EXPECT_NEAR(contacts[1].normal.x(), 1, 1e-12);
}

TEST(TriangleMesh, NearestPointAgreesWithSampling) {
  Vec3 const a(0, 0, 0), b(3, 0.2, 0.1), c(0.4, 2, -0.3);
  for (int k = 0; k < 60; ++k) {
    Vec3 const p(4 * std::sin(1.7 * k), 3 * std::cos(2.3 * k), 2 * std::sin(0.9 * k + 1));
    double sampled = 1e9;
    constexpr int n = 400;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        sampled = std::min(sampled, (p - (a + double(i) / n * (b - a) + double(j) / n * (c - a))).norm());
    double const found = (p - nearest_on_triangle(a, b, c, p).point).norm();
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_NEAR(found, sampled, 0.01);
  }
}

TEST(TriangleMesh, GridFindsWhatABruteForceSearchFinds) {
  TriangleSurface const plate = uneven_plate(5e-6);
  TriangleGrid const grid(plate, 17e-6);
  std::vector<std::int32_t> found;
  for (int k = 0; k < 200; ++k) {
    Vec3 const p(60e-6 * std::sin(1.3 * k) + 40e-6, 60e-6 * std::cos(2.1 * k) + 50e-6, 20e-6 * std::sin(0.7 * k));
    double const reach = 14e-6;
    grid.find(p, reach, found);
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(plate.triangles.size()); ++t) {
      if (std::abs(contact_with(plate, t, p).distance) < reach) {
        EXPECT_TRUE(std::ranges::binary_search(found, t)) << k << ' ' << t;
      }
    }
  }
}

TEST(Period, CollisionAcrossItEqualsOneWithin) {
  ContactSettings contact = plain_contact();
  contact.cohesion = Cohesion::sjkr2;
  Rig rig = empty_space();
  rig.width = 100e-6;
  auto const run = [&](double y) {
    auto const wrapped = [&](double value) { return value - rig.width * std::floor(value / rig.width); };
    PowderBed bed;
    bed.add(0, {0, wrapped(y - radius - 0.3e-6), 0}, radius, 0);
    bed.add(1, {2e-6, wrapped(y + radius + 0.3e-6), 3e-6}, radius, 0);
    set_velocity(bed, 0, {0, 0.1, 0});
    set_velocity(bed, 1, {0, -0.05, 0.01});
    Simulation simulation(motion(contact, radius), rig, alone());
    simulation.scatter(bed);
    simulation.advance(1500);
    EXPECT_GT(simulation.largest_overlap(), 1e-3);
    return simulation.gather();
  };
  PowderBed const within = run(50e-6), across = run(0);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(across.vx[i], within.vx[i], 1e-10);
    EXPECT_NEAR(across.vy[i], within.vy[i], 1e-10);
    EXPECT_NEAR(across.wz[i], within.wz[i], 1e-5);
    EXPECT_GE(across.y[i], 0);
    EXPECT_LT(across.y[i], rig.width);
  }
}

}  // namespace
}  // namespace layerloop::dem
