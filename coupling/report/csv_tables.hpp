#pragma once
#include <vector>

#include "coupling/report/report_input.hpp"

namespace layerloop::coupling {

/// Shares of the grains by number at each diameter of the case: as fed, in the whole bed, and on the plate.
struct SizeShares {
  double diameter;  ///< [m]
  double fed, bed, plate;
};
std::vector<SizeShares> size_shares(Case const& checked, PowderBed const& bed);

/// layers.csv, profiles.csv, sections.csv, size_distribution.csv, wall_time.csv, and for each layer shown
/// surface_NNNN.csv, absorbed_energy_NNNN.csv and part_surface_NNNN.csv: the numbers of the plots, in the units of
/// their axes.
void write_csv_tables(ReportInput const& input);

}  // namespace layerloop::coupling
