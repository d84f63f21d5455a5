#pragma once
#include <vector>

namespace layerloop::dem {

/// A grain seen from above.
struct Disc {
  double x, y, radius;  ///< [m]
};

/// A piece of a disc's rim that no other disc covers, counter-clockwise; y plays no part in areas.
struct RimArc {
  double x, radius;  ///< of its disc [m]
  double from, to;   ///< angle from the x axis, from <= to [rad]
};

/// Rim of the union of discs that are periodic along y. Discs that coincide count once.
/// \pre period > 0; a disc may be wider than it
std::vector<RimArc> rim_of_union(std::vector<Disc> discs, double period);

/// Exact area of the union between x = low and x = high within one period, from its rim by Green's theorem: the form
/// clamp(x, low, high) dy is single-valued on the cylinder that the period makes of the plane, and its derivative is
/// dx dy inside the strip and 0 outside. [m^2]
double area_between(std::vector<RimArc> const& rim, double low, double high);

}  // namespace layerloop::dem
