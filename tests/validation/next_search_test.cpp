// Proposals for what to measure next, against what they promise.
#include "validation/next_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "validation/blind/analytic_chain.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/largest_null.hpp"
#include "validation/rival_fits.hpp"

namespace layerloop::validation {
namespace {

/// Training data of the chain with an effect in it, diagnosed.
Explanation explanation_of(std::string const& effect, double strength) {
  Study study = part_of(analytic_design(5), Role::train);
  std::vector<Candidate> const candidates = analytic_candidates();
  AnalyticChain world(study, candidates);
  ModelPoint point{.calibration = Eigen::VectorXd(static_cast<Eigen::Index>(study.calibration.size())),
                   .strengths = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(candidates.size()))};
  for (std::size_t k = 0; k < study.calibration.size(); ++k)
    point.calibration[static_cast<Eigen::Index>(k)] = study.calibration[k].mean;
  for (std::size_t c = 0; c < candidates.size(); ++c)
    if (candidates[c].name == effect) point.strengths[static_cast<Eigen::Index>(c)] = strength;
  Prediction const answer = world.predict(point);
  auto const n = static_cast<Eigen::Index>(study.observations.size());
  Eigen::LLT<Eigen::MatrixXd> const factor(covariance(study, answer));
  Eigen::VectorXd const values =
      at_observations(study, answer.value) + Eigen::MatrixXd(factor.matrixL()) * standard_normal(n, 1, 0);
  for (Eigen::Index i = 0; i < n; ++i) study.observations[static_cast<std::size_t>(i)].value = values[i];
  AnalyticChain model(study, candidates);
  return explain(study, model, candidates, {}, {}, 17);
}

ModelOf chain_of(std::vector<Candidate> const& candidates) {
  return [&](Study const& other) { return std::make_unique<AnalyticChain>(other, candidates); };
}

TEST(Separation, is_what_a_refit_cannot_undo) {
  // Two readings so far, that one free number can shift alike; the new reading it cannot move at all.
  Eigen::Vector2d const difference(1, 1);
  Eigen::MatrixXd const shift = Eigen::Vector2d(1, 1);
  EXPECT_NEAR(separation(difference, shift, 3, Eigen::RowVectorXd::Zero(1)), 9, 1e-12);
  // Moved by the same number just as far as the rivals differ, it tells nothing.
  EXPECT_NEAR(separation(difference, shift, 1, Eigen::RowVectorXd::Ones(1)), 0, 1e-12);
  // In between: distance of (1, 1, 3) from the line along (1, 1, 1).
  EXPECT_NEAR(separation(difference, shift, 3, Eigen::RowVectorXd::Ones(1)), 11 - 25.0 / 3, 1e-12);
}

TEST(NextExperiments, of_a_group_tell_its_members_apart_by_what_they_say) {
  Explanation const explained = explanation_of("rolling_resistance", 1);
  ASSERT_EQ(explained.found.verdict, Verdict::GROUP) << explained.found.sentence;
  std::vector<Candidate> const candidates = explained.candidates;
  AnalyticChain model(explained.study, candidates);
  std::vector<NextExperiment> const next = next_experiments(explained, model, chain_of(candidates));
  for (NextExperiment const& proposal : next) {
    EXPECT_TRUE(proposal.simulated);
    EXPECT_GE(proposal.replicates, 1);
    EXPECT_LE(proposal.replicates, 20);
    EXPECT_GT(proposal.u, 0);
    EXPECT_GE(proposal.separates.size(), 2U);
    // One reading never tells more than the rivals differ by.
    EXPECT_TRUE(std::isfinite(proposal.difference));
  }
  EXPECT_TRUE(std::ranges::is_sorted(next, {}, &NextExperiment::replicates));
}

TEST(NextExperiments, of_a_plain_answer_are_none) {
  Explanation const explained = explanation_of("keyhole", 0.5);
  ASSERT_EQ(explained.found.verdict, Verdict::IDENTIFIED);
  AnalyticChain model(explained.study, explained.candidates);
  EXPECT_TRUE(next_experiments(explained, model, chain_of(explained.candidates)).empty());
}

TEST(ConditionGrid, holds_the_study_and_stays_within_its_range) {
  Study const study = part_of(analytic_design(5), Role::train);
  std::vector<std::size_t> origin;
  std::vector<Condition> const grid = condition_grid(study, origin);
  ASSERT_EQ(grid.size(), origin.size());
  ASSERT_GT(grid.size(), study.conditions.size() + 20);
  auto const speed = [](Condition const& c) { return c.inputs.at("scan.scan_speed"); };
  auto const [low, high] = std::ranges::minmax(study.conditions, {}, speed);
  for (std::size_t c = 0; c < grid.size(); ++c) {
    EXPECT_GE(speed(grid[c]), speed(low) - 1e-12);
    EXPECT_LE(speed(grid[c]), speed(high) + 1e-12);
    EXPECT_EQ(grid[c].labels, study.conditions[origin[c]].labels);
  }
}

}  // namespace
}  // namespace layerloop::validation
