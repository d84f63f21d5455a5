#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "thermal/eagar_tsai.hpp"

namespace layerloop::thermal {
namespace {

ConstantMetal const metal{.conductivity = 24, .heat_capacity = 7300.0 * 789, .melting_point = 1708};
MovingBeam const beam{.absorbed_power = 60, .speed = 0.8, .spot_radius = 40e-6, .ambient_temperature = 298};

/// The integral by a fixed rule of many points in another language, at places on and off the track.
TEST(EagarTsaiFormula, TemperaturesAndPoolOfTheReference) {
  EXPECT_NEAR(eagar_tsai_temperature(beam, metal, {0, 0, 0}), 11778.336, 0.01);
  EXPECT_NEAR(eagar_tsai_temperature(beam, metal, {-200e-6, 0, 0}), 2129.138, 0.01);
  EXPECT_NEAR(eagar_tsai_temperature(beam, metal, {0, 40e-6, 0}), 2662.557, 0.01);
  EXPECT_NEAR(eagar_tsai_temperature(beam, metal, {-50e-6, 0, 30e-6}), 2455.255, 0.01);
  PoolSize const pool = eagar_tsai_pool(beam, metal);
  EXPECT_NEAR(pool.width, 102.0976e-6, 1e-9);
  EXPECT_NEAR(pool.depth, 41.1274e-6, 1e-9);
  EXPECT_NEAR(pool.length, 302.5155e-6, 2e-9);
}

/// At rest: T - T0 = q / (2 k sigma sqrt(2 pi)) under the beam.
TEST(EagarTsaiFormula, BeamAtRest) {
  MovingBeam still = beam;
  still.speed = 1e-9;
  double const sigma = 20e-6, rise = 60 / (2 * 24 * sigma * std::sqrt(2 * std::numbers::pi));
  EXPECT_NEAR(eagar_tsai_temperature(still, metal, {0, 0, 0}) - 298, rise, 1e-4 * rise);
}

TEST(EagarTsaiFormula, NothingMelts) {
  MovingBeam faint = beam;
  faint.absorbed_power = 5;
  EXPECT_EQ(eagar_tsai_pool(faint, metal).depth, 0);
}

}  // namespace
}  // namespace layerloop::thermal
