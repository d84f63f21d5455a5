#pragma once
#include <string>
#include <vector>

namespace layerloop::coupling {

/// Points with error bars both ways; what is not finite is left out.
struct PointSeries {
  std::string name;
  std::vector<double> x, y;
  std::vector<double> x_error = {}, y_error = {};  ///< half lengths; empty: none
  std::vector<std::string> words = {};             ///< of every point, under the pointer; empty: its numbers
  bool hollow = false;
};

enum class Diagonal { none, drawn };  ///< drawn: both axes alike, with the line where they are equal

struct ScatterPlot {
  std::string x_label, y_label;  ///< with units
  std::vector<PointSeries> series;
  Diagonal diagonal = Diagonal::none;
  std::vector<double> levels = {};  ///< horizontal lines
  bool whole_x = false;             ///< x counts something
  double width = 520, height = 300;
};
std::string scatter_plot(ScatterPlot const& plot);

/// Circles over two axes, coloured by a value from blue over pale, at zero, to red; the larger the value, the larger
/// the circle.
struct ColouredPoints {
  std::string x_label, y_label, value_label;
  std::vector<double> x, y, value;
  double limit = 3;  ///< value of full colour
  double width = 420, height = 330;
};
std::string coloured_points(ColouredPoints const& plot);

/// Bars that lie, one a row, with a word to the right of each.
struct LyingBar {
  std::string name;
  double value = 0, error = 0;
  std::string words = {};
  bool strong = true;  ///< drawn in full colour
};
struct LyingBars {
  std::string x_label;
  std::vector<LyingBar> bars;
  std::vector<double> marks = {};  ///< vertical lines
  double width = 760;
};
std::string lying_bars(LyingBars const& plot);

/// A table of values from -1 to 1 in colour, rows and columns under the same names. \param values  row by row
std::string square_matrix(std::vector<std::string> const& names, std::vector<double> const& values,
                          std::string const& label);

}  // namespace layerloop::coupling
