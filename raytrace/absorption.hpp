#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/area_map.hpp"
#include "core/communicator.hpp"
#include "core/voxel_grid.hpp"
#include "raytrace/beam.hpp"
#include "raytrace/bed_scene.hpp"
#include "raytrace/light.hpp"
#include "raytrace/surface.hpp"

namespace layerloop::raytrace {

/// Of a stand-alone study of a bed.
struct AbsorptionSettings {
  std::int64_t rays = 16384;  ///< at least; rounded up to a multiple of `replicates`
  std::int64_t max_rays = 100'000'000;
  std::int64_t replicates = 16;  ///< independently shifted sequences of rays; the error comes from their scatter
  std::uint64_t seed = 1;
  std::uint64_t id = 0;  ///< of this trace in the run: traces of different id are independent
  Polarisation polarisation = Polarisation::averaged;
  double diffuse_share = 0;  ///< of the reflected power that leaves by Lambert's law, the rest like from a mirror
  double cut_off = 1e-7;     ///< a ray ends when this share of its power is left; the rest is booked as residual
  std::int64_t max_bounces = 10000;
  double target_standard_error = 0;  ///< > 0: doubles the rays until every set has reached it, or `max_rays`
  bool derivatives = false;          ///< of the absorptivity with respect to n and k of every material
  std::optional<VoxelGrid> grid{};   ///< sorts what is absorbed into cells
  std::int64_t depth_bins = 50;
  std::optional<std::array<double, 2>> depth_range{};  ///< bottom and top of the profile [m]; else those of the scene
  double map_spacing = 0;                              ///< edge of a pixel of the map [m]; 0: no map
};

/// Shares of the incident power that one optical set absorbs; every error is a standard error from the replicates.
struct SetAbsorption {
  double absorptivity = 0, standard_error = 0;
  double half_width = 0;  ///< of the 95 % interval, t(0.975, replicates - 1) standard errors
  std::vector<double> by_material, by_material_error;  ///< grains and substrate
  double substrate = 0, substrate_error = 0;           ///< part of its material's share
  double escaped = 0, residual = 0;  ///< absorptivity + escaped + residual = 1 to 1e-12; never dropped
  std::vector<double> d_n, d_n_error, d_k, d_k_error;  ///< dA/dn, dA/dk by material; empty unless asked for
};

struct DepthLayer {
  double z;                ///< of its middle [m]
  double fraction, error;  ///< absorbed in it, as share of the incident power
};

/// Where the light of a beam stays. What has a place is that of set 0.
struct Absorption {
  std::vector<SetAbsorption> sets;
  std::vector<double> grain_share;  ///< by row of the bed; sum + substrate_share = absorptivity to 1e-12
  double substrate_share = 0;
  std::vector<DepthLayer> depth_profile;  ///< from the bottom; fractions add up to the absorptivity

  /// Absorbed share per area seen from above [1/m^2]: times power = W/m^2; under uniform light, times the lit area =
  /// the local absorptivity. sum * spacing^2 + outside_map = absorptivity.
  AreaMap map, map_error;
  double outside_map = 0;

  std::vector<std::int64_t> cell;  ///< of the grid that absorb, ascending
  std::vector<double> cell_share;  ///< in each; sum + outside_grid = absorptivity to 1e-12
  double outside_grid = 0;

  std::int64_t rays = 0, replicates = 0;
  double mean_bounces = 0;     ///< surface hits per ray, of set 0
  bool target_reached = true;  ///< false: `max_rays` came first
};

/// Traces a beam by geometrical optics under several optical sets at once: they share the paths, and every set comes
/// out as if it had been traced alone, to the bit (with a target, as if alone with that number of rays). Triangles are
/// of `substrate_material`. The same to the bit for any number of threads and ranks. \param ranks  share the rays where
/// given; every rank gets the result. @note Collective then \throws InputError    beam, surfaces or settings that
/// cannot be traced \throws PhysicsError  no ray met anything, or the ledger does not close
Absorption absorb(BedScene const& scene, Beam const& beam, std::span<OpticalSet const> sets,
                  std::int32_t substrate_material, AbsorptionSettings const& settings,
                  Communicator const* ranks = nullptr);

}  // namespace layerloop::raytrace
