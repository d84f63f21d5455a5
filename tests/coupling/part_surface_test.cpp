#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "coupling/part_surface_cgal.hpp"
#include "coupling/surface_level.hpp"
#include "tests/coupling/solid_scenes.hpp"

namespace layerloop::coupling {
namespace {

/// Closed, oriented, without self-intersection, and within 1 % of the volume in the field.
TriangleSurface sound_mesh_of(SolidField const& solid, Case const& checked) {
  TriangleSurface const surface = mesh_solid(solid, checked);
  EXPECT_EQ(count_open_edges(surface), 0);
  EXPECT_NO_THROW(check_substrate(surface));
  EXPECT_NEAR(enclosed_volume(surface) / volume_to_mesh(solid, checked), 1, 0.01);
  return surface;
}

double plate_volume(SolidField const& solid, Case const& checked) {
  SolidField bare = solid;
  std::fill(bare.mass.begin(), bare.mass.end(), 0.0);
  return volume_to_mesh(bare, checked);
}

/// Volume of the part alone, mesh over field.
double part_volume_ratio(TriangleSurface const& surface, SolidField const& solid, Case const& checked) {
  double const plate = plate_volume(solid, checked);
  return (enclosed_volume(surface) - plate) / (volume_to_mesh(solid, checked) - plate);
}

TEST(PartSurface, BarePlateIsExactlyFlatAndCoarse) {
  Case const checked = small_case();
  SolidField const solid = lowered_plate(checked);
  TriangleSurface const surface = sound_mesh_of(solid, checked);
  for (Vec3 const& v : surface.vertices) {
    EXPECT_TRUE(std::abs(v.z() + 30 * um) < 1e-9 || v.z() < -30 * um - 1e-9) << v.transpose();
    EXPECT_LE(v.z(), -30 * um + 1e-18);
  }
  EXPECT_NEAR(enclosed_volume(surface) / plate_volume(solid, checked), 1, 1e-9);
  EXPECT_LT(surface.triangles.size(), 2000u);
  // It reaches beyond the zone by more than the largest radius in y, and into the pit's walls in x.
  auto const reach = [&](int axis, double sign) {
    double far = -1;
    for (Vec3 const& v : surface.vertices) far = std::max(far, sign * v[axis]);
    return sign * far;
  };
  EXPECT_LT(reach(1, -1), -21 * um);
  EXPECT_GT(reach(1, 1), 121 * um);
  EXPECT_LT(reach(0, -1), 120 * um);
  EXPECT_GT(reach(0, 1), 320 * um);
}

/// A plateau of 4.3 cells: the top is flat at the height that the mass gives, part-filled cells included.
TEST(PartSurface, PlateauHasTheHeightOfItsMass) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  fill_field(solid, 8190, [](int i, int j, int k) {
    return i >= 8 && i < 32 && j >= 4 && j < 16 ? std::clamp(4.3 - k, 0.0, 1.0) : 0.0;
  });
  TriangleSurface const surface = sound_mesh_of(solid, checked);
  double highest = -1;
  for (Vec3 const& v : surface.vertices) highest = std::max(highest, v.z());
  EXPECT_NEAR(highest, -30 * um + 4.3 * 5 * um, 1e-9);
  EXPECT_NEAR(part_volume_ratio(surface, solid, checked), 1, 0.01);
  HeightMap const top = top_of_solid(solid, checked);
  EXPECT_NEAR(top.at(20, 10), -30 * um + 4.3 * 5 * um, 1e-15);
  EXPECT_NEAR(top.at(2, 2), -30 * um, 1e-15);
}

TEST(PartSurface, RoughBeadOverThePeriodIsSound) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  auto const height = [](int i, int j) {
    return 4 + 2 * std::sin(0.4 * i) * std::cos(2 * M_PI * j / 20) + 0.7 * std::sin(12.9 * i + 78.2 * j);
  };
  fill_field(solid, 8190,
             [&](int i, int j, int k) { return i >= 8 && i < 32 ? std::clamp(height(i, j) - k, 0.0, 1.0) : 0.0; });
  TriangleSurface const surface = sound_mesh_of(solid, checked);
  EXPECT_NEAR(part_volume_ratio(surface, solid, checked), 1, 0.01);
  // The map of heights and the mesh are one surface: straight below and above each pixel of the bead's inside.
  HeightMap const top = top_of_solid(solid, checked);
  SurfaceDistance const distance(surface);
  for (std::int32_t i = 10; i < 30; i += 3) {
    for (std::int32_t j = 0; j < 20; j += 3) {
      Vec3 const p(120 * um + (i + 0.5) * 5 * um, (j + 0.5) * 5 * um, top.at(i, j));
      EXPECT_LT((distance.closest_point(p) - p).norm(), 0.2 * 5 * um);
    }
  }
}

