#pragma once
#include <string>
#include <vector>

namespace layerloop::coupling {

/// Round numbers in [low, high], about `wanted` of them.
struct Ticks {
  std::vector<double> at;
  int decimals = 0;  ///< that all of them need
  std::string label(double value) const;
};
Ticks round_ticks(double low, double high, int wanted, bool whole_numbers = false);

/// Left, top, width and height of the area inside the axes, in pixels, and the values at its edges.
struct Frame {
  double left, top, width, height;
  double x_low, x_high, y_low, y_high;
  double x(double value) const { return left + width * (value - x_low) / (x_high - x_low); }
  double y(double value) const { return top + height * (y_high - value) / (y_high - y_low); }
};

inline constexpr double plot_left = 70;  ///< room for numbers and label of the y axis [px]

enum class GridLines { none, horizontal };
struct Tick {
  double value;
  std::string words;
};
/// Axis line, ticks, numbers and label, drawn to the left of and below the frame.
std::string y_axis(Frame const& frame, std::string const& label, GridLines grid);
std::string x_axis(Frame const& frame, std::string const& label, std::vector<Tick> const& ticks);
std::vector<Tick> x_ticks(Frame const& frame, bool whole_numbers = false);

/// A picture of its own, scaled down with the page; `label` is for those who cannot see it.
std::string svg(double width, double height, std::string const& label, std::string const& content);

struct Series {
  std::string name;
  std::vector<double> x, y;
  std::vector<double> error = {};  ///< half length of the error bars; empty: none
};

struct LinePlot {
  std::string x_label, y_label;  ///< with units
  std::vector<Series> series;
  bool from_zero = false;  ///< y axis begins at 0
  bool whole_x = false;    ///< x counts something
  double width = 520, height = 300;
};
/// Lines with markers; values that are not finite break the line.
std::string line_plot(LinePlot const& plot);

struct BarPlot {
  std::string x_label, y_label;
  std::vector<std::string> categories;
  std::vector<Series> series;  ///< y only, one value a category
  double width = 520, height = 300;
};
std::string bar_plot(BarPlot const& plot);

/// One bar cut into labelled shares, with its legend.
struct Share {
  std::string name;
  double value;
};
std::string share_bar(std::vector<Share> const& shares, std::string const& unit, double width = 1150);

}  // namespace layerloop::coupling
