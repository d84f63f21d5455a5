#include "coupling/report/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/report/colour_map.hpp"
#include "coupling/report/html.hpp"

namespace layerloop::coupling {
namespace {

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// With a share of the span as room on both sides; never empty.
  Range padded(double share) const {
    if (low > high) return {0, 1};
    double const span = high - low;
    // What varies by less than 4 % is drawn as nearly level, so that scatter does not look like a trend.
    double const least = std::max(span, 0.04 * std::max(std::abs(low), std::abs(high)));
    double const room = least > 0 ? 0.5 * (least - span) + share * least : 1;
    return {low - room, high + room};
  }
};

std::string text(double x, double y, std::string_view anchor, std::string_view words, std::string_view css = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"{}\">{}</text>", x, y, anchor, css,
                     words);
}

std::string line(double x1, double y1, double x2, double y2, std::string_view css) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>", x1, y1, x2, y2,
                     css);
}

/// Width of a text in our 12 px sans serif, near enough to lay out a legend.
double text_width(std::string const& words) { return 6.7 * static_cast<double>(words.size()); }

std::string legend(std::vector<Series> const& series, Frame const& frame) {
  if (series.size() < 2) return "";
  std::string drawn;
  double x = frame.left;
  for (std::size_t k = 0; k < series.size(); ++k) {
    drawn += fmt::format("<rect x=\"{:.1f}\" y=\"8\" width=\"14\" height=\"5\" rx=\"2\" fill=\"{}\"/>", x,
                         series_colour(k, series.size()));
    drawn += text(x + 19, 14.5, "start", escape(series[k].name), "legend");
    x += 34 + text_width(series[k].name);
    // Many lines of a ramp: naming the first and the last says it all.
    if (series.size() > 6 && k == 0) k = series.size() - 2;
  }
  return drawn;
}

std::string curve(Series const& series, Frame const& frame, std::string const& colour) {
  std::string path, marks;
  bool pen_down = false;
  bool const markers = series.x.size() <= 60;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.y[i])) {
      pen_down = false;
      continue;
    }
    double const x = frame.x(series.x[i]), y = frame.y(series.y[i]);
    path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", x, y);
    pen_down = true;
    if (!series.error.empty() && series.error[i] > 0) {
      double const low = frame.y(series.y[i] - series.error[i]), high = frame.y(series.y[i] + series.error[i]);
      marks +=
          fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}m-4 0h8M{3:.1f} {1:.1f}h8\" stroke=\"{4}\" class=\"error\"/>",
                      x, low, high, x - 4, colour);
    }
    if (markers)
      marks += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"><title>{} {:.4g}: {:.4g}</title></circle>", x, y,
          colour, escape(series.name), series.x[i], series.y[i]);
  }
  return fmt::format("<path d=\"{}\" stroke=\"{}\" class=\"curve\"/>{}", path, colour, marks);
}

}  // namespace

std::string Ticks::label(double value) const {
  std::string const words = fmt::format("{:.{}f}", value, decimals);
  return words.front() == '-' ? (std::stod(words) == 0 ? words.substr(1) : "\xe2\x88\x92" + words.substr(1)) : words;
}

Ticks round_ticks(double low, double high, int wanted, bool whole_numbers) {
  double const rough = (high - low) / std::max(1, wanted);
  double const power = std::pow(10.0, std::floor(std::log10(rough)));
  double const share = rough / power;
  double step = power * (share < 1.5 ? 1 : share < 3 ? 2 : share < 7 ? 5 : 10);
  if (whole_numbers) step = std::max(1.0, std::round(step));
  Ticks ticks;
  ticks.decimals = std::clamp(-static_cast<int>(std::floor(std::log10(step) + 1e-9)), 0, 12);
  auto const last = static_cast<std::int64_t>(std::floor(high / step + 1e-9));
  for (auto n = static_cast<std::int64_t>(std::ceil(low / step - 1e-9)); n <= last; ++n)
    ticks.at.push_back(static_cast<double>(n) * step);
  return ticks;
}

std::string y_axis(Frame const& frame, std::string const& label, GridLines grid) {
  std::string drawn;
  Ticks const ticks = round_ticks(frame.y_low, frame.y_high, std::clamp(static_cast<int>(frame.height / 45), 2, 7));
  for (double value : ticks.at) {
    double const y = frame.y(value);
    if (grid == GridLines::horizontal) drawn += line(frame.left, y, frame.left + frame.width, y, "grid");
    drawn += line(frame.left - 4, y, frame.left, y, "axis") + text(frame.left - 7, y + 4, "end", ticks.label(value));
  }
  drawn += line(frame.left, frame.top, frame.left, frame.top + frame.height, "axis");
  drawn += fmt::format(
      "<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\" class=\"label\">{}</text>",
      frame.left - 54, frame.top + frame.height / 2, escape(label));
  return drawn;
}

