#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace layerloop::raytrace {

/// Red, green, blue as a screen wants them (sRGB).
using Colour = std::array<std::uint8_t, 3>;

/// Perceptually even map from dark violet (0) over teal to yellow (1): viridis of Smith & van der Walt (2015, CC0).
Colour viridis(double value);

/// One colour a value; what lies beyond the range takes the colour of its end. A range of zero width gives the middle
/// colour.
std::vector<Colour> colour_by(std::span<double const> values, double lowest, double highest);

/// Light intensities of a colour, each in [0, 1], and back (IEC 61966-2-1).
std::array<double, 3> linear_light(Colour const& colour);
Colour screen_colour(std::array<double, 3> const& light);

}  // namespace layerloop::raytrace
