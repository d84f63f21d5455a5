#include "coupling/report/colour_map.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

namespace layerloop::coupling {
namespace {

using Colour = Eigen::Vector3d;

// Anchors, evenly spaced in t. Between them we go straight in Oklab (Ottosson 2020), where equal steps look equal.
constexpr std::array<std::uint32_t, 6> height_anchors{0x1d1147, 0x1f4e8c, 0x16879b, 0x46b58a, 0xb3d670, 0xfbf3b9};
constexpr std::array<std::uint32_t, 6> heat_anchors{0x0d0a26, 0x4b146e, 0xa42568, 0xe1552f, 0xf9a53a, 0xfdf2b5};

Colour linear_light(std::uint32_t rgb) {
  Colour linear;
  for (int c = 0; c < 3; ++c) {
    double const s = (rgb >> (16 - 8 * c) & 255) / 255.0;
    linear[c] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  }
  return linear;
}

// Linear sRGB to cone response, and its cube root to Oklab.
Eigen::Matrix3d const& to_cones() {
  static Eigen::Matrix3d const m = (Eigen::Matrix3d() << 0.4122214708, 0.5363325363, 0.0514459929, 0.2119034982,
                                    0.6806995451, 0.1073969566, 0.0883024619, 0.2817188376, 0.6299787005)
                                       .finished();
  return m;
}
Eigen::Matrix3d const& to_lab() {
  static Eigen::Matrix3d const m = (Eigen::Matrix3d() << 0.2104542553, 0.7936177850, -0.0040720468, 1.9779984951,
                                    -2.4285922050, 0.4505937099, 0.0259040371, 0.7827717662, -0.8086757660)
                                       .finished();
  return m;
}

Colour oklab(std::uint32_t rgb) {
  Colour const cones = to_cones() * linear_light(rgb);
  return to_lab() * Colour(cones.unaryExpr([](double c) { return std::cbrt(c); }));
}

std::array<std::uint8_t, 3> srgb(Colour const& lab) {
  Colour const cones = Colour((to_lab().inverse() * lab).array().cube());
  Colour const linear = to_cones().inverse() * cones;
  std::array<std::uint8_t, 3> rgb;
  for (int c = 0; c < 3; ++c) {
    double const v = std::clamp(linear[c], 0.0, 1.0);
    double const s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    rgb[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(255 * s));
  }
  return rgb;
}

using Ramp = std::array<std::array<std::uint8_t, 3>, 256>;

Ramp make_ramp(std::span<std::uint32_t const> anchors) {
  Ramp ramp;
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    double const at = static_cast<double>(i) / 255.0 * static_cast<double>(anchors.size() - 1);
    std::size_t const below = std::min(static_cast<std::size_t>(at), anchors.size() - 2);
    double const share = at - static_cast<double>(below);
    ramp[i] = srgb((1 - share) * oklab(anchors[below]) + share * oklab(anchors[below + 1]));
  }
  return ramp;
}

}  // namespace

std::array<std::uint8_t, 3> colour(ColourMap map, double t) {
  static Ramp const height = make_ramp(height_anchors), heat = make_ramp(heat_anchors);
  auto const step = static_cast<std::size_t>(std::lround(255 * std::clamp(t, 0.0, 1.0)));
  return (map == ColourMap::height ? height : heat)[step];
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
