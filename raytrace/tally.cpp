#include "raytrace/tally.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::raytrace {
namespace {

/// Cell half a cell below the surface (in a grain at most half its radius), so that it holds metal and not the gas in
/// front of it.
std::int64_t cell_at(Hit const& hit, BedScene const& scene, VoxelGrid const& grid) {
  double depth = 0.5 * grid.cell;
  if (hit.target == Target::grain) depth = std::min(depth, 0.5 * scene.radius(hit.row));
  Vec3 point = hit.point - depth * hit.normal;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    double const period = scene.period()[static_cast<std::size_t>(axis)], from = grid.origin[axis];
    if (period > 0) point[axis] -= period * std::floor((point[axis] - from) / period);
  }
  std::array<std::int64_t, 3> const c = grid.locate(point);
  return grid.contains(c) ? grid.index(c[0], c[1], c[2]) : -1;
}

std::int32_t pixel_at(Vec3 const& point, AreaMap const& map) {
  double const i = std::floor((point.x() - map.x0) / map.spacing), j = std::floor((point.y() - map.y0) / map.spacing);
  if (!(i >= 0 && i < map.nx && j >= 0 && j < map.ny)) return -1;
  return static_cast<std::int32_t>(i) + map.nx * static_cast<std::int32_t>(j);
}

/// Mean over replicates and its standard error. \param total  of replicate r
template <class Total>
RayTally::Estimate over_replicates(std::size_t replicates, std::int64_t replicate_rays, Total const& total) {
  double mean = 0, squares = 0;
  for (std::size_t r = 0; r < replicates; ++r) {  // Welford's update
    double const value = total(r) / static_cast<double>(replicate_rays), delta = value - mean;
    mean += delta / static_cast<double>(r + 1);
    squares += delta * (value - mean);
  }
  return {mean, std::sqrt(squares / static_cast<double>(replicates * (replicates - 1)))};
}

}  // namespace

Deposit deposit_at(Hit const& hit, double share, BedScene const& scene, Places const& places) {
  return {share, places.grid ? cell_at(hit, scene, *places.grid) : -1,
          hit.target == Target::grain ? hit.row : std::int32_t{-1},
          places.map.nx > 0 ? pixel_at(hit.point, places.map) : std::int32_t{-1}};
}

std::size_t depth_bin(double z, Places const& places, std::size_t bins) {
  double const bin = (z - places.bottom) / (places.top - places.bottom) * static_cast<double>(bins);
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins - 1)));
}

RayTally::RayTally(TallyLayout const& layout, Places const& places, std::size_t grains, std::int64_t replicates)
    : layout(layout),
      replicate(static_cast<std::size_t>(replicates), std::vector<CompensatedSum>(layout.size())),
      map(places.map.nx > 0 ? replicate.size() : 0,
          std::vector<CompensatedSum>(static_cast<std::size_t>(std::int64_t{places.map.nx} * places.map.ny))),
      grain(places.grains ? grains : 0),
      cell_place_(places.grid ? static_cast<std::size_t>(places.grid->size()) : 0) {}

void RayTally::add(BlockTally const& block, std::size_t r) {
  for (std::size_t i = 0; i < block.sums.size(); ++i) replicate[r][i].add(block.sums[i]);
  for (Deposit const& d : block.deposits) {
    if (!grain.empty() && d.row >= 0) grain[static_cast<std::size_t>(d.row)].add(d.share);
    if (!map.empty()) (d.pixel < 0 ? outside_map : map[r][static_cast<std::size_t>(d.pixel)]).add(d.share);
    if (cell_place_.empty()) continue;
    if (d.cell < 0) {
      outside_grid.add(d.share);
      continue;
    }
    std::int32_t& place = cell_place_[static_cast<std::size_t>(d.cell)];
    if (place == 0) {
      cell_sums_.push_back({d.cell, {}});
      place = static_cast<std::int32_t>(cell_sums_.size());
    }
    cell_sums_[static_cast<std::size_t>(place - 1)].sum.add(d.share);
  }
}

std::vector<std::pair<std::int64_t, double>> RayTally::cells() const {
  std::vector<std::pair<std::int64_t, double>> cells;
  for (CellSum const& lit : cell_sums_) cells.emplace_back(lit.cell, lit.sum.value());
  std::ranges::sort(cells);
  return cells;
}

RayTally::Estimate RayTally::estimate(std::size_t figure) const {
  return over_replicates(replicate.size(), replicate_rays, [&](std::size_t r) { return replicate[r][figure].value(); });
}

RayTally::Estimate RayTally::absorptivity(std::size_t set) const {
  return over_replicates(replicate.size(), replicate_rays, [&](std::size_t r) {
    double sum = 0;
    for (std::size_t m = 0; m < layout.materials; ++m) sum += replicate[r][layout.absorbed(set, m)].value();
    return sum;
  });
}

RayTally::Estimate RayTally::pixel(std::size_t index) const {
  return over_replicates(replicate.size(), replicate_rays, [&](std::size_t r) { return map[r][index].value(); });
}

}  // namespace layerloop::raytrace
