#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/vec3.hpp"

namespace layerloop {

/// A triangulated surface: substrate, part, or any wall. Normals point out of the solid (counter-clockwise corners).
struct TriangleSurface {
  std::vector<Vec3> vertices;                          ///< [m]
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< corners, index into vertices

  Vec3 const& corner(std::size_t t, int c) const {
    return vertices[static_cast<std::size_t>(triangles[t][static_cast<std::size_t>(c)])];
  }
  Vec3 normal(std::size_t t) const;  ///< outward unit normal
  void shift(Vec3 const& by);
};

/// Volume enclosed [m^3] (divergence theorem). \pre the surface is closed and oriented
double enclosed_volume(TriangleSurface const& surface);

/// Number of directed edges without exactly one opposite twin: 0 for a closed, oriented, manifold-edged surface.
std::int64_t count_open_edges(TriangleSurface const& surface);

/// Reads STL, binary or ASCII; lengths in the file are in metres. Corners that coincide exactly are merged.
/// \throws FileError cannot be opened; InputError damaged, empty or not finite (says where)
TriangleSurface read_stl(std::filesystem::path const& path);

/// Writes binary STL in metres, aside and renamed.
void write_stl(TriangleSurface const& surface, std::filesystem::path const& path);

}  // namespace layerloop
