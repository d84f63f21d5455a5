#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/vec3.hpp"

namespace layerloop {

/// One tangential spring that outlives a time step. Grain-grain: key_a < key_b are grain ids.
/// Grain-wall: key_a is the grain id, key_b = -1 - wall key (see dem/walls.hpp).
struct ContactSpring {
  std::int64_t key_a;
  std::int64_t key_b;
  std::array<double, 3> spring;  ///< tangential displacement [m]
  std::array<double, 3> turn{};  ///< rolling angle that is stored [rad]; 0 without a rolling spring
};

/// All grains of a run as a structure of arrays, in ascending order of id. Plain data: every rank holds the same copy
/// between stages. SI units, machine frame.
struct PowderBed {
  std::vector<std::int64_t> id;         ///< never reused within a run
  std::vector<double> x, y, z;          ///< centres [m]; y in [0, width) where the bed is periodic
  std::vector<double> radius;           ///< [m]
  std::vector<double> vx, vy, vz;       ///< velocity [m/s]
  std::vector<double> wx, wy, wz;       ///< angular velocity [rad/s]
  std::vector<std::int32_t> material;   ///< index into the run's list of materials
  std::vector<ContactSpring> contacts;  ///< ascending by (key_a, key_b)

  std::size_t size() const { return id.size(); }
  Vec3 position(std::size_t i) const { return {x[i], y[i], z[i]}; }
  double volume(std::size_t i) const;  ///< [m^3]

  /// Appends a grain at rest. \pre id is larger than every id already in the bed.
  void add(std::int64_t new_id, Vec3 const& centre, double grain_radius, std::int32_t grain_material);

  /// Keeps the grains whose flag is set, and the springs between grains that stay. \pre keep.size() == size()
  void retain(std::vector<char> const& keep);
};

/// Sum of grain volumes [m^3], compensated (Neumaier) so that the mass ledger is exact to the last digits.
double total_volume(PowderBed const& bed);

}  // namespace layerloop
