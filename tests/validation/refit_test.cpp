// Derivatives of a model whose grains fall otherwise at every point.
#include "validation/refit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "validation/blind/analytic_chain.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/error_model.hpp"
#include "validation/largest_null.hpp"

namespace layerloop::validation {
namespace {

/// The chain, its beds known from few grains: every friction draws them anew.
struct FewGrains : Model {
  AnalyticChain chain;
  Study study;
  double scatter;  ///< as a share

  FewGrains(Study const& given, double share) : chain(given, {}), study(given), scatter(share) {}
  Prediction predict(ModelPoint const& point) override {
    Prediction found = chain.predict(point);
    Eigen::VectorXd const z = standard_normal(found.value.size(), std::hash<double>()(point.calibration[3]), 0);
    for (Eigen::Index o = 0; o < z.size(); ++o) {
      if (!study.observables[static_cast<std::size_t>(o)].quantity.starts_with("bed.")) continue;
      found.u_sampling[o] = scatter * found.value[o];
      found.value[o] += found.u_sampling[o] * z[o];
    }
    return found;
  }
  double passes() const override { return chain.passes(); }
};

Fit fit_of(Study const& study, double scatter) {
  FewGrains model(study, scatter);
  ResidualFrame const frame(study, FewGrains(study, 0.01).predict({prior_means(study), {}}));
  return Refit(model, {}, frame, 1).at({prior_means(study), Eigen::VectorXd(0)}, {});
}

TEST(Refit, sees_what_friction_does_although_grains_fall_otherwise) {
  Study const study = part_of(analytic_design(5), Role::train);
  ASSERT_EQ(study.calibration[3].key, "contact.sliding_friction");
  Eigen::MatrixXd const exact = fit_of(study, 0).jacobian, sampled = fit_of(study, 0.005).jacobian;
  EXPECT_GT(exact.col(3).normalized().dot(sampled.col(3).normalized()), 0.8);
}

TEST(ResidualFrame, knows_how_far_two_draws_of_grains_lie_apart) {
  Study const study = part_of(analytic_design(5), Role::train);
  FewGrains model(study, 0.01);
  Prediction const base = model.predict({prior_means(study), {}});
  ResidualFrame const frame(study, base);
  double sum = 0;
  constexpr int draws = 20;
  for (int k = 1; k <= draws; ++k) {
    Prediction other = model.chain.predict({prior_means(study), {}});
    other.value += base.u_sampling.cwiseProduct(standard_normal(base.value.size(), 77, static_cast<std::uint64_t>(k)));
    Prediction another = model.chain.predict({prior_means(study), {}});
    another.value +=
        base.u_sampling.cwiseProduct(standard_normal(base.value.size(), 78, static_cast<std::uint64_t>(k)));
    sum += frame.change(other, another).squaredNorm() / draws;
  }
  EXPECT_NEAR(frame.sampling_variance(base) / sum, 1, 0.15);
}

/// The chain, stopped by a guard where its absorptivity is high.
struct Guarded : Model {
  AnalyticChain chain;
  explicit Guarded(Study const& study) : chain(study, {}) {}
  Prediction predict(ModelPoint const& point) override {
    Prediction found = chain.predict(point);
    if (point.calibration[0] > 0.4) found.value[0] = std::nan("");
    return found;
  }
  double passes() const override { return chain.passes(); }
};

TEST(Refit, of_a_model_without_an_answer_is_no_fit) {
  Study study = part_of(analytic_design(5), Role::train);
  ASSERT_EQ(study.calibration[0].key, "laser.absorptivity");
  Guarded model(study);
  ModelPoint point{prior_means(study), Eigen::VectorXd(0)};
  Eigen::VectorXd const there = at_observations(study, model.predict(point).value);
  for (std::size_t i = 0; i < study.observations.size(); ++i)
    study.observations[i].value = there[static_cast<Eigen::Index>(i)];
  ResidualFrame const frame(study, model.predict(point));
  Refit const refit(model, {}, frame, 1);
  Fit const good = refit.improved(refit.at(point, {}));
  EXPECT_TRUE(good.converged);
  EXPECT_LT(good.objective, 1e-9);
  point.calibration[0] = 0.42;
  Fit const bad = refit.improved(refit.at(point, {}));
  EXPECT_FALSE(bad.converged) << "nothing to step from";
  EXPECT_FALSE(std::isfinite(bad.objective));
}

}  // namespace
}  // namespace layerloop::validation
