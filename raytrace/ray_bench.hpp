#pragma once
#include <array>
#include <cstdint>

#include "core/bed_file.hpp"

namespace layerloop::raytrace {

enum class BenchLight {
  spot,    ///< Gaussian of 60 um 1/e2 radius on the middle of the bed, as in the layer loop
  uniform  ///< over the whole bed, as in a study of absorptivity
};

/// Of several rounds [1/s].
struct Rate {
  double median = 0, best = 0;
};

/// How fast the rays of one bed are traced, by processor time.
struct RayBench {
  std::int64_t particles = 0, paths = 0;
  std::int64_t secondary_rays = 0;  ///< all flights after the first of each path, in path order
  double hit_share = 0;             ///< of these that meet a grain again
  Rate built_in;  ///< raw rtcIntersect1 on Embree's own spheres (single precision, back faces filtered), secondary rays
  Rate embree;    ///< BedScene on Embree, secondary rays
  Rate grid;      ///< BedScene on the grid, secondary rays
  Rate tracer;    ///< flights of whole paths: beam, hits, Fresnel, deposits
  bool grid_chosen = false;                                     ///< by the tracer
  double built_in_build = 0, embree_build = 0, grid_build = 0;  ///< [s]
  std::int64_t hits_differing = 0;          ///< flights that end elsewhere on the grid than on Embree
  std::int64_t hits_differing_plainly = 0;  ///< of these: neither grazing (cosine < 0.1) nor a tie
  double target_standard_error = 0.001;
  double reached_standard_error = 0, reached_absorptivity = 0;  ///< stainless steel, uniform light
  double seconds_to_standard_error = 0;                         ///< of the trace that reaches it [s]
  std::int64_t rays_to_standard_error = 0;
};

/// Records the flights of a real trace (stainless steel, 3.27 + 4.48i) and lets every contender answer them in turn.
/// The bed lies on a flat plate of the same metal where the file gives a floor. \param rays  secondary rays, about
/// \pre OpenMP uses one thread \throws InputError the bed is empty
RayBench bench_rays(BedFile const& file, std::int64_t rays, BenchLight light);

}  // namespace layerloop::raytrace
