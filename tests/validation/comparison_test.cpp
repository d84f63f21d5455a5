#include "validation/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "validation/stage_clamp.hpp"

namespace layerloop::validation {
namespace {

/// Width = 1 um per W of absorbed power; the light absorbs `share` unless a condition gives laser.absorptivity.
class LinearModel final : public Model {
 public:
  LinearModel(Study study, double share) : study_(std::move(study)), share_(share) {}

  Prediction predict(ModelPoint const& point) override {
    auto const n = static_cast<Eigen::Index>(study_.observables.size());
    Prediction all{Eigen::VectorXd(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Constant(n, 1e-6)};
    for (Eigen::Index i = 0; i < n; ++i) {
      Observable const& asked = study_.observables[static_cast<std::size_t>(i)];
      auto const& inputs = study_.conditions[asked.condition].inputs;
      double const power = inputs.at("laser.power") * (point.calibration.size() > 0 ? 1 + point.calibration[0] : 1);
      double const share = inputs.contains("laser.absorptivity") ? inputs.at("laser.absorptivity") : share_;
      all.value[i] = asked.quantity == "absorptivity" ? share : 1e-6 * share * power;
      if (power > 1000) all.value[i] = std::numeric_limits<double>::quiet_NaN();
    }
    return all;
  }
  double passes() const override { return 1; }

 private:
  Study study_;
  double share_;
};

ModelMaker with_share(double share) {
  return [share](Study const& study) { return std::make_unique<LinearModel>(study, share); };
}

/// Six powers, width and absorptivity of each, as if the light absorbed 0.5.
Study measured_at_half(double last_power = 300) {
  Study study;
  for (double const power : {50.0, 100.0, 150.0, 200.0, 250.0, last_power}) {
    std::size_t const c = study.conditions.size();
    study.conditions.push_back({.id = std::to_string(c), .inputs = {{"laser.power", power}}});
    for (char const* quantity : {"pool.width", "absorptivity"}) {
      bool const width = std::string(quantity) == "pool.width";
      Observation seen;
      seen.id = quantity + std::to_string(c);
      seen.condition = c;
      seen.observable = study.observables.size();
      seen.quantity = quantity;
      seen.value = width ? 0.5e-6 * power : 0.5;
      seen.u_stat = width ? 2e-6 : 0.01;
      study.observations.push_back(seen);
      study.observables.push_back({.condition = c, .quantity = quantity});
    }
  }
  return study;
}

ComparedQuantity const& quantity(Comparison const& compared, std::string const& name) {
  return *std::ranges::find(compared.quantities, name, &ComparedQuantity::name);
}

TEST(Comparison, CountsErrorsInTheWordsOfTheStandard) {
  Study study = measured_at_half();
  study.calibration.push_back({.name = "error of laser.power", .key = "laser.power", .sd = 0.1, .relative = true});
  Comparison const compared = compare(study, with_share(0.6), 1);
  ComparedPoint const& first = compared.points.front();  // 30 um for 25 um, 10 % of the power are 3 um
  EXPECT_NEAR(first.error(), 5e-6, 1e-18);
  EXPECT_NEAR(first.u_input, 3e-6, 1e-15);
  EXPECT_NEAR(first.u_val(), std::sqrt(4 + 1 + 9) * 1e-6, 1e-15);
  EXPECT_TRUE(first.inside());
  ComparedQuantity const& width = quantity(compared, "pool.width");
  EXPECT_EQ(width.points, 6U);
  EXPECT_NEAR(width.bias, 0.1e-6 * 175, 1e-15);
  EXPECT_NEAR(width.relative_rms, 0.2, 1e-12);
  EXPECT_NEAR(width.area, width.bias, 1e-15) << "all too high: the area is the shift";
  EXPECT_EQ(quantity(compared, "absorptivity").inside_2u, 0);
}

/// By Sherman and Morrison: r^T (D + v v^T)^-1 r = r^T D^-1 r - (v^T D^-1 r)^2 / (1 + v^T D^-1 v).
TEST(Comparison, SharesTheErrorOfAnInput) {
  Study study = measured_at_half();
  std::erase_if(study.observations, [](Observation const& o) { return o.quantity != "pool.width"; });
  study.calibration.push_back({.name = "error of laser.power", .key = "laser.power", .sd = 0.1, .relative = true});
  Comparison const compared = compare(study, with_share(0.6), 1);
  // D = 4 um2 for each, and the mesh error of 1 um that all of them share: once more by Sherman and Morrison.
  double rr = 0, vr = 0, vv = 0, r1 = 0, v1 = 0;
  for (double const power : {50, 100, 150, 200, 250, 300}) {
    double const r = -0.1 * power, v = 0.06 * power;  // um
    rr += r * r / 4, vr += v * r / 4, vv += v * v / 4, r1 += r / 4, v1 += v / 4;
  }
  double const shared = 1 + 6.0 / 4;
  rr -= r1 * r1 / shared, vr -= v1 * r1 / shared, vv -= v1 * v1 / shared;
  EXPECT_NEAR(compared.chi2, rr - vr * vr / (1 + vv), 1e-8 * rr);
}

TEST(Comparison, PutsTheFaultUpstreamWhenTheMeasuredLightMendsThePools) {
  Comparison const compared = compare(measured_at_half(), with_share(0.6), 1);
  auto const heat = std::ranges::find(compared.stages, EffectStage::heat, &ComparedStage::stage);
  ASSERT_TRUE(heat->chi2_clamped);
  EXPECT_NEAR(*heat->chi2_clamped, 0, 1e-20);
  EXPECT_GT(heat->chi2_of_clamped_points, 100);
  EXPECT_NE(heat->sentence.find("upstream"), std::string::npos);
}

TEST(Comparison, FindsTheFaultInTheHeatWhenItStays) {
  Study study = measured_at_half();
  for (Observation& o : study.observations)
    if (o.quantity == "pool.width") o.value *= 1.5;
  Comparison const compared = compare(study, with_share(0.5), 1);
  auto const heat = std::ranges::find(compared.stages, EffectStage::heat, &ComparedStage::stage);
  EXPECT_NE(heat->sentence.find("the fault lies in the heat"), std::string::npos);
  EXPECT_LT(compared.patterns.front().p, 0.01);
}

TEST(Comparison, LeavesOutWhatHasNoAnswerAndCountsIt) {
  Comparison const compared = compare(measured_at_half(2000), with_share(0.5), 1);
  EXPECT_EQ(compared.dof, 10U);
  EXPECT_EQ(quantity(compared, "pool.width").unanswered, 1U);
  EXPECT_NEAR(compared.chi2, 0, 1e-20);
  EXPECT_EQ(compared.study.observations[compared.points.back().observation].id, "absorptivity4");
}

}  // namespace
}  // namespace layerloop::validation
