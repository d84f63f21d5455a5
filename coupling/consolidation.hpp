#pragma once
#include <span>
#include <vector>

#include "core/case.hpp"
#include "core/cell_content.hpp"
#include "core/melt_record.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/run_record.hpp"
#include "coupling/solid_field.hpp"

namespace layerloop::coupling {

/// What melted becomes solid, and the solid gets its new surface.
///
/// 1. A grain with at least half of its volume in melted cells is melted: its whole mass joins the solid; others stay
/// whole.
/// 2. Its mass enters the columns under it by its cell shares; the melt, remelted metal included, sinks and levels
///    (melt_columns.hpp) over half the pool's width.
/// 3. Grains that stay but lie inside the new surface, or are enclosed by it, are trapped: they join the solid where
/// they
///    are, pores around them staying. The others are moved clear of it (grain_clearance.hpp); those that cannot be are
///    trapped too. So no grain overlaps `substrate` afterwards.
///
/// Mass is exact: the field gains the melted and trapped grains' mass to 1e-15. Every rank computes the same bits.
/// \param cells  what the heat solver started from; \param melt is on the same grid
/// \throws PhysicsError no sound surface, or the mass does not close
Consolidation consolidate(SolidField& solid, PowderBed& bed, TriangleSurface& substrate, MeltRecord const& melt,
                          CellContent const& cells, Case const& checked);

/// One grain on the solid's lattice: where its volume lies.
struct GrainCells {
  std::vector<CellVolume>
      cells;  ///< sums to the grain's whole volume; what reaches below the plate counts in the lowest cell
  double in_melted_cells = 0;  ///< [m^3]
};

/// Cells of the solid's lattice under every grain between two heights of x; others have none. Grows the field to hold
/// them.
std::vector<GrainCells> grains_on_lattice(SolidField& solid, PowderBed const& bed, Case const& checked, double x_from,
                                          double x_to);

/// The same for all grains that can touch the heated cells.
std::vector<GrainCells> grains_near(SolidField& solid, PowderBed const& bed, Case const& checked,
                                    VoxelGrid const& heated);

/// Cells of the heat grid that have been above the liquidus; flags: shape grid.size().
struct MeltedCells {
  VoxelGrid const& grid;
  std::span<char const> flags;
};

struct MeltedDown {
  std::vector<char> taken;        ///< by row of the bed: the grain has melted
  double mean_height_change = 0;  ///< by levelling [m]
};

/// Steps 1 and 2 of consolidate(): remelts the solid, adds the melted grains (which stay in the bed), and lets the
/// liquid settle and freeze. \param grains  from grains_near(); their in_melted_cells are filled
/// \param levelling_length [m]
MeltedDown melt_down(SolidField& solid, PowderBed const& bed, std::vector<GrainCells>& grains, MeltedCells const& melt,
                     double levelling_length, Case const& checked);

/// Removes the flagged grains from the bed and books their mass as melted (and trapped, if so). \return their mass [kg]
enum class Fate { melted, trapped };
double take_from_bed(PowderBed& bed, std::vector<char> const& taken, Fate fate, Case const& checked,
                     Consolidation& figures);

/// Step 3 above: traps, meshes, clears, until no grain overlaps the surface; fills the figures of the surface.
void embed(SolidField& solid, PowderBed& bed, TriangleSurface& substrate, Case const& checked, Consolidation& figures);

/// \throws PhysicsError unless the field holds `mass_before` and what was melted, to 1e-12
void check_mass(SolidField const& solid, double mass_before, Consolidation const& figures);

}  // namespace layerloop::coupling
