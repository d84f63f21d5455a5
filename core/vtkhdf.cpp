#include "core/vtkhdf.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace layerloop {
namespace {

// Cell types of VTK (vtkCellType.h).
constexpr std::uint8_t vtk_vertex = 1, vtk_triangle = 5;

std::vector<std::uint64_t> shape_of(std::size_t count) { return {count}; }

std::vector<double> triples(PowderBed const& bed, std::vector<double> const& x, std::vector<double> const& y,
                            std::vector<double> const& z) {
  std::vector<double> xyz(3 * bed.size());
  for (std::size_t i = 0; i < bed.size(); ++i) {
    xyz[3 * i] = x[i];
    xyz[3 * i + 1] = y[i];
    xyz[3 * i + 2] = z[i];
  }
  return xyz;
}

void split(std::vector<double> const& xyz, std::vector<double>& x, std::vector<double>& y, std::vector<double>& z) {
  for (std::size_t i = 0; 3 * i + 2 < xyz.size(); ++i) {
    x.push_back(xyz[3 * i]);
    y.push_back(xyz[3 * i + 1]);
    z.push_back(xyz[3 * i + 2]);
  }
}

void check_length(Field const& field, std::size_t expected) {
  if (field.values.size() != expected)
    throw FileError(fmt::format("field \"{}\" has {} values where {} are needed (a caller's mistake)", field.name,
                                field.values.size(), expected));
}

void describe_vtk(Hdf5Writer& file, std::string_view type) {
  file.group("/VTKHDF");
  file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.attribute("/VTKHDF", "Type", type);
}

/// Grains as vertices first, then the triangles on their own corners.
void write_vtk_cells(Hdf5Writer& file, PowderBed const& bed, TriangleSurface const& substrate) {
  std::vector<double> points = triples(bed, bed.x, bed.y, bed.z);
  for (Vec3 const& v : substrate.vertices) points.insert(points.end(), {v.x(), v.y(), v.z()});
  auto const grains = static_cast<std::int64_t>(bed.size());
  std::vector<std::int64_t> connectivity, offsets{0};
  for (std::int64_t i = 0; i < grains; ++i) {
    connectivity.push_back(i);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  for (auto const& triangle : substrate.triangles) {
    for (std::int32_t corner : triangle) connectivity.push_back(grains + corner);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  std::vector<std::uint8_t> types(bed.size(), vtk_vertex);
  types.resize(bed.size() + substrate.triangles.size(), vtk_triangle);

  auto const one = [&](std::string_view name, std::size_t count) {
    std::int64_t const value = static_cast<std::int64_t>(count);
    file.write(name, std::span<std::int64_t const>(&value, 1), {1});
  };
  one("/VTKHDF/NumberOfPoints", points.size() / 3);
  one("/VTKHDF/NumberOfCells", types.size());
  one("/VTKHDF/NumberOfConnectivityIds", connectivity.size());
  file.write("/VTKHDF/Points", std::span<double const>(points), {points.size() / 3, 3}, "m");
  file.write("/VTKHDF/Connectivity", std::span<std::int64_t const>(connectivity), shape_of(connectivity.size()));
  file.write("/VTKHDF/Offsets", std::span<std::int64_t const>(offsets), shape_of(offsets.size()));
  file.write("/VTKHDF/Types", std::span<std::uint8_t const>(types), shape_of(types.size()));
}

/// One value a point: the grains' values, then zeros on the triangle corners.
void write_vtk_points(Hdf5Writer& file, std::string_view name, std::string_view unit, std::span<double const> values,
                      std::size_t corners) {
  std::vector<double> padded(values.begin(), values.end());
  padded.resize(values.size() + corners, 0.0);
  file.write(fmt::format("/VTKHDF/PointData/{}", name), std::span<double const>(padded), shape_of(padded.size()), unit);
}

}  // namespace

void write_bed_group(Hdf5Writer& file, PowderBed const& bed) {
  auto const n = bed.size();
  auto const triple = [&](std::string_view name, std::vector<double> const& x, std::vector<double> const& y,
                          std::vector<double> const& z, std::string_view unit) {
    file.write(name, std::span<double const>(triples(bed, x, y, z)), {n, 3}, unit);
  };
  file.group("/bed");
  file.write("/bed/id", std::span<std::int64_t const>(bed.id), {n});
  triple("/bed/position", bed.x, bed.y, bed.z, "m");
  triple("/bed/velocity", bed.vx, bed.vy, bed.vz, "m/s");
  triple("/bed/angular_velocity", bed.wx, bed.wy, bed.wz, "rad/s");
  file.write("/bed/radius", std::span<double const>(bed.radius), {n}, "m");
  file.write("/bed/material", std::span<std::int32_t const>(bed.material), {n});

  std::vector<std::int64_t> keys;
  std::vector<double> springs, turns;
  for (ContactSpring const& contact : bed.contacts) {
    keys.insert(keys.end(), {contact.key_a, contact.key_b});
    springs.insert(springs.end(), contact.spring.begin(), contact.spring.end());
    turns.insert(turns.end(), contact.turn.begin(), contact.turn.end());
  }
  file.write("/bed/contact_keys", std::span<std::int64_t const>(keys), {bed.contacts.size(), 2});
  file.write("/bed/contact_spring", std::span<double const>(springs), {bed.contacts.size(), 3}, "m");
  file.write("/bed/contact_turn", std::span<double const>(turns), {bed.contacts.size(), 3}, "rad");
}

PowderBed read_bed_group(Hdf5Reader const& file) {
  PowderBed bed;
  bed.id = file.read_int64("/bed/id");
  split(file.read_doubles("/bed/position"), bed.x, bed.y, bed.z);
  split(file.read_doubles("/bed/velocity"), bed.vx, bed.vy, bed.vz);
  split(file.read_doubles("/bed/angular_velocity"), bed.wx, bed.wy, bed.wz);
  bed.radius = file.read_doubles("/bed/radius");
  bed.material = file.read_int32("/bed/material");
  std::vector<std::int64_t> const keys = file.read_int64("/bed/contact_keys");
  std::vector<double> const springs = file.read_doubles("/bed/contact_spring"),
                            turns = file.read_doubles("/bed/contact_turn");

  std::size_t const n = bed.size(), contacts = keys.size() / 2;
  bool const whole = bed.x.size() == n && bed.vx.size() == n && bed.wx.size() == n && bed.radius.size() == n &&
                     bed.material.size() == n && keys.size() == 2 * contacts && springs.size() == 3 * contacts &&
                     turns.size() == 3 * contacts;
  bool const ascending = std::adjacent_find(bed.id.begin(), bed.id.end(), std::greater_equal<>{}) == bed.id.end();
  if (!whole || !ascending)
    throw FileError("group /bed is damaged (its datasets do not belong together); go back to an earlier file");
  for (std::size_t c = 0; c < contacts; ++c)
    bed.contacts.push_back({keys[2 * c],
                            keys[2 * c + 1],
                            {springs[3 * c], springs[3 * c + 1], springs[3 * c + 2]},
                            {turns[3 * c], turns[3 * c + 1], turns[3 * c + 2]}});
  return bed;
}

void write_surface_group(Hdf5Writer& file, TriangleSurface const& surface) {
  std::vector<double> vertices;
  for (Vec3 const& v : surface.vertices) vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
  std::vector<std::int32_t> corners;
  for (auto const& triangle : surface.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  file.write("/substrate/vertices", std::span<double const>(vertices), {surface.vertices.size(), 3}, "m");
  file.write("/substrate/triangles", std::span<std::int32_t const>(corners), {surface.triangles.size(), 3});
}

TriangleSurface read_surface_group(Hdf5Reader const& file) {
  TriangleSurface surface;
  std::vector<double> const vertices = file.read_doubles("/substrate/vertices");
  for (std::size_t v = 0; v + 2 < vertices.size(); v += 3)
    surface.vertices.emplace_back(vertices[v], vertices[v + 1], vertices[v + 2]);
  auto const count = static_cast<std::int32_t>(surface.vertices.size());
  std::vector<std::int32_t> const corners = file.read_int32("/substrate/triangles");
  bool const inside = std::all_of(corners.begin(), corners.end(), [&](std::int32_t c) { return c >= 0 && c < count; });
  if (vertices.size() % 3 != 0 || corners.size() % 3 != 0 || !inside)
    throw FileError(
        "group /substrate is damaged (a triangle names a corner that does not exist); go back to an earlier file");
  for (std::size_t t = 0; t < corners.size(); t += 3)
    surface.triangles.push_back({corners[t], corners[t + 1], corners[t + 2]});
  return surface;
}

void write_bed_file(std::filesystem::path const& path, PowderBed const& bed, TriangleSurface const& substrate,
                    std::span<Field const> fields) {
  for (Field const& field : fields) check_length(field, bed.size());
  Hdf5Writer file(path);
  write_bed_group(file, bed);
  write_surface_group(file, substrate);
  for (Field const& field : fields) file.write("/fields/" + field.name, field.values, {bed.size()}, field.unit);

  describe_vtk(file, "UnstructuredGrid");
  write_vtk_cells(file, bed, substrate);
  std::size_t const corners = substrate.vertices.size();
  std::vector<double> const id(bed.id.begin(), bed.id.end()), material(bed.material.begin(), bed.material.end());
  write_vtk_points(file, "radius", "m", bed.radius, corners);
  write_vtk_points(file, "id", "", id, corners);
  write_vtk_points(file, "material", "", material, corners);
  for (Field const& field : fields) write_vtk_points(file, field.name, field.unit, field.values, corners);
  file.commit();
}

void write_grid_file(std::filesystem::path const& path, VoxelGrid const& grid, std::span<Field const> fields) {
  for (Field const& field : fields) check_length(field, static_cast<std::size_t>(grid.size()));
  Hdf5Writer file(path);
  std::vector<double> const origin(grid.origin.data(), grid.origin.data() + 3);
  file.write("/grid/origin", std::span<double const>(origin), {3}, "m");
  file.write("/grid/cell", std::span<double const>(&grid.cell, 1), {1}, "m");
  file.write("/grid/cells", std::span<std::int32_t const>(grid.n), {3});

  // VTK 9.1 reads no cell data of images, so cell centres become the points of the image.
  describe_vtk(file, "ImageData");
  Vec3 const first = grid.centre(0, 0, 0);
  file.attribute("/VTKHDF", "WholeExtent",
                 std::vector<std::int64_t>{0, grid.n[0] - 1, 0, grid.n[1] - 1, 0, grid.n[2] - 1});
  file.attribute("/VTKHDF", "Origin", std::vector<double>{first.x(), first.y(), first.z()});
  file.attribute("/VTKHDF", "Spacing", std::vector<double>{grid.cell, grid.cell, grid.cell});
  file.attribute("/VTKHDF", "Direction", std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  file.group("/VTKHDF/PointData");
  std::vector<std::uint64_t> const shape{static_cast<std::uint64_t>(grid.n[2]), static_cast<std::uint64_t>(grid.n[1]),
                                         static_cast<std::uint64_t>(grid.n[0])};
  for (Field const& field : fields) file.write("/VTKHDF/PointData/" + field.name, field.values, shape, field.unit);
  file.commit();
}

}  // namespace layerloop
