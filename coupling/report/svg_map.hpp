#pragma once
#include <functional>
#include <string>
#include <vector>

#include "coupling/report/colour_map.hpp"

namespace layerloop::coupling {

/// Values on a regular grid of square cells as a colour picture with axes in um and a colour bar. Shapes: (ny, nx),
/// x fastest; not a number: no surface there.
struct Raster {
  double x0 = 0, y0 = 0, cell = 0;  ///< lower corner and edge [um]
  int nx = 0, ny = 0;
  std::vector<double> values;
  double at(int i, int j) const {
    return values[static_cast<std::size_t>(i) + static_cast<std::size_t>(nx) * static_cast<std::size_t>(j)];
  }
};

/// The cells i in [i0, i1), j in [j0, j1).
Raster crop(Raster const& raster, int i0, int i1, int j0, int j1);

struct ColourScale {
  ColourMap map;
  std::string label;  ///< with unit
  double low, high;   ///< values beyond take the end colours, and the bar says so
  double mark = 0;    ///< a value to mark on the bar, when mark_label is not empty
  std::string mark_label = {};
};

/// Line between the cells where `inside(i, j)` holds and those where it does not.
struct Outline {
  std::function<bool(int, int)> inside;
  std::string css;
};

std::string map_plot(Raster const& raster, ColourScale const& scale, std::string const& x_label,
                     std::string const& y_label, std::vector<Outline> const& outlines, double width);

/// Values below which the given shares of all finite values lie.
std::vector<double> quantiles(std::vector<double> values, std::vector<double> const& shares);

}  // namespace layerloop::coupling