std::string x_axis(Frame const& frame, std::string const& label, std::vector<Tick> const& ticks) {
  double const right = frame.left + frame.width, bottom = frame.top + frame.height;
  std::string drawn = line(frame.left, bottom, right, bottom, "axis");
  for (Tick const& tick : ticks) {
    drawn += line(frame.x(tick.value), bottom, frame.x(tick.value), bottom + 4, "axis");
    drawn += text(frame.x(tick.value), bottom + 17, "middle", tick.words);
  }
  return drawn + text(frame.left + frame.width / 2, bottom + 36, "middle", escape(label), "label");
}

std::vector<Tick> x_ticks(Frame const& frame, bool whole_numbers) {
  Ticks const round =
      round_ticks(frame.x_low, frame.x_high, std::clamp(static_cast<int>(frame.width / 75), 2, 14), whole_numbers);
  std::vector<Tick> ticks;
  for (double value : round.at) ticks.push_back({value, round.label(value)});
  return ticks;
}

std::string svg(double width, double height, std::string const& label, std::string const& content) {
  return fmt::format(
      "<svg viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
      "aria-label=\"{2}\">{3}</svg>",
      width, height, escape(label), content);
}

std::string line_plot(LinePlot const& plot) {
  Range x, y;
  for (Series const& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      double const error = series.error.empty() ? 0 : series.error[i];
      x.add(series.x[i]);
      y.add(series.y[i] - error);
      y.add(series.y[i] + error);
    }
  }
  x = x.padded(plot.whole_x ? 0.06 : 0.02);
  y = y.padded(0.08);
  if (plot.from_zero) y.low = 0;
  double const top = plot.series.size() > 1 ? 28 : 12;
  Frame const frame{plot_left, top, plot.width - plot_left - 12, plot.height - top - 48, x.low, x.high, y.low, y.high};
  std::string content = y_axis(frame, plot.y_label, GridLines::horizontal) +
                        x_axis(frame, plot.x_label, x_ticks(frame, plot.whole_x)) + legend(plot.series, frame);
  for (std::size_t k = 0; k < plot.series.size(); ++k)
    content += curve(plot.series[k], frame, series_colour(k, plot.series.size()));
  return svg(plot.width, plot.height, plot.y_label + " over " + plot.x_label, content);
}

std::string bar_plot(BarPlot const& plot) {
  Range y;
  y.add(0);
  for (Series const& series : plot.series)
    for (double value : series.y) y.add(value);
  auto const count = static_cast<double>(std::max<std::size_t>(1, plot.categories.size()));
  Frame const frame{plot_left,   28, plot.width - plot_left - 12, plot.height - 28 - 48, -0.5,
                    count - 0.5, 0,  y.padded(0.08).high};
  std::vector<Tick> ticks;
  for (std::size_t c = 0; c < plot.categories.size(); ++c)
    ticks.push_back({static_cast<double>(c), escape(plot.categories[c])});
  std::string content = y_axis(frame, plot.y_label, GridLines::horizontal) + x_axis(frame, plot.x_label, ticks) +
                        legend(plot.series, frame);

  auto const groups = static_cast<double>(plot.series.size());
  double const bar = std::min(46.0, 0.72 * frame.width / count / groups);
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    Series const& series = plot.series[k];
    for (std::size_t c = 0; c < series.y.size(); ++c) {
      double const left = frame.x(static_cast<double>(c)) + (static_cast<double>(k) - 0.5 * groups) * bar;
      content += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"><title>{} {}: "
          "{:.4g}</title></rect>",
          left + 1, frame.y(series.y[c]), bar - 2, frame.y(0) - frame.y(series.y[c]),
          series_colour(k, plot.series.size()), escape(series.name), escape(plot.categories[c]), series.y[c]);
    }
  }
  return svg(plot.width, plot.height, plot.y_label + " by " + plot.x_label, content);
}

std::string share_bar(std::vector<Share> const& shares, std::string const& unit, double width) {
  double total = 0;
  for (Share const& share : shares) total += share.value;
  std::string content;
  double x = 0, legend_x = 0;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    double const part = total > 0 ? width * shares[k].value / total : 0;
    std::string const colour = series_colour(k, shares.size());
    std::string const words = fmt::format("{} {:.3g} {}", shares[k].name, shares[k].value, unit);
    content +=
        fmt::format("<rect x=\"{:.1f}\" y=\"0\" width=\"{:.1f}\" height=\"26\" fill=\"{}\"><title>{}</title></rect>", x,
                    part, colour, escape(words));
    content +=
        fmt::format("<rect x=\"{:.1f}\" y=\"40\" width=\"11\" height=\"11\" rx=\"2\" fill=\"{}\"/>", legend_x, colour);
    content += text(legend_x + 17, 50, "start", escape(words), "legend");
    x += part;
    legend_x += 40 + text_width(words);
  }
  return svg(width, 58, "shares", content);
}

}  // namespace layerloop::coupling
