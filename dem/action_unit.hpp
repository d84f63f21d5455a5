#pragma once
#include <array>
#include <cmath>
#include <cstdint>

namespace layerloop::dem {

/// Force and torque on a grain, in whole numbers of a unit (ActionUnit): sums of whole numbers are the same in
/// any order, so neither threads nor ranks nor the order of contacts can change a bit.
struct alignas(64) GrainAction {
  std::array<std::uint64_t, 4> force, torque;  ///< two's complement; the last of each is 0
};

/// Units of the whole numbers in which forces and torques are added up, powers of two.
///
/// 2^62 units are 64 times the force of a Hertz contact at an overlap of a tenth of the diameter, twice what the guards
/// let pass: for 42 um grains of 0.2 GPa a unit is about 1e-19 N, 1e-9 of the weight of a 13 um grain.
struct ActionUnit {
  double force = 1, torque = 1;          ///< [N], [N m]
  double per_force = 1, per_torque = 1;  ///< their inverses

  ActionUnit() = default;
  /// \param normal_stiffness  4/3 E of the stiffest pair [Pa]
  ActionUnit(double normal_stiffness, double largest_radius) {
    double const overlap = 0.2 * largest_radius;
    double const most = 64 * normal_stiffness * std::sqrt(largest_radius * overlap) * overlap;
    force = std::ldexp(1.0, std::ilogb(most) + 1 - 62);
    torque = std::ldexp(force, std::ilogb(largest_radius) + 1);
    per_force = 1 / force;
    per_torque = 1 / torque;
  }
};

}  // namespace layerloop::dem
