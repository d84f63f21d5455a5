#include "coupling/report/colour_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "raytrace/colour.hpp"

namespace layerloop::coupling {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

/// Black over violet and orange to pale yellow, at 0, 1/5, ..., 1.
constexpr std::array<Rgb, 6> heat_stops{{{0x0d, 0x0a, 0x26},
                                         {0x4b, 0x14, 0x6e},
                                         {0xa4, 0x25, 0x68},
                                         {0xe1, 0x55, 0x2f},
                                         {0xf9, 0xa5, 0x3a},
                                         {0xfd, 0xf2, 0xb5}}};

Rgb heat(double t) {
  double const at = std::clamp(t, 0.0, 1.0) * (heat_stops.size() - 1);
  std::size_t const below = std::min(static_cast<std::size_t>(at), heat_stops.size() - 2);
  Rgb rgb;
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] = static_cast<std::uint8_t>(
        std::lround(std::lerp(heat_stops[below][c], heat_stops[below + 1][c], at - static_cast<double>(below))));
  return rgb;
}

}  // namespace

std::array<std::uint8_t, 3> colour(ColourMap map, double t) {
  return map == ColourMap::height ? raytrace::viridis(t) : heat(t);
}

std::string hex_colour(std::array<std::uint8_t, 3> const& rgb) {
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

std::string series_colour(std::size_t k, std::size_t n) {
  // Mid lightness, told apart with colour-blind eyes too; legible on light and dark ground.
  static constexpr std::array<char const*, 6> distinct{"#2878b8", "#e07b28", "#2a9d78",
                                                       "#b9509b", "#8a7f1d", "#6a6fd0"};
  if (n <= distinct.size()) return distinct[k];
  return hex_colour(colour(ColourMap::height, 0.15 + 0.6 * static_cast<double>(k) / static_cast<double>(n - 1)));
}

}  // namespace layerloop::coupling
