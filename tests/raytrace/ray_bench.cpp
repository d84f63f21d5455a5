#include "raytrace/ray_bench.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "core/error.hpp"
#include "scenes.hpp"

namespace layerloop::raytrace {
namespace {

TEST(RayBench, EveryContenderAnswersAndHitsAgree) {
  BedFile file;
  file.bed = random_bed(4e-4, 2e-4, 8e-5, 8000);
  file.periodic_y = 2e-4;
  file.floor_z = 0;
  omp_set_num_threads(1);
  RayBench const result = bench_rays(file, 20000, BenchLight::spot);
  omp_set_num_threads(omp_get_num_procs());
  EXPECT_EQ(result.particles, static_cast<std::int64_t>(file.bed.size()));
  EXPECT_GT(result.secondary_rays, 5000);
  for (Rate const& rate : {result.built_in, result.embree, result.grid, result.tracer}) {
    EXPECT_GT(rate.median, 1e4);  // a machine a hundred times slower than any
    EXPECT_GE(rate.best, rate.median);
  }
  EXPECT_GT(result.hit_share, 0.3);
  EXPECT_LT(result.hit_share, 1);
  EXPECT_EQ(result.hits_differing_plainly, 0);
  EXPECT_LE(result.reached_standard_error, result.target_standard_error);
  EXPECT_GT(result.reached_absorptivity, 0.35);  // more than flat steel
  EXPECT_LT(result.reached_absorptivity, 0.9);
}

TEST(RayBench, RefusesABedThatReflectsNothing) {
  EXPECT_THROW(bench_rays({}, 1000, BenchLight::uniform), InputError);
  BedFile file;
  add_grain(file.bed, 0, 0, 0, 1e-6);
  add_grain(file.bed, 1e-2, 1e-2, 0, 1e-6);
  EXPECT_THROW(bench_rays(file, 1000, BenchLight::spot), InputError) << "the spot lies between them";
}

}  // namespace
}  // namespace layerloop::raytrace
