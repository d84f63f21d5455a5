#include "coupling/report/svg_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/png_image.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/svg_plot.hpp"

namespace layerloop::coupling {
namespace {

constexpr double longest_aspect = 11;  ///< a longer map is stretched across, and says so
constexpr double tallest = 460;        ///< [px]

std::string embedded_png(Image const& image) { return "data:image/png;base64," + base64(encode_png(image)); }

/// One pixel a cell, north up.
Image picture(Raster const& raster, ColourScale const& scale) {
  Image image{raster.nx, raster.ny, {}};
  image.rgb.reserve(3 * raster.values.size());
  for (int j = raster.ny - 1; j >= 0; --j) {
    for (int i = 0; i < raster.nx; ++i) {
      double const value = raster.at(i, j);
      std::array<std::uint8_t, 3> rgb{226, 231, 236};
      if (std::isfinite(value)) rgb = colour(scale.map, (value - scale.low) / (scale.high - scale.low));
      image.rgb.insert(image.rgb.end(), rgb.begin(), rgb.end());
    }
  }
  return image;
}

std::string colour_bar(Raster const& raster, ColourScale const& scale, Frame const& map) {
  Image ramp{256, 1, {}};
  for (int i = 0; i < 256; ++i) {
    auto const rgb = colour(scale.map, i / 255.0);
    ramp.rgb.insert(ramp.rgb.end(), rgb.begin(), rgb.end());
  }
  double const width = std::min(280.0, 0.55 * map.width), left = map.left + map.width - width - 10, top = 20,
               height = 11;
  Frame const bar{left, top, width, height, scale.low, scale.high, 0, 1};
  std::string drawn = fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"label\">{}</text><image href=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" "
      "width=\"{:.1f}\" "
      "height=\"{:.1f}\" preserveAspectRatio=\"none\"/>",
      map.left, top + 10, escape(scale.label), embedded_png(ramp), left, top, width, height);
  Ticks const ticks = round_ticks(scale.low, scale.high, std::max(2, static_cast<int>(width / 62)));
  for (double value : ticks.at) {
    drawn += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}v4\" class=\"axis\"/><text x=\"{0:.1f}\" y=\"{2:.1f}\" "
        "text-anchor=\"middle\">{3}</text>",
        bar.x(value), top + height, top + height + 16, ticks.label(value));
  }
  // A pointed end says that there are values beyond.
  auto const beyond = [&](auto test) { return std::any_of(raster.values.begin(), raster.values.end(), test); };
  auto const tip = [&](double x, double length, double t) {
    drawn += fmt::format("<path d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}z\" fill=\"{}\"/>", x, top, length,
                         height / 2, -length, height / 2, hex_colour(colour(scale.map, t)));
  };
  if (beyond([&](double v) { return v < scale.low; })) tip(left, -9, 0);
  if (beyond([&](double v) { return v > scale.high; })) tip(left + width, 9, 1);
  if (!scale.mark_label.empty() && scale.mark > scale.low && scale.mark < scale.high)
    drawn += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}v{2:.1f}\" class=\"mark\"/><text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\" "
        "class=\"legend\">{4}</text>",
        bar.x(scale.mark), top - 4, height + 4, top - 7, escape(scale.mark_label));
  return drawn;
}

/// Edges between cells that differ, runs joined, as one path.
std::string outline_path(Raster const& raster, Outline const& outline, Frame const& map) {
  auto const inside = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < raster.nx && j < raster.ny && outline.inside(i, j);
  };
  auto const x = [&](int i) { return map.x(raster.x0 + raster.cell * i); };
  auto const y = [&](int j) { return map.y(raster.y0 + raster.cell * j); };
  std::string path;
  for (int j = 0; j <= raster.ny; ++j) {
    for (int i = 0; i < raster.nx; ++i) {
      int const begin = i;
      while (i < raster.nx && inside(i, j) != inside(i, j - 1)) ++i;
      if (i > begin) path += fmt::format("M{:.1f} {:.1f}H{:.1f}", x(begin), y(j), x(i));
    }
  }
  for (int i = 0; i <= raster.nx; ++i) {
    for (int j = 0; j < raster.ny; ++j) {
      int const begin = j;
      while (j < raster.ny && inside(i, j) != inside(i - 1, j)) ++j;
      if (j > begin) path += fmt::format("M{:.1f} {:.1f}V{:.1f}", x(i), y(begin), y(j));
    }
  }
  return fmt::format("<path d=\"{}\" class=\"{}\"/>", path, outline.css);
}

}  // namespace

Raster crop(Raster const& raster, int i0, int i1, int j0, int j1) {
  i0 = std::clamp(i0, 0, raster.nx), i1 = std::clamp(i1, i0, raster.nx);
  j0 = std::clamp(j0, 0, raster.ny), j1 = std::clamp(j1, j0, raster.ny);
  Raster part{raster.x0 + raster.cell * i0, raster.y0 + raster.cell * j0, raster.cell, i1 - i0, j1 - j0, {}};
  for (int j = j0; j < j1; ++j)
    for (int i = i0; i < i1; ++i) part.values.push_back(raster.at(i, j));
  return part;
}

std::string map_plot(Raster const& raster, ColourScale const& scale, std::string const& x_label,
                     std::string const& y_label, std::vector<Outline> const& outlines, double width) {
  double const left = plot_left, top = 52, right = 12, bottom = 48;
  double const size_x = raster.cell * raster.nx, size_y = raster.cell * raster.ny;
  double map_width = width - left - right, map_height = map_width * size_y / size_x;
  double const stretch = std::max(1.0, size_x / size_y / longest_aspect);
  map_height *= stretch;
  if (map_height > tallest) {
    map_width *= tallest / map_height;
    width = std::max(map_width, 260.0) + left + right;
    map_height = tallest;
  }
  Frame const map{left, top, map_width, map_height, raster.x0, raster.x0 + size_x, raster.y0, raster.y0 + size_y};
  std::string content = colour_bar(raster, scale, Frame{left, top, width - left - right, 0, 0, 1, 0, 1});
  content += fmt::format(
      "<image href=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" preserveAspectRatio=\"none\" "
      "class=\"pixels\"/>",
      embedded_png(picture(raster, scale)), map.left, map.top, map.width, map.height);
  for (Outline const& outline : outlines) content += outline_path(raster, outline, map);
  std::string const across = stretch > 1 ? fmt::format("{} (stretched {:.1f} times)", y_label, stretch) : y_label;
  content += y_axis(map, across, GridLines::none) + x_axis(map, x_label, x_ticks(map));
  return svg(width, top + map_height + bottom, scale.label, content);
}

std::vector<double> quantiles(std::vector<double> values, std::vector<double> const& shares) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  std::sort(values.begin(), values.end());
  std::vector<double> found;
  for (double share : shares)
    found.push_back(
        values.empty() ? 0
                       : values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))]);
  return found;
}

}  // namespace layerloop::coupling
