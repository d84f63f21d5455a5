// Family-wise levels and the words of patterns, on residuals whose structure is known.
#include "validation/pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace layerloop::validation {
namespace {

/// 30 conditions over two inputs that are not correlated, one reading of depth and width each, unit uncertainty.
Study thirty_conditions() {
  Study study;
  study.observables = {};
  for (std::size_t c = 0; c < 30; ++c) {
    double const power = 100.0 + 20.0 * static_cast<double>(c % 6), speed = 0.4 + 0.2 * static_cast<double>(c / 6);
    study.conditions.push_back({.id = std::to_string(c + 1),
                                .inputs = {{"laser.power", power}, {"scan.scan_speed", speed}},
                                .labels = {{"machine", c < 15 ? "A" : "B"}}});
    for (char const* quantity : {"pool.depth", "pool.width"}) {
      study.observations.push_back({.id = quantity + std::to_string(c),
                                    .condition = c,
                                    .observable = study.observables.size(),
                                    .quantity = quantity,
                                    .value = 50,
                                    .u_stat = 1});
      study.observables.push_back({c, quantity});
    }
  }
  return study;
}

TEST(Largest_null, of_one_direction_is_the_normal_distribution) {
  LargestNull const null(Eigen::VectorXd::Unit(50, 3), {true}, 1);
  EXPECT_NEAR(null.critical(0.05), 1.96, 0.06);
  EXPECT_NEAR(null.p(2.5758), 0.01, 0.003);
  EXPECT_NEAR(std::log(null.p(6.0)), std::log(1.9732e-9), 0.3);
}

TEST(Largest_null, of_independent_directions_follows_Sidak) {
  LargestNull const null(Eigen::MatrixXd::Identity(100, 100), std::vector<bool>(100, true), 2);
  EXPECT_NEAR(null.critical(0.05), 3.474, 0.06);  // 1 - 0.95^(1/100) on both sides
  EXPECT_NEAR(null.critical(0.01), 3.886, 0.12);
}

TEST(Patterns, are_found_with_their_words_where_they_were_put) {
  Study const study = thirty_conditions();
  Eigen::VectorXd const predicted = Eigen::VectorXd::Constant(60, 50);
  Whitening const whiten(Eigen::MatrixXd::Identity(60, 60));
  PatternSearch const search(generic_patterns(study, predicted, whiten), Projection(60, Eigen::MatrixXd(60, 0)), 7);
  Eigen::VectorXd residual = standard_normal(60, 11, 0);
  EXPECT_GT(search.find(residual, 1.0).front().p, 0.05);
  for (Eigen::Index i = 0; i < 60; i += 2) {
    auto const& condition = study.conditions[static_cast<std::size_t>(i / 2)];
    residual[i] -= 0.05 * (condition.inputs.at("laser.power") - 150);  // depth alone
  }
  PatternFinding const best = search.find(residual, 1.0).front();
  EXPECT_EQ(best.text, "measured below pool.depth: over laser.power");
  EXPECT_LT(best.p, 1e-4);
}

TEST(Patterns, false_ones_are_as_rare_as_promised) {
  Study const study = thirty_conditions();
  Whitening const whiten(Eigen::MatrixXd::Identity(60, 60));
  Eigen::MatrixXd const calibration = Eigen::VectorXd::Ones(60);
  Projection const project(60, calibration);
  PatternSearch const search(generic_patterns(study, Eigen::VectorXd::Constant(60, 50), whiten), project, 7);
  int found = 0;
  for (std::uint64_t k = 0; k < 1000; ++k)
    found += search.find(project(standard_normal(60, 99, k)), 1.0, 1).front().p < 0.05 ? 1 : 0;
  EXPECT_GT(found, 25);  // 50 expected, +-7
  EXPECT_LT(found, 80);
}

}  // namespace
}  // namespace layerloop::validation
