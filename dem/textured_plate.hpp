#pragma once
#include <vector>

#include "core/case.hpp"
#include "core/triangle_surface.hpp"

namespace layerloop::dem {

/// A grain of the powder that sits on the plate with half of its volume sunk in.
struct FrozenGrain {
  double x, y, radius;
};

/// Random sequential addition without overlap, periodic along y, until machine.plate_grains is covered.
std::vector<FrozenGrain> frozen_grains(Case const& checked);

/// What stands on the plate over the deposition zone before layer 1, as a closed block; z from the plate's top. The
/// higher one of both counts:
/// - a rough surface: Gaussian random heights with the rms value machine.plate_roughness and the correlation
///   exp(-(r/l)^2), l = machine.plate_correlation_length, periodic along y; the mean lies 3 rms above the plate, and
///   what would lie below it is cut. Random cosine modes with a Gaussian spectrum (Shinozuka & Deodatis, Appl. Mech.
///   Rev. 44 (1991) 191);
/// - frozen_grains() as hemispheres.
/// A pure function of the case.
TriangleSurface textured_plate(Case const& checked);

}  // namespace layerloop::dem
