#include "coupling/report/processing_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/png_image.hpp"
#include "coupling/report/colour_map.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/svg_plot.hpp"

namespace layerloop::coupling {
namespace {

constexpr double plot_width = 760, plot_height = 470, plot_top = 40, right_margin = 74;
constexpr int columns = 640, rows = 380;  ///< of the coloured map

/// Upper ends of the bands of relative density; beyond the last one Q <= 1.
constexpr std::array<double, 5> band_ends{0.90, 0.95, 0.98, 0.99, 1.0};

std::size_t band_of(double density, double q) {
  if (q <= 1) return band_ends.size();
  return static_cast<std::size_t>(std::ranges::lower_bound(band_ends, density) - band_ends.begin());
}
std::array<std::uint8_t, 3> band_colour(std::size_t band) {
  return colour(ColourMap::height, 0.08 + 0.9 * static_cast<double>(band) / static_cast<double>(band_ends.size()));
}
std::string band_words(std::size_t band) {
  if (band == band_ends.size()) return "Q &#8804; 1: joined";
  if (band == 0) return fmt::format("&lt; {:g} %", 100 * band_ends[0]);
  return fmt::format("{:g} to {:g} %", 100 * band_ends[band - 1], 100 * band_ends[band]);
}

std::vector<double> distinct(ProcessingWindow const& window, double WindowPoint::*key) {
  std::vector<double> values;
  for (WindowPoint const& point : window.points) values.push_back(point.*key);
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// The points as a table of all combinations.
struct Lattice {
  std::vector<double> power, speed;
  std::vector<WindowPoint const*> at;  ///< shape (power, speed), speed fastest

  /// Pool between the points; nothing beyond them.
  std::optional<PoolArray> pool(ProcessingWindow const& window, double P, double v) const {
    if (P < power.front() || P > power.back() || v < speed.front() || v > speed.back()) return std::nullopt;
    auto const cell = [](std::vector<double> const& axis, double value) {
      auto const above = std::ranges::upper_bound(axis, value) - axis.begin();
      return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(axis) - 2));
    };
    std::size_t const i = cell(power, P), j = cell(speed, v);
    double const s = (P - power[i]) / (power[i + 1] - power[i]), t = (v - speed[j]) / (speed[j + 1] - speed[j]);
    auto const between = [&](double WindowPoint::*size) {
      auto const corner = [&](std::size_t a, std::size_t b) { return at[(i + a) * speed.size() + j + b]->*size; };
      return std::lerp(std::lerp(corner(0, 0), corner(0, 1), t), std::lerp(corner(1, 0), corner(1, 1), t), s);
    };
    return PoolArray{between(&WindowPoint::width), between(&WindowPoint::depth), window.hatch_spacing,
                     window.layer_thickness};
  }
};

std::optional<Lattice> lattice_of(ProcessingWindow const& window) {
  Lattice lattice{distinct(window, &WindowPoint::power), distinct(window, &WindowPoint::scan_speed), {}};
  if (lattice.power.size() < 2 || lattice.speed.size() < 2) return std::nullopt;
  lattice.at.assign(lattice.power.size() * lattice.speed.size(), nullptr);
  for (WindowPoint const& point : window.points) {
    auto const i = std::ranges::lower_bound(lattice.power, point.power) - lattice.power.begin();
    auto const j = std::ranges::lower_bound(lattice.speed, point.scan_speed) - lattice.speed.begin();
    lattice.at[static_cast<std::size_t>(i) * lattice.speed.size() + static_cast<std::size_t>(j)] = &point;
  }
  if (std::ranges::count(lattice.at, nullptr) > 0) return std::nullopt;
  return lattice;
}

PoolArray array_of(ProcessingWindow const& window, WindowPoint const& point) {
  return {point.width, point.depth, window.hatch_spacing, window.layer_thickness};
}
double energy_density(ProcessingWindow const& window, double power, double speed) {
  return power / (speed * window.hatch_spacing * window.layer_thickness);
}

/// Axes in mm/s and W, with room round the points.
Frame frame_of(ProcessingWindow const& window) {
  auto const range = [&](double WindowPoint::*key, double unit) {
    std::vector<double> const values = distinct(window, key);
    double const low = unit * values.front(), high = unit * values.back();
    double const room = high > low ? 0.05 * (high - low) : 0.1 * high;
    return std::array{std::max(0.0, low - room), high + room};
  };
  auto const speed = range(&WindowPoint::scan_speed, 1e3), power = range(&WindowPoint::power, 1);
  return {plot_left, plot_top, plot_width - plot_left - right_margin, plot_height - plot_top - 48, speed[0], speed[1],
          power[0],  power[1]};
}

/// Colours of the bands, and the line between what joins and what does not, pixel by pixel.
std::string coloured_map(ProcessingWindow const& window, Lattice const& lattice, Frame const& frame) {
  double const left = frame.x(1e3 * lattice.speed.front()), right = frame.x(1e3 * lattice.speed.back());
  double const top = frame.y(lattice.power.back()), bottom = frame.y(lattice.power.front());
  Image image{columns, rows, {}};
  std::vector<std::size_t> band(static_cast<std::size_t>(columns) * rows);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      double const P = std::lerp(lattice.power.back(), lattice.power.front(), (j + 0.5) / rows);
      double const v = std::lerp(lattice.speed.front(), lattice.speed.back(), (i + 0.5) / columns);
      PoolArray const array = *lattice.pool(window, P, v);
      std::size_t& here = band[static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i)];
      here = band_of(relative_density(array, window.pattern), overlap_number(array));
      auto const rgb = band_colour(here);
      image.rgb.insert(image.rgb.end(), rgb.begin(), rgb.end());
    }
  return fmt::format(
      "<image href=\"data:image/png;base64,{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
      "preserveAspectRatio=\"none\"/>",
      base64(encode_png(image)), left, top, right - left, bottom - top);
}

