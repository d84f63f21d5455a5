#include "core/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace layerloop {
namespace {

TEST(StudentT, QuantilesOfTheTables) {
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.7062, 5e-5);
  EXPECT_NEAR(student_t_quantile(0.975, 2), 4.30265, 5e-6);
  EXPECT_NEAR(student_t_quantile(0.975, 4), 2.77645, 5e-6);
  EXPECT_NEAR(student_t_quantile(0.975, 9), 2.26216, 5e-6);
  EXPECT_NEAR(student_t_quantile(0.95, 30), 1.69726, 5e-6);
  EXPECT_NEAR(student_t_quantile(0.025, 9), -2.26216, 5e-6);
}

TEST(Sample, OfThreeValues) {
  Sample const sample = sample_of(std::vector<double>{1, 2, 6});
  EXPECT_EQ(sample.n, 3);
  EXPECT_DOUBLE_EQ(sample.mean, 3);
  EXPECT_DOUBLE_EQ(sample.sd, std::sqrt(7.0));
  EXPECT_NEAR(sample.half_width, 4.30265 * std::sqrt(7.0 / 3), 1e-5);
}

TEST(Sample, LeavesOutWhatWasNotMeasured) {
  double const nothing = std::numeric_limits<double>::quiet_NaN();
  Sample const two = sample_of(std::vector<double>{nothing, 4, 6});
  EXPECT_EQ(two.n, 2);
  EXPECT_EQ(two.mean, 5);
  Sample const one = sample_of(std::vector<double>{nothing, 4});
  EXPECT_EQ(one.mean, 4);
  EXPECT_TRUE(std::isnan(one.half_width));
  EXPECT_TRUE(std::isnan(sample_of(std::vector<double>{nothing}).mean));
}

}  // namespace
}  // namespace layerloop
