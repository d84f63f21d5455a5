#pragma once
#include <filesystem>

#include "core/triangle_surface.hpp"

namespace layerloop {

/// Reads PLY, ASCII or binary little-endian: x, y, z of `vertex` and the corner list of `face`; polygons are cut into
/// triangles from their first corner. Lengths are in metres. Corners that coincide exactly are merged.
/// \throws FileError cannot be opened; InputError damaged, empty, not finite or big-endian (says where)
TriangleSurface read_ply(std::filesystem::path const& path);

/// Writes binary PLY in metres, double precision, aside and renamed: reading it back gives the same numbers.
void write_ply(TriangleSurface const& surface, std::filesystem::path const& path);

/// STL or PLY, told by the first bytes.
TriangleSurface read_surface(std::filesystem::path const& path);

}  // namespace layerloop