/// P = E h L v as a line from the frame's left or bottom to its right or top, its value written at that end.
std::string energy_lines(ProcessingWindow const& window, Frame const& frame) {
  double const per_speed = window.hatch_spacing * window.layer_thickness * 1e-3;  // [m^2 W / (mm/s) per W/m^3]
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (WindowPoint const& point : window.points) {
    double const density = 1e-9 * energy_density(window, point.power, point.scan_speed);
    low = std::min(low, density), high = std::max(high, density);
  }
  std::string drawn;
  double const ratio = std::pow(high / low, 1.0 / 6);
  int const lines = high > 1.001 * low ? 6 : 1;  // one where all points have the same
  for (int k = 0; k < lines; ++k) {
    double const wanted = low * std::pow(ratio, k + 0.5);
    double const unit = std::pow(10, std::floor(std::log10(wanted)));
    double const density =
        std::max(1.0, std::round(wanted / (0.5 * unit))) * 0.5 * unit;  // [J/mm3], a digit and a half
    double const slope = 1e9 * density * per_speed;                     // [W per mm/s]
    double const from = std::max(frame.x_low, frame.y_low / slope), to = std::min(frame.x_high, frame.y_high / slope);
    if (to <= from) continue;
    bool const leaves_at_top = to < frame.x_high;
    std::string const way = fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", frame.x(from), frame.y(slope * from),
                                        frame.x(to), frame.y(slope * to));
    drawn += fmt::format(  // pale below, so that it shows on every colour
        "<path d=\"{0}\" stroke=\"#fff\" stroke-width=\"3\" opacity=\"0.6\"/><path d=\"{0}\" stroke=\"#1b2530\" "
        "stroke-dasharray=\"5 4\"/>",
        way);
    drawn += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"legend\">{:g}</text>",
                         frame.x(to) + (leaves_at_top ? 0 : 5), frame.y(slope * to) + (leaves_at_top ? -5 : 4),
                         leaves_at_top ? "middle" : "start", density);
  }
  return drawn;
}

