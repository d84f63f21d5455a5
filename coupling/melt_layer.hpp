#pragma once
#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/communicator.hpp"
#include "coupling/exposure.hpp"
#include "coupling/melt_surface.hpp"
#include "coupling/run_record.hpp"
#include "thermal/expose.hpp"

namespace layerloop::coupling {

/// What the laser did to one layer.
struct MeltedLayer {
  Exposure exposure;
  double start_temperature = 0;  ///< [K]
  thermal::HeatOutcome heat;
};

/// The laser on one layer: what this very bed absorbs, and what melts; the beam is traced on what has melted before it.
/// \param surface  that the cells were made from \param start_temperature  of metal, powder and far field, instead of
/// heat.ambient_temperature [K] \param wall_time  rays and heat are added \note Collective
MeltedLayer melt_layer(MeltSurface& surface, CellContent const& cells, Case const& checked, double start_temperature,
                       std::int32_t layer, Communicator const& comm, thermal::Report report, WallTime& wall_time);

/// Enters light, heat and pool into the record of the layer and the ledger.
void book_melting(LayerRecord& layer, Ledger& ledger, MeltedLayer const& melted, CellContent const& cells);

}  // namespace layerloop::coupling
