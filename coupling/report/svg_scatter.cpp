#include "coupling/report/svg_scatter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "coupling/report/colour_map.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/svg_plot.hpp"

namespace layerloop::coupling {
namespace {

constexpr double row_height = 24, cell_size = 26;  // [px]

struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  }
  /// With room on both sides; never empty.
  Span padded() const {
    if (low > high) return {0, 1};
    double const span = high > low ? high - low : std::max(1e-300, 0.2 * std::abs(high));
    return {low - 0.07 * span, high + 0.07 * span};
  }
};

double error_at(std::vector<double> const& errors, std::size_t i) { return errors.empty() ? 0 : errors[i]; }

/// Blue below zero, red above, pale between: t from -1 to 1.
std::string signed_colour(double t) {
  using Rgb = std::array<double, 3>;
  static constexpr Rgb low{0x21, 0x66, 0xac}, middle{0xee, 0xee, 0xee}, high{0xb2, 0x18, 0x2b};
  double const share = std::min(1.0, std::abs(t));
  Rgb const& end = t < 0 ? low : high;
  std::array<std::uint8_t, 3> rgb;
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] = static_cast<std::uint8_t>(std::lround(std::lerp(middle[c], end[c], share)));
  return hex_colour(rgb);
}

std::string words_at(double x, double y, std::string_view anchor, std::string_view words,
                     std::string_view css = "legend") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"{}\">{}</text>", x, y, anchor, css,
                     escape(words));
}

std::string key(std::vector<PointSeries> const& series, Frame const& frame) {
  if (series.size() < 2) return "";
  std::string drawn;
  double x = frame.left;
  for (std::size_t k = 0; k < series.size(); ++k) {
    std::string const colour = series_colour(k, series.size());
    drawn += fmt::format("<circle cx=\"{:.1f}\" cy=\"10\" r=\"4\" fill=\"{}\" stroke=\"{}\"/>", x + 5,
                         series[k].hollow ? "none" : colour, colour);
    drawn += words_at(x + 14, 14.5, "start", series[k].name);
    x += 30 + 6.7 * static_cast<double>(series[k].name.size());
  }
  return drawn;
}

std::string points(PointSeries const& series, Frame const& frame, std::string const& colour) {
  std::string drawn;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
    double const x = frame.x(series.x[i]), y = frame.y(series.y[i]);
    double const across = error_at(series.x_error, i), up = error_at(series.y_error, i);
    if (up > 0)
      drawn += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" stroke=\"{}\" class=\"error\"/>", x,
                           frame.y(series.y[i] - up), frame.y(series.y[i] + up), colour);
    if (across > 0)
      drawn += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"{}\" class=\"error\"/>",
                           frame.x(series.x[i] - across), y, frame.x(series.x[i] + across), colour);
    std::string const words = series.words.empty()
                                  ? fmt::format("{} {:.4g}: {:.4g}", series.name, series.x[i], series.y[i])
                                  : series.words[i];
    drawn += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\" fill=\"{}\" stroke=\"{}\"><title>{}</title></circle>", x, y,
        series.hollow ? "none" : colour, colour, escape(words));
  }
  return drawn;
}

std::string line(double x1, double y1, double x2, double y2, std::string_view css) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" class=\"{}\"/>", x1, y1, x2, y2, css);
}

}  // namespace

std::string scatter_plot(ScatterPlot const& plot) {
  Span x, y;
  for (PointSeries const& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      for (double const sign : {-1.0, 1.0}) {
        x.add(series.x[i] + sign * error_at(series.x_error, i));
        y.add(series.y[i] + sign * error_at(series.y_error, i));
      }
    }
  }
  for (double const level : plot.levels) y.add(level);
  bool const alike = plot.diagonal == Diagonal::drawn;
  if (alike) x.add(y.low), x.add(y.high), y = x;
  x = x.padded(), y = y.padded();
  double const top = plot.series.size() > 1 ? 28 : 12;
  Frame const frame{plot_left, top, plot.width - plot_left - 12, plot.height - top - 48, x.low, x.high, y.low, y.high};
  std::string content = y_axis(frame, plot.y_label, GridLines::horizontal) +
                        x_axis(frame, plot.x_label, x_ticks(frame, plot.whole_x)) + key(plot.series, frame);
  if (alike) content += line(frame.x(x.low), frame.y(x.low), frame.x(x.high), frame.y(x.high), "axis");
  for (double const level : plot.levels)
    content += line(frame.left, frame.y(level), frame.left + frame.width, frame.y(level), "axis");
  for (std::size_t k = 0; k < plot.series.size(); ++k)
    content += points(plot.series[k], frame, series_colour(k, plot.series.size()));
  return svg(plot.width, plot.height, plot.y_label + " over " + plot.x_label, content);
}

