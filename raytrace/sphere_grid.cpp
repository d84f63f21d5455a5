#include "raytrace/sphere_grid.hpp"

#include <algorithm>
#include <bit>

namespace layerloop::raytrace {
namespace {

constexpr int max_crossings = 10000;
/// Edge of a cell over the mean diameter: bench/README.md, section rays.
constexpr double cell_over_diameter = 1.8;
/// Thin powder in a large box would otherwise have more empty cells than grains.
constexpr double max_cells_per_sphere = 16;
/// By how much of a cell a sphere is taken larger when it is sorted in: covers the rounding of a walk.
constexpr double slack = 1e-7;

/// Least and largest distance, squared, of a point from an interval.
struct Reach {
  double near, far;
};
Reach reach(double at, double from, double to) {
  double const near = std::max({from - at, at - to, 0.0}), far = std::max(at - from, to - at);
  return {near * near, far * far};
}

}  // namespace

void SphereGrid::choose_cells(std::span<Sphere const> spheres, std::array<double, 2> tile,
                              std::array<double, 2> period) {
  std::array<double, 3> lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity};
  double mean_diameter = 0;
  for (Sphere const& s : spheres) {
    std::array const centre{s.x, s.y, s.z};
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], centre[a] - s.radius);
      upper[a] = std::max(upper[a], centre[a] + s.radius);
    }
    mean_diameter += 2 * s.radius / static_cast<double>(spheres.size());
  }
  double const volume = (upper[0] - lower[0]) * (upper[1] - lower[1]) * (upper[2] - lower[2]);
  double const edge = std::max(cell_over_diameter * mean_diameter,
                               std::cbrt(volume / (max_cells_per_sphere * static_cast<double>(spheres.size()))));
  for (std::size_t a = 0; a < 3; ++a) {
    bool const periodic = a < 2 && period[a] > 0;
    double const size = periodic ? period[a] : upper[a] - lower[a];
    auto const count = static_cast<std::int32_t>(std::max(size / edge, 1.0));
    Axis& axis =
        axis_[a] = {periodic ? tile[a] : lower[a], size / count, count / size, periodic ? size : 0.0, count, 0, count};
    if (!periodic) continue;
    axis.tile_begin = static_cast<std::int32_t>(std::ceil(std::max(tile[a] - lower[a], 0.0) / axis.edge));
    axis.tile_end = axis.tile_begin + count;
    axis.cells =
        axis.tile_end + static_cast<std::int32_t>(std::ceil(std::max(upper[a] - tile[a] - size, 0.0) / axis.edge));
    axis.lower -= axis.tile_begin * axis.edge;
  }
}

/// Calls visit(cell) for every cell that the surface of the sphere passes through.
template <class Visit>
void SphereGrid::visit_cells(Sphere const& sphere, Visit&& visit) const {
  std::array const centre{sphere.x, sphere.y, sphere.z};
  std::array<std::int32_t, 3> begin, end;
  double const margin = slack * axis_[0].edge, outer = sphere.radius + margin, inner = sphere.radius - margin;
  for (std::size_t a = 0; a < 3; ++a) {
    Axis const& axis = axis_[a];
    auto const cell = [&](double at) {
      return std::clamp(static_cast<std::int32_t>(std::floor((at - axis.lower) / axis.edge)), 0, axis.cells - 1);
    };
    begin[a] = cell(centre[a] - outer);
    end[a] = cell(centre[a] + outer) + 1;
  }
  auto const reach_of = [&](std::size_t a, std::int32_t i) {
    double const from = axis_[a].lower + i * axis_[a].edge;
    return reach(centre[a], from, from + axis_[a].edge);
  };
  for (std::int32_t k = begin[2]; k < end[2]; ++k) {
    Reach const z = reach_of(2, k);
    for (std::int32_t j = begin[1]; j < end[1]; ++j) {
      Reach const y = reach_of(1, j);
      for (std::int32_t i = begin[0]; i < end[0]; ++i) {
        Reach const x = reach_of(0, i);
        bool const outside = x.near + y.near + z.near > outer * outer;
        bool const within = inner > 0 && x.far + y.far + z.far < inner * inner;  // no ray comes there
        if (!outside && !within) visit(index(i, j, k));
      }
    }
  }
}

