// Proposals for what to measure next, against what they promise.
#include "validation/next_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "validation/blind/analytic_chain.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/largest_null.hpp"
#include "validation/rival_fits.hpp"

namespace layerloop::validation {
namespace {

/// Fills in what the chain with an effect in it would read.
void measure(Study& study, std::string const& effect, double strength, std::uint64_t seed) {
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
      at_observations(study, answer.value) + Eigen::MatrixXd(factor.matrixL()) * standard_normal(n, 1, seed);
  for (Eigen::Index i = 0; i < n; ++i) study.observations[static_cast<std::size_t>(i)].value = values[i];
}

Explanation explanation_of(Study const& study) {
  std::vector<Candidate> const candidates = analytic_candidates();
  AnalyticChain model(study, candidates);
  return explain(study, model, candidates, {}, {}, 17);
}

/// Training data of the chain with an effect in it, diagnosed.
Explanation explanation_of(std::string const& effect, double strength) {
  Study study = part_of(analytic_design(5), Role::train);
  measure(study, effect, strength, 0);
  return explanation_of(study);
}

/// The study with the rows that are proposed.
Study extended(Study study, NextExperiment const& proposal) {
  std::vector<Condition> places = proposal.also_at;
  places.push_back(proposal.condition);
  std::vector<std::string> quantities = proposal.together;
  quantities.push_back(proposal.quantity);
  std::vector<Observation> const known = study.observations;
  for (Condition const& place : places) {
    study.conditions.push_back(place);
    for (CalibrationParameter& number : study.calibration)
      if (!number.acts_on.empty()) throw std::logic_error("numbers of single labels are not told for new conditions");
    for (std::string const& quantity : quantities) {
      Observation row = *std::ranges::find(known, quantity, &Observation::quantity);
      row.condition = study.conditions.size() - 1, row.observable = study.observables.size();
      study.observables.push_back({row.condition, quantity});
      for (int r = 0; r < proposal.replicates; ++r) {
        row.id = "new" + std::to_string(study.observations.size()), row.rep_id = std::to_string(r + 1);
        study.observations.push_back(row);
      }
    }
  }
  return study;
}

ModelOf chain_of(std::vector<Candidate> const& candidates) {
  return [&](Study const& other) { return std::make_unique<AnalyticChain>(other, candidates); };
}

TEST(Separation, is_what_a_refit_cannot_undo) {
  // Two readings so far, that one free number can shift alike; the new reading it cannot move at all.
  Eigen::Vector2d const difference(1, 1);
  Eigen::MatrixXd const shift = Eigen::Vector2d(1, 1);
  auto const with = [&](double more, double slope) {
    return separation(difference, shift, Eigen::VectorXd::Constant(1, more), Eigen::MatrixXd::Constant(1, 1, slope));
  };
  EXPECT_NEAR(with(3, 0), 9, 1e-12);
  // Moved by the same number just as far as the rivals differ, it tells nothing.
  EXPECT_NEAR(with(1, 1), 0, 1e-12);
  // In between: distance of (1, 1, 3) from the line along (1, 1, 1).
  EXPECT_NEAR(with(3, 1), 11 - 25.0 / 3, 1e-12);
  // Two readings at once: distance of (1, 1, 3, -1) from the line along (1, 1, 1, 1).
  EXPECT_NEAR(separation(difference, shift, Eigen::Vector2d(3, -1), Eigen::MatrixXd::Ones(2, 1)), 8, 1e-12);
}

/// The right one is to lead in 95 of 100 studies: in 5 of 6 or more by chance in 97 of 100.
TEST(NextExperiments, of_a_group_tell_its_members_apart_once_they_are_made) {
  constexpr auto hidden = "surface_losses", rival = "variable_conductivity";
  constexpr double strength = 0.5;
  Explanation const explained = explanation_of(hidden, strength);
  ASSERT_EQ(explained.found.verdict, Verdict::GROUP) << explained.found.sentence;
  AnalyticChain model(explained.study, explained.candidates);
  std::vector<NextExperiment> const next = next_experiments(explained, model, chain_of(explained.candidates));
  ASSERT_FALSE(next.empty());
  EXPECT_TRUE(std::ranges::is_sorted(next, {}, &NextExperiment::replicates));
  NextExperiment const& proposal = next.front();
  std::printf("%s and %zu more, here and at %zu places more: %d readings\n", proposal.quantity.c_str(),
              proposal.together.size(), proposal.also_at.size(), proposal.replicates);
  EXPECT_TRUE(proposal.simulated);
  EXPECT_GE(proposal.replicates, 1);
  EXPECT_LE(proposal.replicates, 20);
  EXPECT_GT(proposal.u, 0);
  EXPECT_EQ(proposal.separates, (std::vector<std::string>{hidden, rival}));
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Study wider = extended(explained.study, proposal);
    measure(wider, hidden, strength, seed);
    std::copy(explained.study.observations.begin(), explained.study.observations.end(), wider.observations.begin());
    Diagnosis const again = explanation_of(wider).found;
    std::printf("%s\n", again.sentence.c_str());
    right += !again.effects.empty() && again.effects.front().active && again.effects.front().name == hidden;
  }
  EXPECT_GE(right, 5);
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
