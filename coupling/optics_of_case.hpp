#pragma once
#include <string>

#include "core/case.hpp"
#include "raytrace/beam.hpp"
#include "raytrace/light.hpp"
#include "raytrace/surface.hpp"

namespace layerloop::coupling {

/// The laser's beam with its axis through `centre`, the level of the layer. \throws InputError, FileError its table
raytrace::Beam spot_beam(LaserSettings const& laser, Vec3 const& centre, double power);

/// The same light evenly over a level rectangle around `centre`.
raytrace::Beam even_beam(Case const& checked, Vec3 const& centre, double size_x, double size_y, double power);

/// Light that is not unpolarised is followed from hit to hit.
raytrace::Polarisation polarisation_of(Case const& checked);

double diffuse_share(Case const& checked);  ///< with the effect diffuse_scattering

/// Surfaces by PowderBed::material and after them, if no grain is of it, that below the powder (see floor_index): index
/// at the laser's wavelength and optics.temperature, with its oxide film. \throws InputError  no data for one of them
raytrace::OpticalSet optical_set(Case const& checked, std::string const& name = "");

/// Which of these surfaces lies below the powder.
std::int32_t floor_index(Case const& checked);

/// Names of the materials of these surfaces.
std::vector<std::string> surface_names(Case const& checked);

/// Where an index comes from: "Fe (Johnson 1974), borrowed: no set of 316L is known".
std::string optical_source(Material const& metal);

/// The case under other light, or with all powder of another metal: a built-in one, or a set of optical constants.
/// \throws InputError  unknown, or outside the table of its constants
Case with_wavelength(Case checked, double wavelength);
Case with_powder_of(Case checked, std::string const& metal);

}  // namespace layerloop::coupling
