#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "core/vec3.hpp"

namespace layerloop::raytrace {

struct Ray {
  Vec3 origin;     ///< [m]
  Vec3 direction;  ///< unit length
};

/// What a ray meets first.
enum class Target {
  grain,
  substrate,
  nothing,   ///< leaves the scene
  undecided  ///< crossed the tile too often: runs level through an empty periodic gap
};

struct Hit {
  Target target = Target::nothing;
  std::int32_t row = -1;       ///< of the grain in the bed, or of the substrate triangle
  Vec3 point = Vec3::Zero();   ///< [m], inside the tile where the scene is periodic
  Vec3 normal = Vec3::Zero();  ///< outward unit normal
};

/// What finds the grain that a ray meets first. The hits are the same (one closed form in double precision).
enum class Backend {
  automatic,  ///< the faster one for the sizes of this bed
  grid,       ///< sphere_grid.hpp: grains of similar size
  embree      ///< embree_scene.hpp: any sizes
};

/// A powder bed and the triangles below it, ready for ray queries. Surfaces are seen from outside only: a ray that
/// leaves a grain or a triangle cannot meet it from within, so no offset of ray origins is needed, and overlapping
/// grains are one body, the union of their balls. Triangles are always Embree's. Queries are const and safe from many
/// threads.
class BedScene {
 public:
  /// Makes and keeps copies of what it needs: later changes of bed or substrate are not seen.
  /// \param period  edge of the periodic tile [0, period) along x and y [m]; 0: open on these sides. Grains that reach
  ///                over a periodic edge are copied to the other side; the substrate must reach over it by itself.
  /// \throws InputError    nothing to trace, or a grain centre outside a periodic tile
  /// \throws PhysicsError  coordinates that are not numbers
  BedScene(PowderBed const& bed, TriangleSurface const& substrate, std::array<double, 2> period = {0, 0},
           Backend backend = Backend::automatic);
  ~BedScene();
  BedScene(BedScene&&) noexcept;

  /// First surface along the ray, which goes round through the periodic sides as often as needed.
  Hit first_hit(Ray const& ray) const;
  /// The same without periodicity: the tile and the copied grains at its edges as they stand, for pictures.
  Hit first_hit_in_tile(Ray const& ray) const;
  /// Whether anything lies within `distance` [m] along the ray (no periodicity).
  bool is_blocked(Ray const& ray, double distance) const;

  Backend backend() const;                        ///< the one that serves; never automatic
  std::int32_t grains() const;                    ///< rows of the bed
  double radius(std::int32_t row) const;          ///< of a grain [m]
  std::int32_t material(std::int32_t row) const;  ///< of a grain
  TriangleSurface const& substrate() const;
  std::array<double, 2> const& period() const;  ///< along x and y [m]; 0: open
  Vec3 const& lower() const;                    ///< corners of the box around everything [m]
  Vec3 const& upper() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace layerloop::raytrace
