#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "coupling/bed_source.hpp"
#include "raytrace/beam.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::coupling {

/// A bed that is to be lit.
struct LitBed {
  PowderBed bed;
  TriangleSurface surface;             ///< plate, part, floor; may be empty
  std::array<double, 2> period{0, 0};  ///< 0: open [m]
  Vec3 lower, upper;                   ///< box of the part that is lit: from the floor to the top of the powder [m]
  std::string origin;                  ///< in words
};

/// From a file. Open sides are lit no nearer than the height of the bed and three largest grains, or a quarter of it.
/// \throws InputError, FileError
LitBed bed_of_file(Case const& checked, BedSource const& source);

/// Grains at rest on a level plate. @note Collective
LitBed bed_that_settles(Case const& checked, Communicator const& comm, bool show_progress);

/// The last layer that the recoater spreads: the deposition zone of the machine. What lies in `folder` from an earlier
/// call for the same case is used again. @note Collective
LitBed bed_that_is_spread(Case const& checked, std::filesystem::path const& folder, Communicator const& comm,
                          bool quiet);

/// Light over the box, evenly or as the case's spot in its middle, of the laser's power (1 W where it has none).
raytrace::Beam beam_over(LitBed const& lit, Case const& checked);

/// How thick and dense the lit powder is.
struct BedMeasures {
  std::int64_t grains = 0;     ///< centres in the box
  double solid_thickness = 0;  ///< volume of these grains over the box's area [m]
  double mean_height = 0;      ///< of what is seen from above, over the floor [m]
  double packing_density = 0;  ///< their quotient
  double mean_diameter = 0;    ///< Sauter diameter, sum d^3 / sum d^2 [m]
};
BedMeasures measure(LitBed const& lit, raytrace::BedScene const& scene);

}  // namespace layerloop::coupling
