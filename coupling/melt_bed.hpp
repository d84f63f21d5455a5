#pragma once
#include <filesystem>
#include <optional>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "coupling/bed_source.hpp"
#include "coupling/build_state.hpp"

namespace layerloop::coupling {

/// A bare plate, its top at z = 0.
BuildState bare_plate(Case const& placed);

/// A plate with the grains of a file on it: periodic beds are repeated until they cover the plate, open ones lie in its
/// middle. The level of the bed's floor (z = 0 without one) becomes the top of the plate; grains whose centres lie
/// beyond the plate are left out. \throws InputError no grain is left, or one of a material that the case does not know
BuildState plate_with_bed(Case& placed, BedSource const& source);

/// The case with all that only light, heat and measuring read at its defaults: beds of equal ones are the same.
Case what_spreading_reads(Case const& checked);

/// Spreads run.layers layers and no more; the record is that of the spreading. What lies in `folder` from an earlier
/// call for a case that reads alike is used again. \note Collective
BuildState spread_layers(Case const& checked, std::filesystem::path const& folder, Communicator const& comm,
                         bool quiet);

/// The last layer that the recoater spreads, with part and plate under it, as the start of a record of its own; see
/// spread_layers. \note Collective
BuildState spread_bed(Case const& checked, std::filesystem::path const& folder, Communicator const& comm, bool quiet);

}  // namespace layerloop::coupling
