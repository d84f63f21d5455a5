#include "coupling/melt_section.hpp"

#include <cmath>

namespace layerloop::coupling {
namespace {

std::uint8_t state_of(CellContent const& cells, MeltRecord const& melt, std::size_t cell) {
  std::uint8_t const before = cells.solid[cell] >= 0.5 ? 2 : cells.solid[cell] + cells.powder[cell] >= 0.25 ? 1 : 0;
  return static_cast<std::uint8_t>(before + (melt.melted[cell] ? 4 : 0));
}

/// Pixels are the nearest cells along the normal of the track; y counts along it, from the y of the point.
MeltSection cut(MeltRecord const& melt, CellContent const& cells, Vec3 const& at, Vec3 const& along) {
  VoxelGrid const& grid = cells.grid;
  Vec3 const across(-along.y(), along.x(), 0), centre = grid.centre(grid.locate(at)[0], grid.locate(at)[1], 0);
  auto const inside = [&](std::int64_t step) {
    auto const c = grid.locate(centre + static_cast<double>(step) * grid.cell * across);
    return c[0] >= 0 && c[0] < grid.n[0] && c[1] >= 0 && c[1] < grid.n[1];
  };
  std::int64_t first = 0, last = 0;
  while (inside(first - 1)) --first;
  while (inside(last + 1)) ++last;
  MeltSection section{.x = at.x(),
                      .y0 = centre.y() + (static_cast<double>(first) - 0.5) * grid.cell,
                      .z0 = grid.origin.z(),
                      .cell = grid.cell,
                      .ny = static_cast<std::int32_t>(last - first + 1),
                      .nz = grid.n[2],
                      .peak_temperature = {},
                      .state = {}};
  for (std::int32_t k = 0; k < grid.n[2]; ++k) {
    for (std::int64_t step = first; step <= last; ++step) {
      auto const c = grid.locate(centre + static_cast<double>(step) * grid.cell * across);
      auto const cell = static_cast<std::size_t>(grid.index(c[0], c[1], k));
      section.peak_temperature.push_back(melt.peak_temperature[cell]);
      section.state.push_back(state_of(cells, melt, cell));
    }
  }
  return section;
}

}  // namespace

std::vector<MeltSection> melt_sections(MeltRecord const& melt, CellContent const& cells,
                                       std::vector<Track> const& tracks) {
  Track const& track = tracks.front();
  Vec3 const way = track.end - track.begin;
  double const sense = way.x() < -1e-12 || (std::abs(way.x()) < 1e-12 && way.y() < 0) ? -1 : 1;  // seen from one side
  Vec3 const from = sense > 0 ? track.begin : track.end;
  std::vector<MeltSection> sections;
  for (double const share : {0.25, 0.5, 0.75})
    sections.push_back(cut(melt, cells, from + share * sense * way, (sense * way).normalized()));
  return sections;
}

}  // namespace layerloop::coupling
