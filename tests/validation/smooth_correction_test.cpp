// What a smooth correction can take away from residuals whose nature is known.
#include "validation/smooth_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace layerloop::validation {
namespace {

constexpr int conditions = 36, replicates = 2;

/// Depth over power and speed, twice each.
Study tracks() {
  Study study;
  for (int c = 0; c < conditions; ++c) {
    study.conditions.push_back(
        {.id = std::to_string(c),
         .inputs = {{"laser.power", 100.0 + 20 * (c % 6)}, {"scan.scan_speed", 0.5 + 0.1 * std::floor(c / 6)}}});
    study.observables.push_back({static_cast<std::size_t>(c), "pool.depth"});
    for (int r = 0; r < replicates; ++r)
      study.observations.push_back({.id = std::to_string(c) + "." + std::to_string(r),
                                    .condition = static_cast<std::size_t>(c),
                                    .observable = static_cast<std::size_t>(c),
                                    .quantity = "pool.depth"});
  }
  return study;
}

double normal(std::uint64_t seed, std::size_t id) {  // Box and Muller
  auto const u = uniform4(seed, RandomStream::plate_heights, id);
  return std::sqrt(-2 * std::log(u[0])) * std::cos(2 * std::numbers::pi * u[1]);
}

/// Unit noise plus a structure over condition and both inputs in [0, 1].
template <class Structure>
Eigen::VectorXd residuals(Study const& study, std::uint64_t seed, Structure const& structure) {
  Eigen::VectorXd r(static_cast<Eigen::Index>(study.observations.size()));
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    std::size_t const c = study.observations[i].condition;
    r[static_cast<Eigen::Index>(i)] =
        normal(seed, i) + structure(c, static_cast<double>(c % 6) / 5, std::floor(c / 6) / 5);
  }
  return r;
}

/// Calibration can shift everything and tilt it over power.
Projection calibration(Study const& study) {
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(study.observations.size()), 2);
  for (Eigen::Index i = 0; i < columns.rows(); ++i)
    columns.row(i) << 1,
        study.conditions[study.observations[static_cast<std::size_t>(i)].condition].inputs.at("laser.power");
  return {columns.rows(), columns};
}

TEST(SmoothShare, is_nearly_all_of_a_smooth_error) {
  Study const study = tracks();
  Eigen::VectorXd const r =
      residuals(study, 1, [](auto, double power, double speed) { return 6 * std::sin(2 * power + 3 * speed); });
  EXPECT_GT(smooth_share(study, r, calibration(study), 1), 0.9);
}

TEST(SmoothShare, is_little_of_jumps_from_condition_to_condition) {
  Study const study = tracks();
  Eigen::VectorXd const r = residuals(study, 2, [](std::size_t c, double, double) { return 4 * normal(77, 1000 + c); });
  EXPECT_LT(smooth_share(study, r, calibration(study), 1), 0.15);
}

TEST(SmoothShare, is_nothing_of_what_calibration_can_do_and_of_noise) {
  Study const study = tracks();
  Projection const project = calibration(study);
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    Eigen::VectorXd const noise = residuals(study, seed, [](auto, double, double) { return 0.0; });
    Eigen::VectorXd const tilted = residuals(study, seed, [](auto, double power, double) { return 50 + 90 * power; });
    // The scale is that of the noise itself, so that nothing is in excess but by leaving out.
    double const sigma2 = project(noise).squaredNorm() / (noise.size() - project.rank());
    EXPECT_NEAR(smooth_share(study, tilted, project, sigma2), smooth_share(study, noise, project, sigma2), 1e-6);
    EXPECT_EQ(smooth_share(study, noise, project, 1.5 * sigma2), 0);
  }
}

TEST(SmoothInputs, are_what_varies_from_zero_to_one) {
  Study study = tracks();
  for (Condition& c : study.conditions) c.inputs["laser.spot_diameter"] = 8e-5;
  study.conditions[3].words["laser.profile"] = "ring";  // not everywhere: cannot be used
  Eigen::MatrixXd const inputs = smooth_inputs(study);
  ASSERT_EQ(inputs.cols(), 3);  // power, speed, order
  EXPECT_EQ(inputs.minCoeff(), 0);
  EXPECT_EQ(inputs.colwise().maxCoeff().minCoeff(), 1);
}

}  // namespace
}  // namespace layerloop::validation
