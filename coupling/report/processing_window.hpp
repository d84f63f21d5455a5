#pragma once
#include <string>
#include <vector>

#include "coupling/pool_overlap.hpp"

namespace layerloop::coupling {

/// Pool of a track with one power and speed, depth as in PoolArray. SI.
struct WindowPoint {
  double power = 0, scan_speed = 0;
  double width = 0, depth = 0;  ///< 0: nothing melts
};

struct ProcessingWindow {
  std::vector<WindowPoint> points;  ///< in any order
  double hatch_spacing = 0, layer_thickness = 0;
  HatchPattern pattern = HatchPattern::rotated;
  std::string pool_origin;  ///< where the pools come from, for the caption; HTML
};

/// Overlap number at a power and speed between the points: pool sizes bilinear in power and speed. Not a number unless
/// the points are all combinations of at least two powers and two speeds, and this one lies within them.
double overlap_number_at(ProcessingWindow const& window, double power, double scan_speed);

/// Map over scan speed and power: relative density by the overlap of pools in bands of colour where the points are a
/// full grid, the line Q = 1 beyond which tracks do not join, lines of equal energy density P / (v hatch layer), and a
/// circle a point with its figures under the pointer. Empty without points. \param csv_name  of the table beside it
std::string processing_window_figure(ProcessingWindow const& window, std::string const& csv_name);

/// The numbers behind it, one header line with units.
std::string processing_window_csv(ProcessingWindow const& window);

}  // namespace layerloop::coupling
