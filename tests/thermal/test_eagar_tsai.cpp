#include <gtest/gtest.h>

#include "plate.hpp"

namespace layerloop::thermal {
namespace {

/// Eagar and Tsai's moving Gaussian on a half space (k 24, rho 7300, cp 789, 60 W absorbed, 0.8 m/s, D4sigma 80 um),
/// integrated numerically to 1e-4 um elsewhere: pool 102.0976 x 41.1274 x 302.5155 um.
TEST(EagarTsai, PoolAtFiveMicrometres) {
  double const cell = 5e-6;
  CellContent content = solid_block(cell, {300, 45, 24});
  content.grid.origin = {0, -22.5 * cell, -24 * cell};
  HeatSettings settings = closed_settings(cell);
  settings.margin = 110e-6, settings.substrate_depth = 120e-6;
  HeatSource const source = gaussian_track(content.grid, 60, 80e-6, 0.8, 100e-6, 1400e-6, 0, 2.5e-6);
  HeatOutcome const result = expose(content, source, constant_metal(24, 7300, 789), settings, effects_on({}),
                                    SideY::far_field, Communicator(), Report::silent);
  PoolSize const pool = result.melt.pool;
  std::printf("width %.3f depth %.3f length %.3f um (u_num %.2f %.2f %.2f), peak %.0f K, energy %.2g, %ld steps\n",
              pool.width * 1e6, pool.depth * 1e6, pool.length * 1e6, result.melt.pool_u_num.width * 1e6,
              result.melt.pool_u_num.depth * 1e6, result.melt.pool_u_num.length * 1e6, result.peak_temperature,
              result.heat_energy_relative_error, result.explicit_steps);
  EXPECT_NEAR(pool.width, 102.0976e-6, 1e-6);
  EXPECT_NEAR(pool.depth, 41.1274e-6, 1e-6);
  EXPECT_NEAR(pool.length, 302.5155e-6, 3.03e-6);
  EXPECT_LT(result.heat_energy_relative_error, 1e-10);
}

}  // namespace
}  // namespace layerloop::thermal