std::string coloured_points(ColouredPoints const& plot) {
  Span x, y;
  for (double const value : plot.x) x.add(value);
  for (double const value : plot.y) y.add(value);
  x = x.padded(), y = y.padded();
  Frame const frame{plot_left, 34, plot.width - plot_left - 16, plot.height - 34 - 48, x.low, x.high, y.low, y.high};
  std::string content =
      y_axis(frame, plot.y_label, GridLines::horizontal) + x_axis(frame, plot.x_label, x_ticks(frame));
  content += words_at(frame.left, 14.5, "start", plot.value_label);
  double at = frame.left + frame.width - 130;
  for (double const share : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    content += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"9\" r=\"{:.1f}\" fill=\"{}\" class=\"signed\"/>"
        "<text x=\"{:.1f}\" y=\"27\" text-anchor=\"middle\">{}{:g}</text>",
        at, 3 + 4 * std::abs(share), signed_colour(share), at, share < 0 ? "\xe2\x88\x92" : "",
        std::abs(share) * plot.limit);
    at += 31;
  }
  for (std::size_t i = 0; i < plot.x.size(); ++i) {
    double const share = plot.value[i] / plot.limit;
    if (!std::isfinite(plot.x[i]) || !std::isfinite(plot.y[i]) || !std::isfinite(share)) continue;
    content += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\" class=\"signed\"><title>{:.4g}, {:.4g}: "
        "{:.2f}</title></circle>",
        frame.x(plot.x[i]), frame.y(plot.y[i]), 4 + 7 * std::min(1.0, std::abs(share)), signed_colour(share), plot.x[i],
        plot.y[i], plot.value[i]);
  }
  return svg(plot.width, plot.height, plot.value_label, content);
}

std::string lying_bars(LyingBars const& plot) {
  Span x;
  x.add(0);
  std::size_t longest = 0, words = 0;
  for (LyingBar const& bar : plot.bars) {
    x.add(bar.value - bar.error);
    x.add(bar.value + bar.error);
    longest = std::max(longest, bar.name.size());
    words = std::max(words, bar.words.size());
  }
  for (double const mark : plot.marks) x.add(mark);
  x = x.padded();
  double const left = 20 + 6.9 * static_cast<double>(longest), right = 20 + 6.7 * static_cast<double>(words);
  double const height = row_height * static_cast<double>(plot.bars.size());
  Frame const frame{left, 8, std::max(120.0, plot.width - left - right), height, x.low, x.high, 0, 1};
  std::string content = x_axis(frame, plot.x_label, x_ticks(frame));
  content += line(frame.x(0), frame.top, frame.x(0), frame.top + height, "axis");
  for (std::size_t k = 0; k < plot.bars.size(); ++k) {
    LyingBar const& bar = plot.bars[k];
    double const top = frame.top + row_height * static_cast<double>(k), middle = top + row_height / 2;
    double const from = frame.x(std::min(0.0, bar.value)), to = frame.x(std::max(0.0, bar.value));
    content += words_at(left - 9, middle + 4, "end", bar.name);
    content += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"2\" fill=\"{}\" opacity=\"{}\">"
        "<title>{}: {:.4g}</title></rect>",
        from, top + 4, std::max(1.0, to - from), row_height - 8, series_colour(bar.strong ? 1 : 0, 2),
        bar.strong ? "1" : "0.65", escape(bar.name), bar.value);
    if (bar.error > 0)
      content += line(frame.x(bar.value - bar.error), middle, frame.x(bar.value + bar.error), middle, "mark");
    content += words_at(frame.left + frame.width + 10, middle + 4, "start", bar.words, "");
  }
  for (double const mark : plot.marks)
    content += fmt::format("<path d=\"M{:.1f} {:.1f}v{:.1f}\" class=\"axis\" stroke-dasharray=\"4 3\"/>", frame.x(mark),
                           frame.top, height);
  return svg(plot.width, frame.top + height + 48, plot.x_label, content);
}

std::string square_matrix(std::vector<std::string> const& names, std::vector<double> const& values,
                          std::string const& label) {
  std::size_t const n = names.size();
  std::size_t longest = 0;
  for (std::string const& name : names) longest = std::max(longest, name.size());
  double const left = 16 + 6.9 * static_cast<double>(longest), top = 8;
  double const size = cell_size * static_cast<double>(n);
  std::string content;
  for (std::size_t i = 0; i < n; ++i) {
    double const y = top + cell_size * static_cast<double>(i);
    content += words_at(left - 7, y + cell_size / 2 + 4, "end", names[i]);
    double const x = left + cell_size * (static_cast<double>(i) + 0.5);
    content += fmt::format(
        "<text transform=\"translate({:.1f} {:.1f}) rotate(-55)\" text-anchor=\"end\" class=\"legend\">{}</text>",
        x + 4, top + size + 13, escape(names[i]));
    for (std::size_t j = 0; j < n; ++j) {
      double const value = values[i * n + j];
      if (!std::isfinite(value)) continue;
      double const cell = left + cell_size * static_cast<double>(j);
      content += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"><title>{} and {}: "
          "{:.2f}</title></rect><text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" class=\"{}\">"
          "{:.0f}</text>",
          cell + 0.5, y + 0.5, cell_size - 1, cell_size - 1, signed_colour(value), escape(names[i]), escape(names[j]),
          value, cell + cell_size / 2, y + cell_size / 2 + 3, std::abs(value) > 0.6 ? "cell light" : "cell",
          100 * value);
    }
  }
  return svg(left + size + 12, top + size + 30 + 5.8 * static_cast<double>(longest), label, content);
}

}  // namespace layerloop::coupling
