#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/contact_law.hpp"
#include "dem/grains.hpp"
#include "dem/moving_walls.hpp"
#include "dem/triangle_contact.hpp"
#include "dem/walls.hpp"

namespace layerloop::dem {

/// A wall or triangle within the skin of a grain. It is left alone until both together have travelled far enough to
/// touch.
struct WallCandidate {
  std::int64_t key;   ///< wall key
  std::int32_t wall;  ///< number of the wall
  double awake_at;    ///< paths of grain and wall, summed [m]

  std::int32_t triangle() const { return static_cast<std::int32_t>((key - first_triangle_key) % keys_a_mesh); }
};

/// A contact between a grain and a wall, kept while they touch.
struct WallSpring {
  std::int64_t key;                           ///< wall key
  double x, y, z;                             ///< [m]
  double turn_x = 0, turn_y = 0, turn_z = 0;  ///< rolling angle that is stored [rad]
  bool is_old = true;                         ///< they touched at the step before
};

struct alignas(32) ForceQuad : std::array<double, 4> {};

/// Grains near walls, what they may touch, and their springs. Grains are in ascending order of row; the arrays of
/// contacts hold room for every candidate, so that a step allocates nothing and loses no wall.
struct WallContacts {
  std::vector<std::int32_t> grain;         ///< row
  std::vector<double> path;                ///< travelled since the rebuild, an upper bound [m]
  std::vector<std::int32_t> begin;         ///< of each grain in `candidates`
  std::vector<WallCandidate> candidates;   ///< of each grain ascending by key: those of one mesh together
  std::vector<std::int32_t> spring_begin;  ///< room of each grain in `springs`
  std::vector<std::int32_t> spring_count;
  std::vector<WallSpring> springs;
  std::vector<ForceQuad> force, torque;  ///< per grain of `grain`
};

/// Eight contacts with walls: their state as vectors, and what they do.
struct WallOctet {
  BasicContactState<Numbers> state;
  Numbers friction;
  BasicContactAction<Numbers> action;
  std::int64_t law[lanes_at_once];  ///< by material; only where there are several
  std::int64_t key[lanes_at_once];
  std::int32_t wall[lanes_at_once];
};

/// Contacts of one thread's grains in one step.
struct WallBatch {
  std::vector<WallOctet> octets;  ///< grow, so that a step soon allocates nothing
  std::size_t size = 0;
  std::vector<TriangleContact> touched;  ///< scratch of one grain
  WallForces force;                      ///< on walls that move, until they are taken over

  WallOctet const& octet(std::size_t contact) const { return octets[contact / lanes_at_once]; }
  double friction(std::size_t contact) const { return octet(contact).friction[contact % lanes_at_once]; }
  std::int32_t wall(std::size_t contact) const { return octet(contact).wall[contact % lanes_at_once]; }
  /// Before the step until act_on_walls, its spring and touch after it from then on.
  ContactState state(std::size_t contact) const;
};

/// Walls as the contacts see them.
struct WallScene {
  Walls const& walls;
  MovingWalls const& moving;
  double width;          ///< period along y [m]
  LawForm form = {};     ///< of contacts with walls
  double reach_gap = 0;  ///< up to which something acts beyond touch [m]
};

/// Triangles of the substrate and of the meshes by place, in their own frames.
using MeshGrids = std::vector<TriangleGrid>;
MeshGrids grids_of(Walls const& walls, double cell);

void build_wall_contacts(WallContacts& contacts, Grains const& grains, WallScene const& scene, MeshGrids const& grids,
                         double skin, std::vector<ContactSpring> const& springs);

void append_springs(WallContacts const& contacts, Grains const& grains, std::vector<LocalSpring>& springs);

/// Is a wall that moves among the candidates of grain `w` of the list?
bool is_near_moving_wall(WallContacts const& contacts, std::size_t w, MovingWalls const& moving);

/// Fills the batch with the contacts of the grains [from, to) of the list; sleeping ones have none. No allocation once
/// the batch has grown. \param laws  by material; one: of all grains
void list_wall_contacts(WallContacts& contacts, WallBatch& batch, Grains const& grains, WallScene const& scene,
                        std::vector<ContactLaw> const& laws, std::size_t from, std::size_t to);

/// What the listed contacts do to the grains [from, to) of the list.
/// \return largest overlap over the grain's diameter
double act_on_walls(WallContacts& contacts, WallBatch& batch, Grains const& grains, WallScene const& scene,
                    std::vector<ContactLaw> const& laws, double dt, std::size_t from, std::size_t to);

/// Velocity of a wall's surface where it touches [m/s], and spin of the wall about y [rad/s].
struct WallSurface {
  double vx, vz, spin;
};
WallSurface surface_of(WallScene const& scene, std::size_t wall, Vec3 const& normal);

/// Distance of a grain's centre from a candidate, now [m].
double distance_to(WallCandidate const& candidate, WallScene const& scene, Vec3 const& centre);

}  // namespace layerloop::dem
