#pragma once
#include <cstddef>
#include <string>

#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"

namespace layerloop::coupling {

inline constexpr std::size_t viewer_grain_limit = 200'000, viewer_triangle_limit = 300'000;

/// Bed and part for the interactive view of the report, as JSON that is safe inside a script element: positions, radii
/// and corners as 16-bit numbers over their common box, in um, little-endian and base64. Of a larger bed the grains
/// nearest to the middle of the plate are kept; a mesh beyond the limit is left out. `plate_top`: above it the metal is
/// part [m].
std::string viewer_data(PowderBed const& bed, TriangleSurface const& part, double plate_top);

}  // namespace layerloop::coupling
