// Effects added to a model whose truth is known, judged on what was held out.
#include "validation/confirmation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "validation/blind/analytic_chain.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/largest_null.hpp"

namespace layerloop::validation {
namespace {

/// Training data and holdout that the chain made with an effect in it.
struct World {
  World(std::string const& effect, double strength) {
    whole = analytic_design(5);
    AnalyticChain chain(whole, candidates);
    ModelPoint point{.calibration = Eigen::VectorXd(static_cast<Eigen::Index>(whole.calibration.size())),
                     .strengths = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(candidates.size()))};
    for (std::size_t k = 0; k < whole.calibration.size(); ++k)
      point.calibration[static_cast<Eigen::Index>(k)] =
          whole.calibration[k].mean + (k % 2 ? 0.7 : -0.5) * whole.calibration[k].sd;
    for (std::size_t c = 0; c < candidates.size(); ++c)
      if (candidates[c].name == effect) point.strengths[static_cast<Eigen::Index>(c)] = strength;
    Prediction const answer = chain.predict(point);
    auto const n = static_cast<Eigen::Index>(whole.observations.size());
    Eigen::LLT<Eigen::MatrixXd> const factor(covariance(whole, answer));
    Eigen::VectorXd const values =
        at_observations(whole, answer.value) + Eigen::MatrixXd(factor.matrixL()) * standard_normal(n, 11, 0);
    for (Eigen::Index i = 0; i < n; ++i) whole.observations[static_cast<std::size_t>(i)].value = values[i];
  }
  Confirmation confirmed(Addition const& addition) const {
    Study const train = part_of(whole, Role::train), holdout = part_of(whole, Role::holdout);
    AnalyticChain train_model(train, candidates), holdout_model(holdout, candidates);
    return confirm(train, train_model, holdout, holdout_model, candidates, addition, 3);
  }
  std::vector<Candidate> candidates = analytic_candidates();
  Study whole;
};

TEST(Confirm, the_effect_that_is_there_cuts_the_error_to_the_noise) {
  World const world("keyhole", 0.5);
  Confirmation const found = world.confirmed({.effects = {{.name = "keyhole", .strength = 0.3}}});
  EXPECT_TRUE(found.confirmed);
  EXPECT_GT(found.ci95[0], 0);
  EXPECT_GT(found.all.rms_before, 1.5 * found.all.rms_after);
  EXPECT_NEAR(found.whitened_rms_after, 1, 0.25);
  EXPECT_GT(found.whitened_rms_before, 1.5);
  EXPECT_NEAR(found.train.effects[0].strength, 0.5, 4 * found.train.effects[0].u_strength);
  EXPECT_NEAR(found.train.chi2_after, found.train.dof, 4 * std::sqrt(2 * found.train.dof));
  EXPECT_EQ(found.all.readings, found.study.observations.size());
  for (Observation const& seen : found.study.observations) EXPECT_EQ(seen.role, Role::holdout);
}

TEST(Confirm, an_effect_that_is_not_there_is_not_confirmed) {
  World const world("keyhole", 0.5);
  for (std::string const wrong : {"blade_vibration", "spot_drift", "gas_drag", "latent_heat"})
    EXPECT_FALSE(world.confirmed({.effects = {{.name = wrong, .strength = 0.2}}}).confirmed) << wrong;
  World const nothing("", 0);
  EXPECT_FALSE(nothing.confirmed({.effects = {{.name = "keyhole", .strength = 0.05}}}).confirmed);
}

TEST(Confirm, unknown_names_are_refused_with_a_suggestion) {
  World const world("", 0);
  try {
    world.confirmed({.effects = {{.name = "keyhol", .strength = 1}}});
    FAIL();
  } catch (InputError const& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"keyhole\""), std::string::npos) << error.what();
  }
}

TEST(PairedGain, interval_covers_the_mean_and_has_the_width_of_its_standard_error) {
  Eigen::VectorXd const draws = standard_normal(40, 9, 0);
  std::vector<double> const gains(draws.begin(), draws.end());
  PairedGain const gain = paired_gain(gains, 1);
  EXPECT_NEAR(gain.mean, draws.mean(), 1e-12);
  double const error = std::sqrt((draws.array() - draws.mean()).square().mean() / 40);
  EXPECT_NEAR(gain.ci95[1] - gain.ci95[0], 2 * 1.96 * error, 0.1 * error * 4);
  EXPECT_EQ(paired_gain({2, 2, 2}, 1).ci95[0], 2);
}

}  // namespace
}  // namespace layerloop::validation
