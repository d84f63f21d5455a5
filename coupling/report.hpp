#pragma once
#include <filesystem>

#include "core/case.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/run_record.hpp"

namespace layerloop::coupling {

/// Writes report.html, one page that needs no network, and beside every plot its numbers as CSV (lengths in um, one
/// header line with units). Pictures named in the record are read from `folder` and embedded. `part` is the outer
/// surface of plate and part. The same input gives the same bytes. \note root rank only \throws FileError
void write_report(std::filesystem::path const& folder, Case const& checked, RunRecord const& record,
                  PowderBed const& bed, TriangleSurface const& part, ReportExtras const& extras);

}  // namespace layerloop::coupling
