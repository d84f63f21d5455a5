#pragma once
#include <filesystem>
#include <string>

#include "core/bed_file.hpp"
#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/communicator.hpp"
#include "core/melt_record.hpp"
#include "coupling/build_state.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::coupling {

/// What a picture shows.
enum class View { whole_machine, oblique, from_above, part };

/// heat_NNNN.h5: what filled the cells and what the heat did to them. \note root rank only \throws FileError
void write_heat_file(std::filesystem::path const& path, CellContent const& cells, MeltRecord const& melt);

/// Everything that a run writes into its folder. Only the root rank writes; on the others every call does nothing.
class LayerOutput {
 public:
  /// Makes the folder, writes case_resolved.toml. \throws FileError
  LayerOutput(Case const& checked, std::filesystem::path folder, std::vector<BedFormat> exports,
              Communicator const& comm);

  /// Whether picture() does anything on this rank.
  bool draws_pictures() const { return writes_ && checked_.run.pictures; }

  /// A picture of the scene, unless run.pictures is off; its name and caption go into the record of the layer.
  void picture(raytrace::BedScene const& scene, PowderBed const& bed, View view, LayerRecord& layer) const;

  /// heat_NNNN.h5
  void grid(CellContent const& cells, MeltRecord const& melt, LayerRecord const& layer) const;

  /// bed_NNNN.h5 and its exports, solid_NNNN.stl, the checkpoint and a line of log.jsonl, once the layer is complete.
  void layer(BuildState& build) const;

  /// summary.json, the CSV tables and report.html.
  void end(BuildState const& build) const;

 private:
  Case const& checked_;
  std::filesystem::path folder_;
  std::vector<BedFormat> exports_;
  bool writes_;
};

}  // namespace layerloop::coupling
