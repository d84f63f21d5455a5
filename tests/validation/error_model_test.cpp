// Whitening and projection against what they are defined by.
#include "validation/error_model.hpp"

#include <gtest/gtest.h>

namespace layerloop::validation {
namespace {

/// Three readings: two of one observable in one sys_group, one alone.
Study three_readings() {
  Study study;
  study.conditions = {{.id = "a"}};
  study.observables = {{0, "pool.depth"}, {0, "pool.width"}};
  study.observations = {
      {.id = "1",
       .observable = 0,
       .quantity = "pool.depth",
       .value = 100,
       .u_stat = 3,
       .u_sys_rel = 0.1,
       .sys_group = "etch"},
      {.id = "2",
       .observable = 0,
       .quantity = "pool.depth",
       .value = 104,
       .u_stat = 4,
       .u_sys_rel = 0.1,
       .sys_group = "etch"},
      {.id = "3", .observable = 1, .quantity = "pool.width", .value = 200, .u_stat = 5, .u_sys_abs = 12}};
  return study;
}

TEST(Covariance, has_readings_on_the_diagonal_and_what_they_share_beside_it) {
  Study const study = three_readings();
  Prediction const prediction{Eigen::Vector2d(50, 100), Eigen::Vector2d(2, 0), Eigen::Vector2d(1, 0)};
  Eigen::Matrix3d expected;
  expected << 9 + 25 + 5, 25 + 5, 0, 25 + 5, 16 + 25 + 5, 0, 0, 0, 25 + 144;
  EXPECT_LT((covariance(study, prediction) - expected).norm(), 1e-12);
}

TEST(Whitening, turns_the_covariance_into_one) {
  Study const study = three_readings();
  Prediction const prediction{Eigen::Vector2d(50, 100), Eigen::Vector2d(2, 0), Eigen::Vector2d(1, 0)};
  Eigen::MatrixXd const c = covariance(study, prediction);
  Whitening const whiten(c);
  EXPECT_LT((whiten(whiten(c).transpose()) - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(Projection, removes_its_columns_and_counts_them_once) {
  Eigen::MatrixXd columns(4, 3);
  columns << 1, 2, 3, 0, 1, 1, 0, 0, 0, 1, 1, 2;  // the third is the sum of the others
  Projection const project(4, columns);
  EXPECT_EQ(project.rank(), 2);
  EXPECT_LT(project(columns).norm(), 1e-12);
  Eigen::Vector4d const other(1, 5, 2, -1);
  EXPECT_LT((project(project(other)) - project(other)).norm(), 1e-12);
  EXPECT_LT(std::abs((columns.transpose() * project(other)).norm()), 1e-12);
  EXPECT_NEAR(project.diagonal().sum(), 2, 1e-12);
}

}  // namespace
}  // namespace layerloop::validation
