#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/triangle_surface.hpp"

namespace layerloop::dem {

/// A wall that gives way along z: m z'' + c z' + k z = force of the grains; z = 0 is its place at rest.
struct Suspension {
  double mass = 0;       ///< m [kg]
  double stiffness = 0;  ///< k [N/m]
  double damping = 0;    ///< c [N s/m]
};

/// How a wall moves: steadily, shaking along z as amplitude sin(2 pi frequency t), and as its suspension yields.
struct WallMotion {
  double velocity = 0;   ///< along x [m/s]
  double amplitude = 0;  ///< [m]
  double frequency = 0;  ///< [Hz]
  std::optional<Suspension> suspension = {};
};

/// A bar with rounded edges: a rectangle in x-z with quarter circles at its corners, endless along y. Planes and
/// cylinders in one primitive: a grain has at most one contact with it, and none of the steps that a row of triangles
/// would have. The corners may be quarters of a super-ellipse |x/e|^n + |z/e|^n = 1 instead (n = 2: circles); such
/// blades: Haeri, Powder Technol. 321 (2017) 94.
struct RoundedBlock {
  std::string name;
  double x0 = 0, x1 = 0, z0 = 0, z1 = 0;  ///< [m] at time 0
  double edge_radius = 0;                 ///< e [m], at most half of either side
  WallMotion motion = {};
  std::optional<double> friction = {};  ///< instead of the walls' own
  double edge_exponent = 2;             ///< n >= 2
};

/// A cylinder along y that may turn.
struct Roller {
  std::string name;
  double x = 0, z = 0, radius = 0;  ///< axis [m] at time 0
  double spin = 0;                  ///< about y [rad/s]; positive: the lowest line moves towards -x
  WallMotion motion = {};
  std::optional<double> friction = {};
};

/// A coin: vertical axis, rounded rim. It must be smaller than the period along y.
struct RoundTable {
  std::string name;
  double x = 0, y = 0, z_top = 0;  ///< axis and upper face [m]
  double radius = 0;
  double edge_radius = 0;  ///< of both rims [m], at most half of `thickness`
  double thickness = 0;
};

/// Triangles that move as one; the surface spans at least one period along y.
struct MeshWall {
  std::string name;
  TriangleSurface surface;
  WallMotion motion = {};
  std::optional<double> friction = {};
};

/// Everything that holds grains. Walls are numbered: blocks, rollers, tables, the substrate, meshes.
struct Walls {
  std::vector<RoundedBlock> blocks;
  std::vector<Roller> rollers;
  std::vector<RoundTable> tables;
  TriangleSurface substrate;  ///< closed, reaching beyond the periodic width; may be empty
  std::vector<MeshWall> meshes;

  std::size_t primitives() const { return blocks.size() + rollers.size() + tables.size(); }
  std::size_t size() const { return primitives() + 1 + meshes.size(); }
  std::string const& name(std::size_t wall) const;
  WallMotion const& motion(std::size_t wall) const;
  std::optional<double> friction(std::size_t wall) const;
  /// Of a wall with a number from primitives() on.
  TriangleSurface const& surface(std::size_t wall) const;
};

/// How far a wall has gone, and how fast it goes.
struct WallPose {
  double dx = 0, dz = 0;  ///< [m]
  double vx = 0, vz = 0;  ///< [m/s]
  double path = 0;        ///< travelled so far, an upper bound [m]
};

/// Distance of a point from a wall [m], negative inside, and the unit normal that points away from the wall.
struct WallPoint {
  double distance, nx, ny, nz;
};

/// Exact; a super-elliptic corner to 1e-14 of its radius.
WallPoint nearest(RoundedBlock const& block, double x, double z);
/// A primitive in its place at time 0; `width` is the period along y.
WallPoint nearest(Walls const& walls, std::size_t wall, double width, Vec3 const& p);

/// Springs of walls carry the key -1 - wall key, and outlive a rig: a wall keeps its place among its kind.
inline constexpr std::int64_t first_roller_key = 400, first_table_key = 600, first_triangle_key = 1000;
inline constexpr std::int64_t keys_a_mesh = std::int64_t{1} << 32;
constexpr std::int64_t wall_key_of(std::int64_t key_b) { return -1 - key_b; }
std::int64_t key_of(Walls const& walls, std::size_t wall);

}  // namespace layerloop::dem
