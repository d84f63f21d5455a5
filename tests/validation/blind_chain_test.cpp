// The analytic chain: that it is a fair model to test a diagnosis on.
#include <gtest/gtest.h>

#include "thermal/eagar_tsai.hpp"
#include "validation/blind/analytic_chain.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/blind/pool_table.hpp"
#include "validation/error_model.hpp"

namespace layerloop::validation {
namespace {

ModelPoint base_point(Study const& study, std::size_t candidates) {
  ModelPoint point{Eigen::VectorXd(study.calibration.size()),
                   Eigen::VectorXd::Zero(static_cast<Eigen::Index>(candidates))};
  for (std::size_t k = 0; k < study.calibration.size(); ++k)
    point.calibration[static_cast<Eigen::Index>(k)] = study.calibration[k].mean;
  return point;
}

TEST(PoolTable, agrees_with_the_integral_it_is_made_from) {
  thermal::ConstantMetal const metal{.conductivity = 26, .heat_capacity = 6e6, .melting_point = 1700};
  for (double const speed : {0.4, 0.9, 1.6})
    for (double const power : {40, 70, 130}) {
      thermal::MovingBeam const beam{power, speed, 40e-6, 300};
      PoolSize const exact = thermal::eagar_tsai_pool(beam, metal);
      DimensionlessPool const table =
          dimensionless_pool(power / (26 * 40e-6 * 1400), speed * 40e-6 * metal.heat_capacity / 26);
      EXPECT_NEAR(2 * table.half_width * 40e-6, exact.width, 6e-3 * exact.width) << speed << " " << power;
      EXPECT_NEAR(table.depth * 40e-6, exact.depth, 2e-3 * exact.depth) << speed << " " << power;
    }
}

TEST(PoolTable, has_no_pool_where_nothing_melts) { EXPECT_TRUE(std::isnan(dimensionless_pool(0.5, 5).depth)); }

TEST(AnalyticDesign, is_a_study_of_the_promised_size) {
  for (std::uint64_t const seed : {1, 2, 3}) {
    Study const all = analytic_design(seed);
    Study const train = part_of(all, Role::train), holdout = part_of(all, Role::holdout);
    EXPECT_EQ(all.conditions.size(), 50U);
    EXPECT_EQ(train.observations.size() + holdout.observations.size(), all.observations.size());
    EXPECT_GT(train.observations.size(), 150U);
    EXPECT_GT(train.observations.size(), train.observables.size() + 15) << "replicates";
    EXPECT_GT(holdout.observations.size(), 25U);
  }
}

TEST(AnalyticChain, predicts_pools_for_every_design) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Study const study = analytic_design(seed);
    AnalyticChain chain(study, {});
    EXPECT_TRUE(chain.predict(base_point(study, 0)).value.allFinite()) << seed;
  }
}

TEST(AnalyticChain, is_the_bare_chain_bit_for_bit_at_strength_zero) {
  Study const study = analytic_design(1);
  auto const candidates = analytic_candidates();
  AnalyticChain bare(study, {}), full(study, candidates);
  Eigen::VectorXd const a = bare.predict(base_point(study, 0)).value,
                        b = full.predict(base_point(study, candidates.size())).value;
  EXPECT_TRUE((a.array() == b.array()).all());
}

TEST(AnalyticChain, feels_every_candidate) {
  Study const study = part_of(analytic_design(1), Role::train);
  auto const candidates = analytic_candidates();
  AnalyticChain chain(study, candidates);
  ModelPoint point = base_point(study, candidates.size());
  Prediction const base = chain.predict(point);
  Whitening const whiten(covariance(study, base));
  std::size_t physics = 0;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    physics += candidates[c].kind == EffectClass::physics ? 1 : 0;
    auto const i = static_cast<Eigen::Index>(c);
    point.strengths[i] = candidates[c].prior_scale;
    Eigen::VectorXd const change = at_observations(study, chain.predict(point).value - base.value);
    EXPECT_TRUE(change.allFinite()) << candidates[c].name;
    EXPECT_GT(whiten(change).norm(), 1) << candidates[c].name;
    point.strengths[i] = 0;
  }
  EXPECT_GE(physics, 20U);
}

}  // namespace
}  // namespace layerloop::validation