SphereGrid::SphereGrid(std::span<Sphere const> spheres, std::array<double, 2> tile, std::array<double, 2> period) {
  choose_cells(spheres, tile, period);
  std::size_t cells = 1;
  for (Axis const& axis : axis_) cells *= static_cast<std::size_t>(axis.cells);

  std::vector<std::uint32_t> filled(cells, 0);  // lanes_at_once of each cell
  for (Sphere const& s : spheres) visit_cells(s, [&](std::size_t cell) { ++filled[cell]; });
  first_pack_.resize(cells + 1);
  std::uint32_t packs = 0;
  double copies = 0, squares = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    copies += filled[c];
    squares += static_cast<double>(filled[c]) * filled[c];
    first_pack_[c] = packs;
    packs += (filled[c] + lanes_at_once - 1) / lanes_at_once;
    filled[c] = 0;
  }
  first_pack_[cells] = packs;
  crowding_ = squares / copies;

  Pack nobody{};
  nobody.x = infinity + Numbers{};  // its distance is never a number
  packs_.assign(packs, nobody);
  sphere_.assign(packs * lanes_at_once, -1);
  for (std::size_t row = 0; row < spheres.size(); ++row) {
    Sphere const& s = spheres[row];
    visit_cells(s, [&](std::size_t cell) {
      std::size_t const at = filled[cell]++, lane = at % lanes_at_once, pack = first_pack_[cell] + at / lanes_at_once;
      packs_[pack].x[lane] = s.x;
      packs_[pack].y[lane] = s.y;
      packs_[pack].z[lane] = s.z;
      packs_[pack].radius[lane] = s.radius;
      sphere_[pack * lanes_at_once + lane] = static_cast<std::int32_t>(row);
    });
  }
}

/// Where a ray is in the grid, and how far along it the next sides of its cell are.
struct SphereGrid::Walk {
  std::array<std::int32_t, 3> cell, step, end;  // of the last cell before a side, one further
  std::array<double, 3> exit, between;          // distance to the next side of the cell, and from side to side
  double leave;                                 // distance at which the ray is past everything

  /// Axis of the side that comes first.
  std::size_t next() const { return exit[0] < exit[1] ? (exit[0] < exit[2] ? 0 : 2) : (exit[1] < exit[2] ? 1 : 2); }
};

/// Puts the ray into its tile and finds the first cell. \return whether it comes to the grid at all
template <bool around>
bool SphereGrid::enter(LocalRay& ray, double limit, Walk& walk) const {
  std::array<double*, 3> const origin{&ray.ox, &ray.oy, &ray.oz};
  std::array const direction{ray.dx, ray.dy, ray.dz}, inverse{1 / ray.dx, 1 / ray.dy, 1 / ray.dz};
  double enter = 0;
  walk.leave = limit;
  for (std::size_t a = 0; a < 3; ++a) {
    Axis const& axis = axis_[a];
    if (around && axis.period > 0) continue;
    double const from = axis.lower - *origin[a], to = from + axis.cells * axis.edge;
    if (direction[a] == 0) {
      if (from > 0 || to < 0) return false;
      continue;
    }
    double const one = from * inverse[a], other = to * inverse[a];
    enter = std::max(enter, std::min(one, other));
    walk.leave = std::min(walk.leave, std::max(one, other));
  }
  if (!(enter <= walk.leave)) return false;

  for (std::size_t a = 0; a < 3; ++a) {
    Axis const& axis = axis_[a];
    bool const tiled = around && axis.period > 0, up = direction[a] > 0;
    std::int32_t const begin = tiled ? axis.tile_begin : 0, stop = tiled ? axis.tile_end : axis.cells;
    double at = (*origin[a] + enter * direction[a] - axis.lower) * axis.inverse_edge;  // in cells
    if (tiled && !(at >= begin && at < stop)) {
      double const periods = std::floor((at - begin) / (stop - begin));
      *origin[a] -= periods * axis.period;
      at -= periods * (stop - begin);
    }
    std::int32_t const cell = std::clamp(static_cast<std::int32_t>(at), begin, stop - 1);
    walk.cell[a] = cell;
    walk.step[a] = up ? 1 : -1;
    walk.end[a] = up ? stop : begin - 1;
    walk.exit[a] = direction[a] == 0 ? infinity : (axis.lower + (cell + up) * axis.edge - *origin[a]) * inverse[a];
    walk.between[a] = axis.edge * std::abs(inverse[a]);
  }
  return true;
}

