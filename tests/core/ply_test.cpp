// PLY: exact round trip, ASCII and binary, what is refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "core/error.hpp"
#include "core/ply_file.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

std::filesystem::path scratch(std::string const& name) {
  return std::filesystem::path(testing::TempDir()) / ("layerloop_" + std::to_string(::getpid()) + "_" + name);
}

TriangleSurface tetrahedron() {
  TriangleSurface s;
  s.vertices = {{0, 0, 0}, {1.0 / 3, 0, 0}, {0, std::sqrt(2.0), 0}, {0, 0, 1e-7}};
  s.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return s;
}

std::string refusal(std::string const& text) {
  auto const path = scratch("bad.ply");
  write_file(path, text);
  try {
    read_ply(path);
  } catch (InputError const& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Ply, RoundTripIsExact) {
  auto const path = scratch("round_trip.ply");
  write_ply(tetrahedron(), path);
  for (TriangleSurface const& read : {read_ply(path), read_surface(path)}) {
    EXPECT_EQ(read.vertices, tetrahedron().vertices);
    EXPECT_EQ(read.triangles, tetrahedron().triangles);
  }
}

TEST(Ply, AsciiWithOtherPropertiesAndPolygons) {
  auto const path = scratch("ascii.ply");
  write_file(path,
             "ply\r\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty float x\nproperty float y\n"
             "property float z\nproperty uchar red\nelement face 2\nproperty list uchar int vertex_index\n"
             "property float quality\nend_header\n0 0 0 255\n1e-3 0 0 0\n1e-3 1e-3 0 0\n0 1e-3 0 0\n-0 0 0 9\n"
             "4 0 1 2 3 0.5\n3 4 2 3 0.25\n");
  TriangleSurface const s = read_ply(path);
  EXPECT_EQ(s.vertices.size(), 4U);  // the fifth is the first
  EXPECT_EQ(s.triangles, (std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 2, 3}}));
}

TEST(Ply, StlIsToldFromPlyByItsBeginning) {
  auto const path = scratch("really_stl.ply");
  write_stl(tetrahedron(), path);
  EXPECT_EQ(read_surface(path).triangles.size(), 4U);
}

TEST(Ply, DamagedFilesAreRefusedWithTheirPlace) {
  std::string const header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  std::string const points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(refusal(header + points + "3 0 1 2\n"), "accepted");
  auto const expect = [](std::string const& text, char const* fragment) {
    EXPECT_NE(refusal(text).find(fragment), std::string::npos) << refusal(text);
  };
  expect(header + points + "3 0 1 7\n", "face 1 names corner 7 (there are 3)");
  expect(header + points + "3 0 1 1\n", "two equal corners");
  expect(header + points + "2 0 1\n", "2 corners");
  expect(header + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "vertex 2 has no finite");
  expect(header + points + "3 0 one 2\n", "found \"one\"");
  expect(header + points, "a number expected in face 1");
  expect("ply\nformat binary_big_endian 1.0\nend_header\n", "big-endian");
  expect("ply\nformat ascii 1.0\nelement vertex 3\n", "without end_header");
  expect("solid\n", "does not begin with \"ply\"");
}

}  // namespace
}  // namespace layerloop
