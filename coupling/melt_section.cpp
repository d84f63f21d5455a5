#include "coupling/melt_section.hpp"

#include <algorithm>

namespace layerloop::coupling {
namespace {

std::uint8_t state_of(CellContent const& cells, MeltRecord const& melt, std::size_t cell) {
  std::uint8_t const before = cells.solid[cell] >= 0.5 ? 2 : cells.solid[cell] + cells.powder[cell] >= 0.25 ? 1 : 0;
  return static_cast<std::uint8_t>(before + (melt.melted[cell] ? 4 : 0));
}

MeltSection cut(MeltRecord const& melt, CellContent const& cells, double x) {
  VoxelGrid const& grid = cells.grid;
  auto const i = std::clamp<std::int64_t>(grid.locate({x, 0, 0})[0], 0, grid.n[0] - 1);
  MeltSection section{.x = x,
                      .y0 = grid.origin.y(),
                      .z0 = grid.origin.z(),
                      .cell = grid.cell,
                      .ny = grid.n[1],
                      .nz = grid.n[2],
                      .peak_temperature = {},
                      .state = {}};
  for (std::int32_t k = 0; k < grid.n[2]; ++k) {
    for (std::int32_t j = 0; j < grid.n[1]; ++j) {
      auto const cell = static_cast<std::size_t>(grid.index(i, j, k));
      section.peak_temperature.push_back(melt.peak_temperature[cell]);
      section.state.push_back(state_of(cells, melt, cell));
    }
  }
  return section;
}

}  // namespace

std::vector<MeltSection> melt_sections(MeltRecord const& melt, CellContent const& cells,
                                       std::vector<Track> const& tracks) {
  double const first = std::min(tracks.front().begin.x(), tracks.front().end.x());
  double const last = std::max(tracks.front().begin.x(), tracks.front().end.x());
  std::vector<MeltSection> sections;
  for (double const share : {0.25, 0.5, 0.75}) sections.push_back(cut(melt, cells, first + share * (last - first)));
  return sections;
}

}  // namespace layerloop::coupling
