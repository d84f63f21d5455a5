#pragma once
#include <array>
#include <cstdint>
#include <string>

namespace layerloop::coupling {

/// height: the map of the bed pictures (raytrace/colour.hpp); heat: for light and temperature.
enum class ColourMap { height, heat };

/// Colour at t in [0, 1], clamped: lightness rises with t, so that the maps also read in grey.
std::array<std::uint8_t, 3> colour(ColourMap map, double t);

/// "#rrggbb"
std::string hex_colour(std::array<std::uint8_t, 3> const& rgb);

/// Line colour of series k of n: distinct hues for a few, a ramp for many.
std::string series_colour(std::size_t k, std::size_t n);

}  // namespace layerloop::coupling
