#pragma once
#include <complex>
#include <cstdint>
#include <span>

#include "core/absorbed_power.hpp"
#include "core/voxel_grid.hpp"
#include "raytrace/beam.hpp"
#include "raytrace/bed_scene.hpp"
#include "raytrace/light.hpp"
#include "raytrace/surface.hpp"

namespace layerloop::raytrace {

struct TraceSettings {
  std::int64_t rays = 20000;  ///< asked for; rounded up to a multiple of `replicates`
  std::int64_t replicates = 16;
  std::uint64_t seed = 1;
  std::uint64_t id = 0;  ///< of this trace in the run: traces of different id are independent
  Polarisation polarisation = Polarisation::averaged;
  double cut_off = 1e-7;  ///< a ray ends when this share of its power is left; the rest is booked as residual
  std::int64_t max_bounces = 1000;
  double diffuse_share = 0;  ///< of the reflected power that leaves by Lambert's law, the rest like from a mirror
};

/// Geometrical-optics trace of a beam for the layer loop. Watts go to the cell half a cell (on a grain at most half its
/// radius) below the point that was hit, with y and x wrapped in periodic scenes; incident = absorbed + escaped +
/// residual holds to 1e-12 before anything is rescaled. The standard error comes from the scatter of the replicates,
/// each an independently shifted low-discrepancy set of rays. The same to the bit for any number of threads. \param
/// substrate_material  of every triangle \throws InputError    settings or materials that cannot be traced \throws
/// PhysicsError  nothing was absorbed, or the ledger does not close
AbsorbedPower trace(BedScene const& scene, Beam const& beam, OpticalSet const& optics, std::int32_t substrate_material,
                    VoxelGrid const& grid, TraceSettings const& settings);

/// The same with bare, smooth metals. \param refractive_index  n + ik by material
AbsorbedPower trace(BedScene const& scene, Beam const& beam, std::span<std::complex<double> const> refractive_index,
                    std::int32_t substrate_material, VoxelGrid const& grid, TraceSettings const& settings);

}  // namespace layerloop::raytrace
