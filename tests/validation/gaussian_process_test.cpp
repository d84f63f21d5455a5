// Gaussian processes against their closed forms.
#include "validation/gaussian_process.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "validation/maximise.hpp"

namespace layerloop::validation {
namespace {

double matern(double sd, double distance_in_lengths) {
  double const a = std::sqrt(5) * distance_in_lengths;
  return sd * sd * (1 + a + a * a / 3) * std::exp(-a);
}

Eigen::MatrixXd grid(int n) {  // (n^2, 2) in the unit square
  Eigen::MatrixXd places(n * n, 2);
  for (int i = 0; i < n * n; ++i) places.row(i) << (i % n) / (n - 1.0), (i / n) / (n - 1.0);
  return places;
}

TEST(GaussianProcess, one_reading_pulls_mean_and_variance_as_the_closed_form_says) {
  double const sd = 2, noise = 0.5, reading = 3, mean = 1;
  GaussianProcess const process({sd, Eigen::Vector2d(0.5, 4)}, mean, Eigen::RowVector2d(0.2, 1),
                                Eigen::VectorXd::Constant(1, reading), Eigen::VectorXd::Constant(1, noise));
  double const shared = matern(sd, std::hypot(0.6 / 0.5, 2.0 / 4));
  Estimate const there = process(Eigen::RowVector2d(0.8, 3));
  EXPECT_NEAR(there.mean, mean + shared / (sd * sd + noise) * (reading - mean), 1e-9);
  EXPECT_NEAR(there.sd * there.sd, sd * sd - shared * shared / (sd * sd + noise), 1e-9);
  EXPECT_NEAR(
      process.log_likelihood(),
      -0.5 * std::pow(reading - mean, 2) / (sd * sd + noise) - 0.5 * std::log(2 * std::numbers::pi * (sd * sd + noise)),
      1e-9);
}

TEST(GaussianProcess, passes_through_readings_without_noise) {
  Eigen::MatrixXd const places = grid(4);
  Eigen::VectorXd const values = (3 * places.col(0)).array().sin() + places.col(1).array().square();
  GaussianProcess const process({1, Eigen::Vector2d(0.7, 0.7)}, 0, places, values, Eigen::VectorXd::Zero(16));
  for (Eigen::Index i = 0; i < 16; ++i) {
    EXPECT_NEAR(process(places.row(i)).mean, values[i], 1e-7);
    EXPECT_LT(process(places.row(i)).sd, 1e-4);
  }
}

TEST(GaussianProcess, leaves_groups_out_as_if_they_had_never_been_read) {
  Eigen::MatrixXd const places = grid(3);
  Eigen::VectorXd const values = (places.col(0) - 2 * places.col(1)).array().cos();
  Eigen::VectorXd const noise = Eigen::VectorXd::Constant(9, 0.01);
  Matern const kernel{1.3, Eigen::Vector2d(0.6, 1.1)};
  LeftOut const left_out = GaussianProcess(kernel, 0.2, places, values, noise).left_out({0, 0, 1, 1, 2, 2, 3, 3, 3});
  std::vector<Eigen::Index> const others{0, 1, 4, 5, 6, 7, 8};
  GaussianProcess const without(kernel, 0.2, places(others, Eigen::all), values(others), noise(others));
  EXPECT_NEAR(left_out.mean[2], without(places.row(2)).mean, 1e-8);
  EXPECT_NEAR(left_out.mean[3], without(places.row(3)).mean, 1e-8);
  EXPECT_NEAR(left_out.sd[3], std::hypot(without(places.row(3)).sd, 0.1), 1e-8);  // of a reading
}

TEST(GaussianProcess, tells_several_places_together_as_it_tells_one) {
  Eigen::MatrixXd const places = grid(3);
  Eigen::VectorXd const values = places.col(0).array().exp();
  Matern const kernel{0.8, Eigen::Vector2d(0.5, 0.9), 2};
  GaussianProcess const process(kernel, 1, places, values, Eigen::VectorXd::Constant(9, 0.05));
  Eigen::MatrixXd const there = (Eigen::MatrixXd(2, 2) << 0.2, 0.7, 0.4, 0.1).finished();
  Joint const joint = process.together(there);
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(joint.mean[i], process(there.row(i)).mean, 1e-10);
    EXPECT_NEAR(std::sqrt(joint.covariance(i, i)), process(there.row(i)).sd, 1e-10);
  }
  // Reading one of the two without noise moves the other by covariance / variance.
  Eigen::MatrixXd more(10, 2);
  more << places, there.row(0);
  Eigen::VectorXd readings(10), noise = Eigen::VectorXd::Constant(10, 0.05);
  readings << values, joint.mean[0] + 1;
  noise[9] = 0;
  EXPECT_NEAR(GaussianProcess(kernel, 1, more, readings, noise)(there.row(1)).mean,
              joint.mean[1] + joint.covariance(0, 1) / joint.covariance(0, 0), 1e-6);
}

TEST(GaussianProcess, far_from_readings_of_an_unknown_level_tells_their_average) {
  double const sd = 0.3, level = 5, noise = 0.2;
  Eigen::MatrixXd const places = 100 * grid(2);  // far from one another: independent but for the level
  Eigen::Vector4d const values(1, 2, 4, 9);
  GaussianProcess const process({sd, Eigen::Vector2d(1, 1), level}, 0, places, values,
                                Eigen::Vector4d::Constant(noise));
  double const own = sd * sd + noise, precision = 4 / own + 1 / (level * level);
  Estimate const far = process(Eigen::RowVector2d(50, -70));
  EXPECT_NEAR(far.mean, 16 / own / precision, 1e-7);
  EXPECT_NEAR(far.sd * far.sd, sd * sd + 1 / precision, 1e-7);
}

TEST(GaussianProcess, fitted_finds_which_input_matters_and_predicts_between_its_places) {
  Eigen::MatrixXd const places = grid(7);
  auto const truth = [](double x) { return std::sin(3 * x); };
  Eigen::VectorXd const values = places.col(0).unaryExpr(truth);
  GaussianProcess const process = fit_gaussian_process(places, values, Eigen::VectorXd::Constant(49, 1e-6));
  EXPECT_GT(process.kernel().length[1], 5 * process.kernel().length[0]);
  for (double const x : {0.07, 0.4, 0.93}) EXPECT_NEAR(process(Eigen::RowVector2d(x, 0.55)).mean, truth(x), 0.02);
}

TEST(Maximise, finds_a_top_inside_and_one_on_the_wall) {
  auto const hill = [](Eigen::VectorXd const& x) { return 5 - std::pow(x[0] - 0.3, 2) - 2 * std::pow(x[1] - 4, 2); };
  Maximum const top = maximise(hill, Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 2), {Eigen::Vector2d(0.9, 0)}, 300);
  EXPECT_NEAR(top.at[0], 0.3, 0.02);
  EXPECT_NEAR(top.at[1], 2, 1e-3);
  EXPECT_NEAR(top.value, 5 - 8, 1e-2);
}

}  // namespace
}  // namespace layerloop::validation
