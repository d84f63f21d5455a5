#pragma once
#include <filesystem>
#include <vector>

namespace layerloop::raytrace {

/// Intensity of a round beam over its radius: linear between points, constant inside the first, nothing beyond the
/// last. What counts is its shape: the power in it is 1.
class RadialProfile {
 public:
  /// \throws InputError  fewer than two points, radii that do not ascend from >= 0, negative intensity, no power
  RadialProfile(std::vector<double> radius, std::vector<double> intensity);

  double power_inside(double radius) const;   ///< share of the power within this radius
  double radius_holding(double share) const;  ///< the inverse [m]
  double second_moment_diameter() const;      ///< D4sigma [m]

 private:
  double power_to(std::size_t interval, double radius) const;

  std::vector<double> radius_, intensity_;
  std::vector<double> power_;  ///< inside each radius_, scaled to 1
};

/// A ring: Gaussian across its crest, 1/e2 half width `half_width` [m] about the crest's radius [m].
RadialProfile ring_profile(double crest_radius, double half_width);

/// Reads "r [UNIT],intensity [...]" and rows; the unit of intensity does not matter.
/// \throws InputError damaged, as "file:line: problem (why) suggestion"; FileError cannot be opened
RadialProfile read_radial_profile(std::filesystem::path const& path);

}  // namespace layerloop::raytrace
