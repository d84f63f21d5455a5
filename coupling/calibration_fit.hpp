#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "coupling/calibration.hpp"

namespace layerloop::coupling {

/// Friction and cohesion of the search as places from -1 to 1.
class SearchRange {
 public:
  explicit SearchRange(CalibrateSettings const& c) : friction_(*c.friction), cohesion_(*c.cohesion) {}
  double friction(double u) const { return between(friction_, u); }
  double cohesion(double v) const { return between(cohesion_, v); }
  std::array<double, 2> place(ContactParameters const& p) const {
    return {place_in(friction_, p.sliding_friction), place_in(cohesion_, p.cohesion_energy_density)};
  }

 private:
  using Bounds = std::array<double, 2>;
  static double between(Bounds const& b, double s) { return b[0] + 0.5 * (1 + s) * (b[1] - b[0]); }
  static double place_in(Bounds const& b, double value) { return 2 * (value - b[0]) / (b[1] - b[0]) - 1; }
  Bounds friction_, cohesion_;
};

/// A value over two variables that both run from -1 to 1: all terms up to second order, by weighted least squares.
class ResponseSurface {
 public:
  struct Point {
    double u, v, value, weight;
  };
  explicit ResponseSurface(std::vector<Point> const& points);
  double operator()(double u, double v) const;

 private:
  Eigen::Vector<double, 6> coefficients_;  ///< of 1, u, v, u u, u v, v v
};

/// Both angles [rad] over the range of the search. Points count the more the closer they are to the best one.
struct AngleSurfaces {
  AngleSurfaces(std::vector<CalibrationPoint> const& points, CalibrateSettings const& c);
  ResponseSurface repose, slip;
};

/// Slopes from central differences: `changed` holds every parameter raised and lowered by the relative `step`, in
/// order. What they leave open is told as changes that keep both angles: for every other parameter the friction and the
/// cohesion (between grains and at walls, as in the search) that make up for it; and the combination of friction and
/// cohesion that the angles tell worst. A parameter that is 0 has no slope.
Sensitivity sensitivity_of(CalibrationPoint const& centre, std::vector<CalibrationPoint> const& changed, double step);

}  // namespace layerloop::coupling
