#pragma once
#include <vector>

#include "core/cell_content.hpp"
#include "core/heat_source.hpp"
#include "core/melt_record.hpp"
#include "coupling/run_record.hpp"

namespace layerloop::coupling {

/// Cuts normal to the first track at a quarter, half and three quarters of its length.
std::vector<MeltSection> melt_sections(MeltRecord const& melt, CellContent const& cells,
                                       std::vector<Track> const& tracks);

}  // namespace layerloop::coupling
