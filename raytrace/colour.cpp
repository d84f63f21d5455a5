#include "raytrace/colour.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::raytrace {
namespace {

/// viridis at 0, 1/8, ..., 1.
constexpr std::array<Colour, 9> viridis_stops{{{0x44, 0x01, 0x54},
                                               {0x47, 0x2d, 0x7b},
                                               {0x3b, 0x52, 0x8b},
                                               {0x2c, 0x72, 0x8e},
                                               {0x21, 0x91, 0x8c},
                                               {0x28, 0xae, 0x80},
                                               {0x5e, 0xc9, 0x62},
                                               {0xad, 0xdc, 0x30},
                                               {0xfd, 0xe7, 0x25}}};

}  // namespace

Colour viridis(double value) {
  double const position = std::clamp(value, 0.0, 1.0) * (viridis_stops.size() - 1);
  auto const stop = std::min(static_cast<std::size_t>(position), viridis_stops.size() - 2);
  double const share = position - static_cast<double>(stop);
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c) {
    double const mixed = (1 - share) * viridis_stops[stop][c] + share * viridis_stops[stop + 1][c];
    colour[c] = static_cast<std::uint8_t>(std::lround(mixed));
  }
  return colour;
}

std::vector<Colour> colour_by(std::span<double const> values, double lowest, double highest) {
  std::vector<Colour> colours;
  colours.reserve(values.size());
  for (double const v : values) colours.push_back(viridis(highest > lowest ? (v - lowest) / (highest - lowest) : 0.5));
  return colours;
}

std::array<double, 3> linear_light(Colour const& colour) {
  std::array<double, 3> light;
  for (std::size_t c = 0; c < 3; ++c) {
    double const v = colour[c] / 255.0;
    light[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  return light;
}

Colour screen_colour(std::array<double, 3> const& light) {
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c) {
    double const v = std::clamp(light[c], 0.0, 1.0);
    double const shown = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    colour[c] = static_cast<std::uint8_t>(std::lround(255 * shown));
  }
  return colour;
}

}  // namespace layerloop::raytrace