std::string circles(ProcessingWindow const& window, Frame const& frame) {
  std::string drawn;
  for (WindowPoint const& point : window.points) {
    PoolArray const array = array_of(window, point);
    double const q = overlap_number(array), density = relative_density(array, window.pattern);
    drawn += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"1.6\"><title>{:.4g} "
        "W, {:.4g} mm/s, "
        "{:.3g} J/mm3: pool {:.3g} um wide, {:.3g} um deep; Q {:.3g}, relative density {:.4g} %</title></circle>",
        frame.x(1e3 * point.scan_speed), frame.y(point.power), hex_colour(band_colour(band_of(density, q))),
        point.power, 1e3 * point.scan_speed, 1e-9 * energy_density(window, point.power, point.scan_speed),
        1e6 * point.width, 1e6 * point.depth, q, 100 * density);
  }
  return drawn;
}

std::string key(Frame const& frame) {
  std::string drawn;
  for (std::size_t band = 0; band <= band_ends.size(); ++band) {
    double const x = frame.left + 106 * static_cast<double>(band);
    drawn += fmt::format(
        "<rect x=\"{:.1f}\" y=\"4\" width=\"11\" height=\"11\" rx=\"2\" fill=\"{}\"/><text x=\"{:.1f}\" y=\"14\" "
        "class=\"legend\">{}</text>",
        x, hex_colour(band_colour(band)), x + 16, band_words(band));
  }
  return drawn;
}

}  // namespace

double overlap_number_at(ProcessingWindow const& window, double power, double scan_speed) {
  std::optional<Lattice> const lattice = lattice_of(window);
  std::optional<PoolArray> const array = lattice ? lattice->pool(window, power, scan_speed) : std::nullopt;
  return array ? overlap_number(*array) : std::numeric_limits<double>::quiet_NaN();
}

std::string processing_window_figure(ProcessingWindow const& window, std::string const& csv_name) {
  if (window.points.empty()) return "";
  Frame const frame = frame_of(window);
  std::string content = key(frame);
  std::optional<Lattice> const lattice = lattice_of(window);
  if (lattice) content += coloured_map(window, *lattice, frame);
  content += energy_lines(window, frame) + circles(window, frame);
  content += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\" class=\"legend\">J/mm&#179;</text>",
                         plot_width - 4, frame.top - 5);
  content += y_axis(frame, "power [W]", GridLines::none) + x_axis(frame, "scan speed [mm/s]", x_ticks(frame));
  return figure(
      svg(plot_width, plot_height, "relative density over scan speed and power", content),
      fmt::format("<b>Processing window</b>: relative density by lack of fusion alone, from the overlap of melt pools; "
                  "{}. Tracks {:.4g} um apart, layers of {:.4g} um. Q = (hatch/width)&#178; + (layer/depth)&#178; "
                  "&#8804; 1: nothing stays unmelted (Tang et al. 2017). Dashed: equal energy density. Keyhole pores "
                  "and balling are not in it.",
                  window.pool_origin, 1e6 * window.hatch_spacing, 1e6 * window.layer_thickness),
      csv_name);
}

std::string processing_window_csv(ProcessingWindow const& window) {
  std::string csv =
      "power [W],scan_speed [mm/s],energy_density [J/mm3],pool_width [um],pool_depth [um],overlap_number,"
      "relative_density\n";
  for (WindowPoint const& point : window.points) {
    PoolArray const array = array_of(window, point);
    csv += fmt::format("{:g},{:g},{:g},{:g},{:g},{:g},{:g}\n", point.power, 1e3 * point.scan_speed,
                       1e-9 * energy_density(window, point.power, point.scan_speed), 1e6 * point.width,
                       1e6 * point.depth, overlap_number(array), relative_density(array, window.pattern));
  }
  return csv;
}

}  // namespace layerloop::coupling
