#pragma once
#include <memory>
#include <vector>

#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/consolidation.hpp"
#include "coupling/solid_field.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::coupling {

/// What the beam meets while a layer is being melted: the grains that have not melted, and the metal as far as it has
/// melted and settled (consolidation.hpp, levelled over the beam's radius). Where cells have melted, the surface is
/// a height map on the solid's columns; elsewhere it is the mesh that the layer was spread on. Trapping grains and
/// meshing wait until the layer's end.
class MeltSurface {
 public:
  /// Keeps references: bed and substrate must not change while it lives.
  MeltSurface(SolidField const& solid, PowderBed const& bed, TriangleSurface const& substrate, CellContent const& cells,
              Case const& checked);

  /// \param melted  cells of the heat grid above the liquidus so far; a scene is built only when there are new ones
  void update(std::vector<char> const& melted);
  raytrace::BedScene const& scene() const { return *scene_; }

 private:
  TriangleSurface surface_of(SolidField const& solid, double x_from, double x_to) const;

  SolidField solid_;  ///< before the exposure
  PowderBed const& bed_;
  TriangleSurface const& substrate_;
  VoxelGrid heated_;
  Case const& checked_;
  std::vector<GrainCells> grains_;
  std::vector<char> melted_;
  std::unique_ptr<raytrace::BedScene> scene_;
};

}  // namespace layerloop::coupling
