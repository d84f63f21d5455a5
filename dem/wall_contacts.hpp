#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/contact_law.hpp"
#include "dem/grains.hpp"
#include "dem/triangle_contact.hpp"
#include "dem/walls.hpp"

namespace layerloop::dem {

/// A triangle within the skin of a grain. It is left alone until the grain has travelled far enough to touch it.
struct TriangleCandidate {
  std::int32_t triangle;
  double awake_at;  ///< path length of the grain [m]
};

/// A contact between a grain and a wall, kept while they touch.
struct WallSpring {
  std::int64_t key;  ///< wall key
  double x, y, z;    ///< [m]
};

/// Grains near walls, what they may touch, and their springs. Grains are in ascending order of row; the arrays of
/// contacts hold room for every candidate, so that a step allocates nothing and loses no wall.
struct WallContacts {
  std::vector<std::int32_t> grain;        ///< row
  std::vector<double> path;               ///< travelled since the rebuild, an upper bound [m]
  std::vector<std::int32_t> block_begin;  ///< of each grain in `blocks`
  std::vector<std::int32_t> blocks;
  std::vector<std::int32_t> triangle_begin;  ///< of each grain in `triangles`
  std::vector<TriangleCandidate> triangles;
  std::vector<std::int32_t> spring_begin;  ///< room of each grain in `springs`
  std::vector<std::int32_t> spring_count;
  std::vector<WallSpring> springs;
  std::vector<std::array<double, 4>> force, torque;  ///< per grain of `grain`
};

/// Contacts of one thread's grains in one step, as arrays. Room for all candidates.
struct WallBatch {
  std::vector<double> overlap, radius, inverse_mass, nx, ny, nz, vx, vy, vz, sx, sy, sz, wx, wy, wz, spring_x, spring_y,
      spring_z;
  std::vector<double> fx, fy, fz, tx, ty, tz;
  std::vector<std::int64_t> key;
  std::vector<TriangleContact> touched;  ///< scratch of one grain

  void reserve(std::size_t contacts);
};

struct WallReport {
  double worst_overlap = 0;      ///< over the grain's diameter
  std::int64_t pushed_back = 0;  ///< x force of grains on moving blocks, in units of 1e-18 N: sums exactly in any order
};

/// \param shift  how far moving blocks have gone is velocity * time
void build_wall_contacts(WallContacts& contacts, Grains const& grains, Walls const& walls, TriangleGrid const& grid,
                         double skin, double time, std::vector<ContactSpring> const& springs);

void append_springs(WallContacts const& contacts, Grains const& grains, std::vector<LocalSpring>& springs);

/// Is a wall that moves among the candidates of grain `w` of the list?
bool is_near_moving_wall(WallContacts const& contacts, std::size_t w, Walls const& walls);

/// Contacts of the grains [from, to) of the list. No allocation once the batch has grown.
WallReport evaluate_walls(WallContacts& contacts, WallBatch& batch, Grains const& grains, Walls const& walls,
                          ContactLaw const& law, double time, double dt, std::size_t from, std::size_t to);

}  // namespace layerloop::dem
