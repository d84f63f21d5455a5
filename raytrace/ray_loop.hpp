#pragma once
#include <cstdint>
#include <span>

#include "core/communicator.hpp"
#include "raytrace/beam.hpp"
#include "raytrace/bed_scene.hpp"
#include "raytrace/light.hpp"
#include "raytrace/tally.hpp"

namespace layerloop::raytrace {

/// All that fixes the paths of the rays and what is done along them.
struct RayProblem {
  BedScene const& scene;
  Beam const& beam;
  std::span<OpticalSet const> sets;
  std::int32_t substrate_material;  ///< of every triangle
  Polarisation polarisation;
  Slopes slopes;
  double diffuse_share;  ///< of the reflected power that leaves by Lambert's law, the rest like from a mirror
  double cut_off;
  std::int64_t max_bounces;
  std::uint64_t seed, id;
  Places places;
};

/// \throws InputError  a beam, surfaces or settings that cannot be traced. Not collective: throws on every rank alike
void check_problem(RayProblem const& problem);

/// Traces rays `tally.replicate_rays` to `last` of every replicate and adds them. The same to the bit for any number of
/// threads and ranks. \param ranks  share the rays where given. @note Collective then
void trace_rays(RayProblem const& problem, std::int64_t last, RayTally& tally, Communicator const* ranks = nullptr);

}  // namespace layerloop::raytrace
