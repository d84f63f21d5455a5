#pragma once
#include <memory>
#include <vector>

#include "core/area_map.hpp"
#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/melt_state.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/consolidation.hpp"
#include "coupling/solid_field.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::coupling {

/// What the beam meets while a layer is being melted: the grains that have not melted, and the metal as far as it has
/// melted and settled (consolidation.hpp, levelled over the beam's radius). Where cells have melted, the surface is
/// a height map on the solid's columns, as deep as the keyhole where there is one; elsewhere it is the mesh that the
/// layer was spread on. Trapping grains and meshing wait until the layer's end.
class MeltSurface {
 public:
  /// Keeps references: bed and substrate must not change while it lives.
  MeltSurface(SolidField const& solid, PowderBed const& bed, TriangleSurface const& substrate, CellContent const& cells,
              Case const& checked);

  /// The melt levels, and the keyhole moves. A scene is built only when either has changed. \note Collective
  void update(MeltState const& now);
  /// The keyhole alone moves.
  void sink(std::vector<double> const& keyhole);
  raytrace::BedScene const& scene() const { return *scene_; }

 private:
  TriangleSurface surface_of(HeightMap const& top, std::int64_t first, std::int64_t last) const;
  void build_scene();

  SolidField solid_;  ///< before the exposure
  PowderBed const& bed_;
  TriangleSurface const& substrate_;
  VoxelGrid heated_;
  Case const& checked_;
  std::vector<GrainCells> grains_;
  HeightMap before_, top_;  ///< of the solid, before the exposure and with the levelled melt
  PowderBed left_;          ///< grains that have not melted
  std::vector<char> melted_;
  std::vector<double> keyhole_;  ///< as in MeltState
  std::unique_ptr<raytrace::BedScene> scene_;
};

}  // namespace layerloop::coupling
