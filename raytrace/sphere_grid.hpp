#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/huge_pages.hpp"
#include "core/vec3.hpp"
#include "raytrace/lanes.hpp"
#include "raytrace/sphere.hpp"

namespace layerloop::raytrace {

/// Spheres sorted into the cells of a uniform grid, each cell with a copy of all that reach into it, eight to a pack. A
/// ray walks from cell to cell (Amanatides & Woo, Eurographics 1987, 3) and stops in the first one that it hits
/// something in. In a bed of similar grains the free path is about one diameter, so that it sees two or three cells and
/// no hierarchy could be shorter.
class SphereGrid {
 public:
  /// \param spheres  with copies of all that reach over a periodic side
  /// \param tile     lower corner of the periodic tile in the coordinates of the spheres
  /// \param period   of the tile along x and y; 0: open
  SphereGrid(std::span<Sphere const> spheres, std::array<double, 2> tile, std::array<double, 2> period);

  /// Goes round through the periodic sides.
  LocalHit first_hit(LocalRay const& ray) const;
  /// The spheres and copies as they stand, up to the distance `limit`.
  LocalHit first_hit_in_tile(LocalRay const& ray, double limit) const;

  /// How many spheres share the cell of a copy, on average over the copies: what a ray must look at where the powder
  /// is.
  double crowding() const { return crowding_; }
  std::size_t bytes() const;

 private:
  struct Pack {
    Numbers x, y, z, radius;
  };
  /// Cells along one axis. On a periodic axis those of the tile have cells beside them, which hold the parts of copies
  /// that stick out: only pictures show them.
  struct Axis {
    double lower = 0;                                      ///< of the first cell [m]
    double edge = 0, inverse_edge = 0;                     ///< of a cell [m], [1/m]
    double period = 0;                                     ///< [m]; 0: open
    std::int32_t cells = 0, tile_begin = 0, tile_end = 0;  ///< in all, and the range of the tile
  };

  struct Walk;

  void choose_cells(std::span<Sphere const> spheres, std::array<double, 2> tile, std::array<double, 2> period);
  template <class Visit>
  void visit_cells(Sphere const& sphere, Visit&& visit) const;
  std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>(i + axis_[0].cells * (j + std::int64_t{axis_[1].cells} * k));
  }
  template <bool around>
  bool enter(LocalRay& ray, double limit, Walk& walk) const;
  LocalHit hit_at(LocalRay const& ray, double distance, std::size_t lane) const;
  template <bool around>
  LocalHit walk(LocalRay ray, double limit) const;

  std::array<Axis, 3> axis_;
  std::vector<std::uint32_t> first_pack_;  ///< by cell, and the end
  std::vector<Pack, HugePages<Pack>> packs_;
  double crowding_ = 0;
  std::vector<std::int32_t> sphere_;  ///< by lane of the packs; -1: empty
};

}  // namespace layerloop::raytrace
