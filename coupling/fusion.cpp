#include "coupling/fusion.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace layerloop::coupling {
namespace {

/// The tracks as lines at distances from the first one.
struct Lines {
  Vec3 origin, along, across;
  std::vector<double> offset;  ///< ascending [m]
  double length;               ///< of the shortest [m]
};

std::optional<Lines> lines_of(std::vector<Track> const& tracks) {
  if (tracks.size() < 2) return std::nullopt;
  Vec3 const along = (tracks[0].end - tracks[0].begin).normalized();
  Lines lines{0.5 * (tracks[0].begin + tracks[0].end), along, {-along.y(), along.x(), 0}, {}, 1e300};
  for (Track const& track : tracks) {
    Vec3 const way = track.end - track.begin;
    if (std::abs(way.normalized().dot(lines.across)) > 1e-6) return std::nullopt;
    lines.offset.push_back((0.5 * (track.begin + track.end) - lines.origin).dot(lines.across));
    lines.length = std::min(lines.length, way.norm());
  }
  std::ranges::sort(lines.offset);
  return lines.offset.back() - lines.offset.front() > 1e-9 ? std::optional(lines) : std::nullopt;
}

/// Melted depth of a column below its solid [m], the isotherm interpolated between cells; nothing where its surface
/// did not melt.
std::optional<double> melted_depth(MeltRecord const& melt, CellContent const& content, std::int32_t i, std::int32_t j,
                                   double isotherm) {
  VoxelGrid const& grid = melt.grid;
  auto const cell = [&](std::int32_t k) { return static_cast<std::size_t>(grid.index(i, j, k)); };
  std::int32_t k = grid.n[2] - 1;
  while (k > 0 && content.solid[cell(k)] < 0.5) --k;
  double const surface = k + content.solid[cell(k)];
  if (melt.peak_temperature[cell(k)] < isotherm) return std::nullopt;
  while (k > 0 && melt.peak_temperature[cell(k - 1)] >= isotherm) --k;
  double const T = melt.peak_temperature[cell(k)], below = k > 0 ? melt.peak_temperature[cell(k - 1)] : isotherm - 1;
  return (surface - (k + 0.5 - (T - isotherm) / (T - below))) * grid.cell;
}

double elliptic_overlap(PoolSize const& pool, std::vector<double> const& offset) {
  double widest = 0;
  for (std::size_t t = 1; t < offset.size(); ++t) widest = std::max(widest, offset[t] - offset[t - 1]);
  double const share = widest / pool.width;
  return share < 1 ? pool.depth * std::sqrt(1 - share * share) : 0.0;
}

}  // namespace

std::optional<Fusion> fusion_of(MeltRecord const& melt, CellContent const& content, std::vector<Track> const& tracks,
                                double isotherm) {
  std::optional<Lines> const lines = lines_of(tracks);
  if (!lines) return std::nullopt;
  VoxelGrid const& grid = melt.grid;
  struct Line {
    double depth = 0, columns = 0;
  };
  std::map<std::int64_t, Line> on_line;  // by distance from the first, in cells
  double powder = 0, unmelted = 0, columns = 0, unmelted_columns = 0;
  for (std::int32_t j = 0; j < grid.n[1]; ++j) {
    for (std::int32_t i = 0; i < grid.n[0]; ++i) {
      Vec3 const from = grid.centre(i, j, 0) - lines->origin;
      double const across = from.dot(lines->across);
      if (std::abs(from.dot(lines->along)) > 0.25 * lines->length || across < lines->offset.front() ||
          across > lines->offset.back())
        continue;
      ++columns;
      std::optional<double> const depth = melted_depth(melt, content, i, j, isotherm);
      unmelted_columns += !depth;
      Line& line = on_line[std::llround(std::floor((across - lines->offset.front()) / grid.cell))];
      line.depth += depth.value_or(0);
      ++line.columns;
      for (std::int32_t k = 0; k < grid.n[2]; ++k) {
        auto const c = static_cast<std::size_t>(grid.index(i, j, k));
        powder += content.powder[c];
        if (!melt.melted[c]) unmelted += content.powder[c];
      }
    }
  }
  if (columns == 0) return std::nullopt;
  Fusion fusion{.unmelted_powder = powder > 0 ? std::optional(unmelted / powder) : std::nullopt,
                .unmelted_surface = unmelted_columns / columns,
                .overlap_depth = 1e300,
                .elliptic_overlap_depth = elliptic_overlap(melt.pool, lines->offset)};
  for (auto const& [at, line] : on_line)
    fusion.overlap_depth = std::min(fusion.overlap_depth, line.depth / line.columns);
  return fusion;
}

}  // namespace layerloop::coupling
