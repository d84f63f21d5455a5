#include "core/triangle_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

TriangleSurface cube(double edge, Vec3 const& corner) {
  TriangleSurface surface;
  for (int c = 0; c < 8; ++c) surface.vertices.push_back(corner + edge * Vec3(c & 1, (c >> 1) & 1, (c >> 2) & 1));
  surface.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return surface;
}

std::filesystem::path scratch(std::string const& name) {
  return std::filesystem::path(testing::TempDir()) / ("layerloop_" + std::to_string(::getpid()) + "_" + name);
}

std::string refusal(std::filesystem::path const& path) {
  try {
    read_stl(path);
  } catch (InputError const& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TriangleSurface, CubeEnclosesItsEdgeCubedWhereverItLies) {
  EXPECT_NEAR(enclosed_volume(cube(2e-5, Vec3::Zero())) / 8e-15, 1, 1e-12);
  EXPECT_NEAR(enclosed_volume(cube(2e-5, Vec3(0.01, -0.02, 0.03))) / 8e-15, 1, 1e-9);
}

TEST(TriangleSurface, NormalsPointOutOfTheCube) {
  TriangleSurface const surface = cube(1, Vec3::Zero());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Vec3 const out = surface.corner(t, 0) + surface.corner(t, 1) + surface.corner(t, 2) - Vec3(1.5, 1.5, 1.5);
    EXPECT_GT(surface.normal(t).dot(out), 0);
    EXPECT_NEAR(surface.normal(t).norm(), 1, 1e-15);
  }
}

TEST(TriangleSurface, OpenEdgesAreCounted) {
  TriangleSurface surface = cube(1, Vec3::Zero());
  EXPECT_EQ(count_open_edges(surface), 0);
  surface.triangles.pop_back();  // a hole with three edges
  EXPECT_EQ(count_open_edges(surface), 3);
  surface = cube(1, Vec3::Zero());
  std::swap(surface.triangles[0][0], surface.triangles[0][1]);  // turned: every edge of it meets a twin of equal sense
  EXPECT_EQ(count_open_edges(surface), 6);
}

TEST(Stl, BinaryRoundTripKeepsFloatsAndMergesCorners) {
  auto const path = scratch("round.stl");
  TriangleSurface written = cube(0.5, Vec3(1, 2, 3));  // exact in single precision
  write_stl(written, path);
  TriangleSurface const read = read_stl(path);
  ASSERT_EQ(read.vertices.size(), 8u);
  ASSERT_EQ(read.triangles.size(), 12u);
  for (std::size_t t = 0; t < 12; ++t) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(read.corner(t, c), written.corner(t, c));
  }
  EXPECT_EQ(count_open_edges(read), 0);
}

TEST(Stl, AsciiIsRead) {
  auto const path = scratch("ascii.stl");
  write_file(path,
             "solid a name with words\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1e-5 0 0\n  vertex 0 "
             "+1e-5 -0\n"
             " endloop\nendfacet\nendsolid a name\n");
  TriangleSurface const read = read_stl(path);
  ASSERT_EQ(read.triangles.size(), 1u);
  EXPECT_EQ(read.corner(0, 2), Vec3(0, 1e-5, 0));
  EXPECT_EQ(read.normal(0), Vec3(0, 0, 1));
}

TEST(Stl, DamagedFilesAreRefusedBeforeAnythingIsAllocated) {
  auto const path = scratch("broken.stl");
  write_stl(cube(1, Vec3::Zero()), path);
  std::string const good = read_file(path);
  auto const with = [&](std::function<void(std::string&)> const& damage) {
    std::string bytes = good;
    damage(bytes);
    write_file(path, bytes);
    return refusal(path);
  };
  EXPECT_THAT(with([](std::string& b) { b.resize(b.size() - 1); }), testing::HasSubstr("damaged"));
  EXPECT_THAT(with([](std::string& b) { std::memset(b.data() + 80, 0xff, 4); }),
              testing::HasSubstr("4294967295 triangles"));
  EXPECT_THAT(with([](std::string& b) { b.resize(20); }), testing::HasSubstr("too few"));
  EXPECT_THAT(with([](std::string& b) {
                b.resize(84);
                std::memset(b.data() + 80, 0, 4);
              }),
              testing::HasSubstr("no triangle"));
  EXPECT_THAT(with([](std::string& b) {
                float const nan = std::nanf("");
                std::memcpy(b.data() + 84 + 50 * 3 + 12, &nan, 4);
              }),
              testing::HasSubstr("triangle 4 has a corner that is not a finite number"));
  EXPECT_THAT(with([](std::string& b) { std::memcpy(b.data() + 84 + 12, b.data() + 84 + 24, 12); }),
              testing::HasSubstr("two equal corners"));
  EXPECT_THAT(with([](std::string& b) { b = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"; }),
              testing::HasSubstr(":4:"));
  EXPECT_THROW(read_stl(scratch("absent.stl")), FileError);
}

}  // namespace
}  // namespace layerloop
