#pragma once
#include <cstdint>
#include <vector>

#include "core/powder_bed.hpp"

namespace layerloop::dem {

/// One grain on its way from rank to rank.
struct GrainRecord {
  std::int64_t id;
  double x, y, z, vx, vy, vz, wx, wy, wz, radius;
  std::int32_t material;
  std::int32_t leaves;  ///< 1: on its way out of the simulation
};

/// The grains that one rank works on: rows [0, owned) are its own, the rest are ghosts, copies of grains of other ranks
/// close enough to touch its own. Rows change at every neighbour rebuild; ids never do.
struct Grains {
  std::size_t owned = 0;
  std::vector<std::int64_t> id;
  std::vector<double> x, y, z, vx, vy, vz, wx, wy, wz;
  std::vector<double> radius, mass;
  std::vector<std::int32_t> material, leaves;

  std::size_t size() const { return id.size(); }
  void clear();
  void push_back(GrainRecord const& record, double density);
  GrainRecord record(std::size_t row) const;
};

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