LocalHit SphereGrid::hit_at(LocalRay const& ray, double distance, std::size_t lane) const {
  Pack const& pack = packs_[lane / lanes_at_once];
  std::size_t const l = lane % lanes_at_once;
  LocalHit hit;
  hit.distance = distance;
  hit.sphere = sphere_[lane];
  hit.point = Vec3(ray.ox, ray.oy, ray.oz) + distance * Vec3(ray.dx, ray.dy, ray.dz);
  hit.normal = unit((1 / pack.radius[l]) * (hit.point - Vec3(pack.x[l], pack.y[l], pack.z[l])));
  return hit;
}

/// `around`: through the periodic sides.
template <bool around>
LocalHit SphereGrid::walk(LocalRay ray, double limit) const {
  Walk walk;
  if (!enter<around>(ray, limit, walk)) return {};
  Numbers nearest = infinity + Numbers{};
  Flags place{};  // lane of the packs
  for (int crossings = 0;;) {
    std::size_t const here = index(walk.cell[0], walk.cell[1], walk.cell[2]);
    for (std::uint32_t p = first_pack_[here]; p < first_pack_[here + 1]; ++p) {
      Pack const& pack = packs_[p];
      Numbers const distance =
          entry_distance<Numbers>(pack.x - ray.ox, pack.y - ray.oy, pack.z - ray.oz, pack.radius, ray);
      Flags const nearer = distance < nearest;
      nearest = nearer ? distance : nearest;
      place = nearer ? Flags{0, 1, 2, 3, 4, 5, 6, 7} + static_cast<std::int64_t>(p * lanes_at_once) : place;
    }
    std::size_t const a = walk.next();
    if (bits(nearest <= walk.exit[a]) || walk.exit[a] >= walk.leave) break;
    walk.cell[a] += walk.step[a];
    walk.exit[a] += walk.between[a];
    if (walk.cell[a] != walk.end[a]) continue;
    if (!around || !(axis_[a].period > 0)) break;
    if (++crossings > max_crossings) {
      LocalHit lost;
      lost.undecided = true;
      return lost;
    }
    // Into the next tile: what reaches over the side is met there again, as its copy.
    walk.cell[a] -= walk.step[a] * (axis_[a].tile_end - axis_[a].tile_begin);
    (a == 0 ? ray.ox : ray.oy) -= walk.step[a] * axis_[a].period;
    nearest = infinity + Numbers{};
  }
  double const distance = least(nearest);
  if (!(distance <= limit) || distance == infinity) return {};
  return hit_at(ray, distance, static_cast<std::size_t>(place[std::countr_zero(bits(nearest == distance))]));
}

LocalHit SphereGrid::first_hit(LocalRay const& ray) const { return walk<true>(ray, infinity); }

LocalHit SphereGrid::first_hit_in_tile(LocalRay const& ray, double limit) const { return walk<false>(ray, limit); }

std::size_t SphereGrid::bytes() const {
  return first_pack_.size() * sizeof(std::uint32_t) + packs_.size() * sizeof(Pack) +
         sphere_.size() * sizeof(std::int32_t);
}

}  // namespace layerloop::raytrace
