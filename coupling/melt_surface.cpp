#include "coupling/melt_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "coupling/surface_level.hpp"

namespace layerloop::coupling {
namespace {

/// Columns along x, [first, last], in which a map differs from another; empty: first > last.
std::array<std::int64_t, 2> changed_range(HeightMap const& now, HeightMap const& before) {
  std::array<std::int64_t, 2> range{now.nx, -1};
  for (std::size_t p = 0; p < now.values.size(); ++p) {
    if (std::abs(now.values[p] - before.values[p]) <= 1e-9 * now.spacing) continue;
    auto const i = static_cast<std::int64_t>(p) % now.nx;
    range = {std::min(range[0], i), std::max(range[1], i)};
  }
  return range;
}

/// Adds what of a triangle lies on one side of the plane x = at: below (-1) or above (1).
void add_part(TriangleSurface& surface, std::array<Vec3, 3> const& corner, double at, int side) {
  std::vector<Vec3> part;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 const &from = corner[k], &to = corner[(k + 1) % 3];
    double const a = side * (from.x() - at), b = side * (to.x() - at);
    if (a >= 0) part.push_back(from);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) part.push_back(from + a / (a - b) * (to - from));
  }
  auto const base = static_cast<std::int32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), part.begin(), part.end());
  for (std::int32_t k = 2; k < std::ssize(part); ++k) surface.triangles.push_back({base, base + k - 1, base + k});
}

/// Adds the height map between two columns along x as triangles, continued periodically beyond both y sides.
void add_height_map(TriangleSurface& surface, HeightMap const& top, std::int64_t first, std::int64_t last,
                    std::int64_t margin) {
  auto const base = static_cast<std::int32_t>(surface.vertices.size());
  std::int64_t const rows = top.ny + 2 * margin, columns = last - first + 1;
  for (std::int64_t j = -margin; j < top.ny + margin; ++j) {
    auto const wrapped = static_cast<std::int32_t>((j % top.ny + top.ny) % top.ny);
    for (std::int64_t i = first; i <= last; ++i) {
      surface.vertices.emplace_back(top.x0 + (static_cast<double>(i) + 0.5) * top.spacing,
                                    top.y0 + (static_cast<double>(j) + 0.5) * top.spacing,
                                    top.at(static_cast<std::int32_t>(i), wrapped));
    }
  }
  for (std::int64_t j = 0; j + 1 < rows; ++j) {
    for (std::int64_t i = 0; i + 1 < columns; ++i) {
      auto const a = base + static_cast<std::int32_t>(i + columns * j), b = a + 1,
                 c = a + static_cast<std::int32_t>(columns), d = c + 1;
      surface.triangles.push_back({a, b, d});
      surface.triangles.push_back({a, d, c});
    }
  }
}

/// Lowers the map to the keyhole's wall. \param keyhole  over the columns of `heated`, whose lattice is the map's
void lower(HeightMap& top, std::vector<double> const& keyhole, VoxelGrid const& heated) {
  if (keyhole.empty()) return;
  auto const first_x = static_cast<std::int32_t>(std::llround((heated.origin.x() - top.x0) / top.spacing)),
             first_y = static_cast<std::int32_t>(std::llround((heated.origin.y() - top.y0) / top.spacing));
  for (std::int32_t j = 0; j < heated.n[1]; ++j) {
    for (std::int32_t i = 0; i < heated.n[0]; ++i) {
      std::int64_t const pixel = first_x + i + std::int64_t{top.nx} * (first_y + j);
      double& height = top.values[static_cast<std::size_t>(pixel)];
      height = std::min(height, keyhole[static_cast<std::size_t>(i + std::int64_t{heated.n[0]} * j)]);
    }
  }
}

}  // namespace

MeltSurface::MeltSurface(SolidField const& solid, PowderBed const& bed, TriangleSurface const& substrate,
                         CellContent const& cells, Case const& checked)
    : solid_(solid),
      bed_(bed),
      substrate_(substrate),
      heated_(cells.grid),
      checked_(checked),
      grains_(grains_near(solid_, bed, checked, cells.grid)),
      before_(top_of_solid(solid_, checked)),
      top_(before_),
      left_(bed),
      melted_(static_cast<std::size_t>(cells.grid.size()), 0),
      scene_(std::make_unique<raytrace::BedScene>(bed, substrate, std::array{0.0, checked.period_y()})) {}

/// The substrate with the columns [first, last] of the map in its place.
TriangleSurface MeltSurface::surface_of(HeightMap const& top, std::int64_t first, std::int64_t last) const {
  double const low = top.x0 + (static_cast<double>(first) + 0.5) * top.spacing,
               high = top.x0 + (static_cast<double>(last) + 0.5) * top.spacing,
               under = solid_.plate_top() - 0.5 * top.spacing;
  TriangleSurface surface{substrate_.vertices, {}};
  for (std::size_t t = 0; t < substrate_.triangles.size(); ++t) {
    std::array const corner{substrate_.corner(t, 0), substrate_.corner(t, 1), substrate_.corner(t, 2)};
    auto const [first_x, last_x] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
    bool const beside = last_x <= low || first_x >= high;
    if (beside || std::min({corner[0].z(), corner[1].z(), corner[2].z()}) < under) {
      surface.triangles.push_back(substrate_.triangles[t]);
      continue;
    }
    add_part(surface, corner, low, -1);
    add_part(surface, corner, high, 1);
  }
  double const widest = bed_.size() == 0 ? 0.0 : std::ranges::max(bed_.radius);
  add_height_map(surface, top, first, last, static_cast<std::int64_t>(std::ceil(widest / top.spacing)) + 1);
  return surface;
}

void MeltSurface::update(MeltState const& now) {
  std::vector<char> melted = now.melted();
  if (melted != melted_) {
    melted_ = std::move(melted);
    SolidField solid = solid_;
    MeltedDown const down = melt_down(solid, bed_, grains_, {heated_, melted_}, checked_.laser.spot_radius(), checked_);
    left_ = bed_;
    std::vector<char> keep(down.taken.size());
    std::ranges::transform(down.taken, keep.begin(), [](char taken) { return taken == 0; });
    left_.retain(keep);
    top_ = top_of_solid(solid, checked_);
    build_scene();
  }
  sink(now.keyhole);
}

void MeltSurface::sink(std::vector<double> const& keyhole) {
  if (keyhole == keyhole_) return;
  keyhole_ = keyhole;
  build_scene();
}

void MeltSurface::build_scene() {
  constexpr std::int64_t ring = 2;  // columns around what changed: there the map is the height of the old surface
  HeightMap top = top_;
  lower(top, keyhole_, heated_);
  auto const [first, last] = changed_range(top, before_);
  TriangleSurface const surface = first > last ? substrate_
                                               : surface_of(top, std::max<std::int64_t>(0, first - ring),
                                                            std::min<std::int64_t>(top.nx - 1, last + ring));
  scene_ = std::make_unique<raytrace::BedScene>(left_, surface, std::array{0.0, checked_.period_y()});
}

}  // namespace layerloop::coupling
