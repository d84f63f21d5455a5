#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/run_record.hpp"

namespace layerloop::coupling {

/// What every section of the report draws from.
struct ReportInput {
  std::filesystem::path folder;
  Case const& checked;
  RunRecord const& record;
  PowderBed const& bed;
  TriangleSurface const& part;
  ReportExtras const& extras;
  std::vector<LayerRecord const*>
      shown;  ///< layers with pictures and maps: all of a short run, else evenly spread ones

  bool laser() const { return checked.has_laser(); }
  bool part_grows() const { return checked.has_part(); }
  LayerRecord const& last() const { return record.layers.back(); }
  std::size_t layer_count() const { return record.layers.size(); }
};

}  // namespace layerloop::coupling
