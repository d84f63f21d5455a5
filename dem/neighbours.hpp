#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "dem/grains.hpp"

namespace layerloop::dem {

/// Lengths after which the bed repeats; infinite where it does not [m].
struct Period {
  double x, y;
};

/// Shortest of the distances `d`, `d + period`, `d - period`, for |d| < 1.5 periods.
inline double wrapped(double d, double period) {
  double const half = 0.5 * period;
  return d > half ? d - period : (d < -half ? d + period : d);
}

/// The spring of a pair that touches.
struct PairSpring {
  double x, y, z;                 ///< tangential displacement [m]
  double turn_x, turn_y, turn_z;  ///< rolling angle that is stored [rad]
};

/// Pairs of grains closer than a skin: with a grain of this rank, in order of the lower of their two rows. The first
/// grain of a pair has the lower id, so that a pair is computed the same way on every rank that holds it.
struct Neighbours {
  std::vector<std::int32_t> first, second;  ///< rows
  std::vector<std::int32_t> begin;          ///< of each owned row's pairs; owned + 1 values
  std::vector<std::int32_t> spring;         ///< where the spring is; see NearPairs
  std::vector<PairSpring> dormant;          ///< springs as they were taken over

  std::size_t size() const { return first.size(); }
};

/// Where the spring of a listed pair is: its place among the near pairs (dem/pair_contacts.hpp), nowhere, or dormant.
constexpr std::int32_t no_spring = -1;
constexpr std::int32_t dormant_spring(std::size_t at) { return -2 - static_cast<std::int32_t>(at); }

/// Lists all pairs with an owned grain whose surfaces are closer than `skin`. Springs are taken over.
/// \param springs  sorted
void build_neighbours(Neighbours& neighbours, Grains const& grains, double skin, Period const& period,
                      std::vector<ContactSpring> const& springs);

}  // namespace layerloop::dem