TEST(PartSurface, BridgeKeepsItsOpeningAndAnIsletIsNotForgotten) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  auto const bridge = [](int i, int j, int k) {
    return j >= 6 && j < 14 && i >= 4 && i < 28 && k < 10 && (k >= 6 || i < 8 || i >= 24);
  };
  auto const islet = [](int i, int j, int k) { return i >= 33 && i < 36 && j >= 9 && j < 12 && k >= 4 && k < 7; };
  fill_field(solid, 8190, [&](int i, int j, int k) { return bridge(i, j, k) || islet(i, j, k) ? 1.0 : 0.0; });
  TriangleSurface const surface = sound_mesh_of(solid, checked);
  EXPECT_NEAR(part_volume_ratio(surface, solid, checked), 1, 0.05);  // edges are rounded over a cell
  auto const at = [](double i, double j, double k) {
    return Vec3(120 * um + i * 5 * um, j * 5 * um, -30 * um + k * 5 * um);
  };
  EXPECT_NEAR(winding_number(at(16, 10, 3), surface), 0, 1e-6) << "under the bridge";
  EXPECT_NEAR(winding_number(at(16, 10, 8), surface), 1, 1e-6) << "in the bridge";
  EXPECT_NEAR(winding_number(at(34.5, 10.5, 5.5), surface), 1, 1e-6) << "in the islet";
}

TEST(PartSurface, EnclosedVoidsAreFilledForTheMeshOnly) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  auto const block = [](int i, int j, int k) { return i >= 8 && i < 20 && j >= 4 && j < 16 && k < 10; };
  auto const hole = [](int i, int j, int k) { return i >= 12 && i < 16 && j >= 8 && j < 12 && k >= 3 && k < 7; };
  fill_field(solid, 8190, [&](int i, int j, int k) { return block(i, j, k) && !hole(i, j, k) ? 1.0 : 0.0; });
  SolidField full = lowered_plate(checked);
  fill_field(full, 8190, [&](int i, int j, int k) { return block(i, j, k) ? 1.0 : 0.0; });
  EXPECT_EQ(sound_mesh_of(solid, checked).vertices, mesh_solid(full, checked).vertices);
  EXPECT_DOUBLE_EQ(part_relative_density(full, 8190), 1);
  EXPECT_NEAR(part_relative_density(solid, 8190), 1 - 64.0 / 1440, 1e-12);
}

TEST(PartSurface, DensityByHeightSeesTheVoidInItsSlicesAndNotTheRim) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  auto const block = [](int i, int j, int k) { return i >= 8 && i < 20 && j >= 4 && j < 16 && k < 10; };
  auto const hole = [](int i, int j, int k) { return i >= 12 && i < 16 && j >= 8 && j < 12 && k >= 3 && k < 7; };
  fill_field(solid, 8190, [&](int i, int j, int k) { return block(i, j, k) && !hole(i, j, k) ? 1.0 : 0.0; });
  Vec3 const origin = solid.grid.origin;
  double const cell = solid.grid.cell;
  // 8 x 8 columns about the hole; its 16 columns are empty from the fourth slice to the seventh, the tenth is the top.
  auto const slices = density_by_height(solid, 8190, origin + cell * Vec3(10, 6, 0), origin + cell * Vec3(18, 14, 0));
  ASSERT_EQ(slices.size(), 9u);
  for (std::size_t k = 0; k < slices.size(); ++k) {
    EXPECT_EQ(slices[k].columns, 64);
    EXPECT_NEAR(slices[k].height, (static_cast<double>(k) + 0.5) * cell, 1e-15);
    EXPECT_NEAR(slices[k].relative_density, k >= 3 && k < 7 ? 0.75 : 1.0, 1e-12) << k;
  }
  EXPECT_TRUE(density_by_height(solid, 8190, origin, origin + cell * Vec3(7, 3, 0)).empty());
}

TEST(PartSurface, SameBitsTwiceAndWhereverThePlateStands) {
  Case const checked = small_case();
  SolidField solid = lowered_plate(checked);
  fill_field(solid, 8190, [](int i, int j, int k) {
    return i >= 8 && i < 32 ? std::clamp(3 + std::sin(i + 2.0 * j) - k, 0.0, 1.0) : 0.0;
  });
  TriangleSurface const first = mesh_solid(solid, checked), second = mesh_solid(solid, checked);
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.triangles, second.triangles);
  lower(solid, 30 * um);
  EXPECT_EQ(mesh_solid(solid, checked).triangles, first.triangles);
}

TriangleSurface box(Vec3 const& low, Vec3 const& high) {
  TriangleSurface surface;
  for (int c = 0; c < 8; ++c)
    surface.vertices.emplace_back(c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(), c & 4 ? high.z() : low.z());
  surface.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return surface;
}

std::string refusal(TriangleSurface const& surface) {
  try {
    check_substrate(surface);
  } catch (InputError const& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CheckSubstrate, RefusesHolesInsideOutAndSelfIntersection) {
  TriangleSurface const good = box(Vec3::Zero(), Vec3(1, 1, 1));
  EXPECT_EQ(refusal(good), "accepted");
  TriangleSurface holed = good;
  holed.triangles.pop_back();
  EXPECT_THAT(refusal(holed), testing::HasSubstr("has 3 edges"));
  TriangleSurface turned = good;
  for (auto& t : turned.triangles) std::swap(t[0], t[1]);
  EXPECT_THAT(refusal(turned), testing::HasSubstr("inside-out"));
  TriangleSurface crossed = good;
  TriangleSurface const second = box(Vec3(0.5, 0.4, 0.3), Vec3(1.5, 0.6, 0.7));
  for (auto t : second.triangles) {
    for (auto& corner : t) corner += 8;
    crossed.triangles.push_back(t);
  }
  crossed.vertices.insert(crossed.vertices.end(), second.vertices.begin(), second.vertices.end());
  EXPECT_THAT(refusal(crossed), testing::HasSubstr("intersects itself"));
}

}  // namespace
}  // namespace layerloop::coupling
