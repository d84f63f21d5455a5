#include "coupling/melt_layer.hpp"

#include "coupling/ledger.hpp"
#include "coupling/melt_section.hpp"
#include "coupling/stopwatch.hpp"

namespace layerloop::coupling {

MeltedLayer melt_layer(MeltSurface& surface, CellContent const& cells, Case const& checked, double start_temperature,
                       std::int32_t layer, Communicator const& comm, thermal::Report report, WallTime& wall_time) {
  MeltedLayer melted{.exposure = plan_exposure(checked, layer), .start_temperature = start_temperature, .heat = {}};
  double tracing = 0;
  auto const absorbed_now = [&](std::size_t stretch, MeltState const& now) {
    Stopwatch const timed(tracing);
    if (checked.optics.retrace && !checked.laser.absorptivity) {
      bool const levels = stretch % melted.exposure.stops_per_levelling == 0;
      levels ? surface.update(now) : surface.sink(now.keyhole);
    }
    expose_stretch(melted.exposure, stretch, now, surface.scene(), cells, checked, layer, comm);
  };
  Case warm = checked;
  warm.heat.ambient_temperature = start_temperature;
  {
    Stopwatch const timed(wall_time.heat);
    melted.heat = thermal::expose(cells, melted.exposure.source, warm, comm, report, absorbed_now);
  }
  wall_time.rays += tracing;
  wall_time.heat -= tracing;
  return melted;
}

void book_melting(LayerRecord& layer, Ledger& ledger, MeltedLayer const& melted, CellContent const& cells) {
  auto const& [exposure, start_temperature, heat] = melted;
  book_light(ledger, exposure, layer.layer);
  book_heat(ledger, heat);
  layer.absorptivity = exposure.mean.absorptivity;
  layer.absorptivity_standard_error = exposure.mean.standard_error;
  layer.mean_bounces = exposure.mean.mean_bounces;
  layer.rays = exposure.mean.rays;
  layer.absorbed_energy = absorbed_energy(exposure.source, cells.grid);
  layer.start_temperature = start_temperature;
  layer.peak_temperature = heat.peak_temperature;
  layer.pool = heat.melt.pool;
  layer.pool_u_num = heat.melt.pool_u_num;
  layer.sections = melt_sections(heat.melt, cells, exposure.source.tracks);
}

}  // namespace layerloop::coupling
