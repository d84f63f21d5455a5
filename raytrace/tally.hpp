#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "core/area_map.hpp"
#include "core/compensated_sum.hpp"
#include "core/voxel_grid.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::raytrace {

/// Where each figure of a trace stands in a row of sums. All are counted in rays: a share of the power of one ray.
struct TallyLayout {
  std::size_t sets, materials, depth_bins;

  std::size_t hits() const { return 0; }  ///< of rays that set 0 still carries power along
  std::size_t escaped(std::size_t set) const { return 1 + set * (3 + 3 * materials); }
  std::size_t residual(std::size_t set) const { return escaped(set) + 1; }
  std::size_t substrate(std::size_t set) const { return escaped(set) + 2; }
  std::size_t absorbed(std::size_t set, std::size_t material) const { return escaped(set) + 3 + material; }
  /// Derivatives of the absorbed share with respect to n and k of a material.
  std::size_t slope_n(std::size_t set, std::size_t material) const { return absorbed(set, materials + material); }
  std::size_t slope_k(std::size_t set, std::size_t material) const { return absorbed(set, 2 * materials + material); }
  std::size_t depth(std::size_t bin) const { return escaped(sets) + bin; }  ///< absorbed in a layer, of set 0
  std::size_t size() const { return depth(depth_bins); }
};

/// By which places absorbed power is sorted.
struct Places {
  bool grains = false;
  VoxelGrid const* grid = nullptr;  ///< cells, or none
  AreaMap map{};                    ///< pixels seen from above (values unused); nx = 0: none
  double bottom = 0, top = 0;       ///< of the depth profile [m]; what lies beyond counts in its first or last layer

  bool any() const { return grains || grid || map.nx > 0; }
};

/// Power absorbed at one hit under set 0.
struct Deposit {
  double share;
  std::int64_t cell;   ///< -1: outside of the grid
  std::int32_t row;    ///< of a grain; -1: substrate
  std::int32_t pixel;  ///< -1: outside of the map
};

/// What one block of rays leaves behind.
struct BlockTally {
  std::vector<double> sums;  ///< by TallyLayout
  std::vector<Deposit> deposits;
};

Deposit deposit_at(Hit const& hit, double share, BedScene const& scene, Places const& places);
std::size_t depth_bin(double z, Places const& places, std::size_t bins);

/// Sum over all blocks, which must be added in a fixed order: then it is the same to the bit for any number of threads
/// and ranks.
struct RayTally {
  RayTally(TallyLayout const& layout, Places const& places, std::size_t grains, std::int64_t replicates);

  void add(BlockTally const& block, std::size_t replicate);

  TallyLayout layout;
  std::vector<std::vector<CompensatedSum>> replicate;  ///< rows of sums
  std::vector<std::vector<CompensatedSum>> map;        ///< pixels, by replicate
  std::vector<CompensatedSum> grain;
  CompensatedSum outside_grid, outside_map;
  std::int64_t replicate_rays = 0;  ///< so far, in each

  /// Cells that absorb, ascending, and what they do.
  std::vector<std::pair<std::int64_t, double>> cells() const;

  /// A figure as share of what fell in, with its standard error from the scatter of the replicates.
  struct Estimate {
    double value, error;
  };
  Estimate estimate(std::size_t figure) const;
  Estimate absorptivity(std::size_t set) const;
  Estimate pixel(std::size_t index) const;
  double rays() const { return static_cast<double>(replicate_rays) * static_cast<double>(replicate.size()); }

 private:
  struct CellSum {
    std::int64_t cell;
    CompensatedSum sum;
  };
  std::vector<CellSum> cell_sums_;        // of the cells that absorb, as they come
  std::vector<std::int32_t> cell_place_;  // by cell: 1 + index into them; few of many cells are lit
};

}  // namespace layerloop::raytrace
