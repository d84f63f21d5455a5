#pragma once
#include <cstdint>
#include <vector>

#include "core/huge_pages.hpp"
#include "core/powder_bed.hpp"

namespace layerloop::dem {

/// What a contact needs to know of a grain, in three quads so that eight grains turn into vectors with few shuffles
/// (dem/lanes.hpp).
struct alignas(32) GrainState {
  double x, y, z, inverse_inertia;  ///< [m], [1/(kg m^2)]
  double vx, vy, vz, inverse_mass;  ///< [m/s], [1/kg]
  double wx, wy, wz, radius;        ///< [rad/s], [m]
};

/// A grain that has lain still at so many checks in a row falls asleep (dem/sleep.hpp).
inline constexpr std::int32_t checks_until_sleep = 40;
constexpr bool is_asleep(std::int32_t quiet_checks) { return quiet_checks >= checks_until_sleep; }

/// One grain on its way from rank to rank.
struct GrainRecord {
  GrainState state;
  std::int64_t id;
  std::int32_t material;
  std::int32_t leaves;  ///< 1: on its way out of the simulation
  std::int32_t quiet;   ///< checks in a row at which it lay still; stays 0 where grains do not sleep
};

/// The grains that one rank works on: rows [0, owned) are its own, the rest are ghosts, copies of grains of other ranks
/// close enough to touch its own. Rows change at every neighbour rebuild; ids never do.
struct Grains {
  std::size_t owned = 0;
  std::vector<GrainState, HugePages<GrainState>> state;
  std::vector<std::int64_t> id;
  std::vector<std::int32_t> material, leaves, quiet;

  std::size_t size() const { return id.size(); }
  GrainState& operator[](std::size_t row) { return state[row]; }
  GrainState const& operator[](std::size_t row) const { return state[row]; }
  double mass(std::size_t row) const { return 1 / state[row].inverse_mass; }
  double diameter(std::size_t row) const { return 2 * state[row].radius; }

  void clear();
  void push_back(GrainRecord const& record);
  /// Ends the list with a grain that touches nothing and is not counted: row size().
  void close();
  GrainRecord record(std::size_t row) const;
};

/// The record of row i of a bed. \param density  of its material [kg/m^3]
GrainRecord record_of(PowderBed const& bed, std::size_t i, double density);

/// A tangential spring and the rows of its grains; row_b is -1 at a wall.
struct LocalSpring {
  ContactSpring spring;
  std::int32_t row_a, row_b;
};

/// Orders springs by their keys and drops the second copy of those that two ranks sent.
void sort_springs(std::vector<ContactSpring>& springs);

/// Spring between two keys in a sorted list; null when there is none.
ContactSpring const* find_spring(std::vector<ContactSpring> const& sorted, std::int64_t key_a, std::int64_t key_b);

}  // namespace layerloop::dem
