#pragma once
#include <complex>
#include <cstdint>
#include <span>

#include "core/absorbed_power.hpp"
#include "core/voxel_grid.hpp"
#include "raytrace/beam.hpp"
#include "raytrace/bed_scene.hpp"

namespace layerloop::raytrace {

enum class Polarisation {
  averaged,  ///< unpolarised afresh at every hit: within 0.002 on powder, 0.009 off in a V-groove of steel
  tracked    ///< unpolarised when it arrives, then both field components are followed from hit to hit
};

struct TraceSettings {
  std::int64_t rays = 20000;  ///< asked for; rounded up to a multiple of `replicates`
  std::int64_t replicates = 16;
  std::uint64_t seed = 1;
  std::uint64_t id = 0;  ///< of this trace in the run: traces of different id are independent
  Polarisation polarisation = Polarisation::averaged;
  double cut_off = 1e-7;  ///< a ray ends when this share of its power is left; the rest is booked as residual
  std::int64_t max_bounces = 1000;
};

/// Geometrical-optics trace of a beam: specular reflection with Fresnel reflectance at every hit until the ray leaves
/// the scene. Watts go to the cell half a cell (on a grain at most half its radius) below the point that was hit, with
/// y and x wrapped in periodic scenes; incident = absorbed + escaped + residual holds to 1e-12 before anything is
/// rescaled. The standard error comes from the scatter of the replicates, each an independently shifted low-discrepancy
/// set of rays. The result is the same to the bit for any number of threads. \param refractive_index    n + ik by
/// material \param substrate_material  of every triangle \throws InputError    settings or materials that cannot be
/// traced \throws PhysicsError  nothing was absorbed, or more than fell in, or the ledger does not close
AbsorbedPower trace(BedScene const& scene, Beam const& beam, std::span<std::complex<double> const> refractive_index,
                    std::int32_t substrate_material, VoxelGrid const& grid, TraceSettings const& settings);

}  // namespace layerloop::raytrace
