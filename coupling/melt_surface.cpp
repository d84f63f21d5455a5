#include "coupling/melt_surface.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/surface_level.hpp"

namespace layerloop::coupling {
namespace {

/// Columns of the heat grid that hold a melted cell, as a range along x [m]; empty: from > to.
struct XRange {
  double from, to;
};

XRange melted_range(VoxelGrid const& grid, std::vector<char> const& melted) {
  std::int64_t first = grid.n[0], last = -1;
  for (std::int64_t cell = 0; cell < grid.size(); ++cell) {
    if (!melted[static_cast<std::size_t>(cell)]) continue;
    std::int64_t const i = cell % grid.n[0];
    first = std::min(first, i);
    last = std::max(last, i);
  }
  return {grid.origin.x() + static_cast<double>(first) * grid.cell,
          grid.origin.x() + static_cast<double>(last + 1) * grid.cell};
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

}  // namespace

MeltSurface::MeltSurface(SolidField const& solid, PowderBed const& bed, TriangleSurface const& substrate,
                         CellContent const& cells, Case const& checked)
    : solid_(solid),
      bed_(bed),
      substrate_(substrate),
      heated_(cells.grid),
      checked_(checked),
      grains_(grains_near(solid_, bed, checked, cells.grid)),
      melted_(static_cast<std::size_t>(cells.grid.size()), 0),
      scene_(std::make_unique<raytrace::BedScene>(bed, substrate, std::array{0.0, checked.period_y()})) {}

TriangleSurface MeltSurface::surface_of(SolidField const& solid, double x_from, double x_to) const {
  HeightMap const top = top_of_solid(solid, checked_);
  constexpr std::int64_t ring = 2;  // columns around what melted: there the map is the height of the old surface
  auto const column = [&](double x) { return std::llround((x - top.x0) / top.spacing); };
  std::int64_t const first = std::max<std::int64_t>(0, column(x_from) - ring),
                     last = std::min<std::int64_t>(top.nx - 1, column(x_to) - 1 + ring);
  double const low = top.x0 + (static_cast<double>(first) + 0.5) * top.spacing,
               high = top.x0 + (static_cast<double>(last) + 0.5) * top.spacing,
               under = solid.plate_top() - 0.5 * top.spacing;
  auto const is_replaced = [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 const p = substrate_.corner(t, k);
      if (p.x() < low || p.x() > high || p.z() < under) return false;
    }
    return true;
  };
  TriangleSurface surface{substrate_.vertices, {}};
  for (std::size_t t = 0; t < substrate_.triangles.size(); ++t) {
    if (!is_replaced(t)) surface.triangles.push_back(substrate_.triangles[t]);
  }
  double const widest = bed_.size() == 0 ? 0.0 : std::ranges::max(bed_.radius);
  add_height_map(surface, top, first, last, static_cast<std::int64_t>(std::ceil(widest / top.spacing)) + 1);
  return surface;
}

void MeltSurface::update(std::vector<char> const& melted) {
  if (melted == melted_) return;
  melted_ = melted;
  SolidField solid = solid_;
  MeltedDown const down =
      melt_down(solid, bed_, grains_, {heated_, melted_}, checked_.laser.spot_radius(), checked_.material.density);
  PowderBed left = bed_;
  std::vector<char> keep(down.taken.size());
  std::ranges::transform(down.taken, keep.begin(), [](char taken) { return taken == 0; });
  left.retain(keep);
  XRange const range = melted_range(heated_, melted_);
  scene_ = std::make_unique<raytrace::BedScene>(left, surface_of(solid, range.from, range.to),
                                                std::array{0.0, checked_.period_y()});
}

}  // namespace layerloop::coupling
