// The search and its statement of what is left open, on angles that follow a law that is known.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "coupling/calibration_fit.hpp"
#include "coupling/calibration_output.hpp"

namespace layerloop::coupling {
namespace {
constexpr double degree = std::numbers::pi / 180;

CalibrateSettings settings() {
  CalibrateSettings c;
  c.target_repose = 28.7 * degree;
  c.target_slip = 41.6 * degree;
  c.tolerance = 0.04;
  c.friction = {0.3, 1.1};
  c.cohesion = {2e4, 16e4};
  return c;
}

/// Angles that go with powers of the parameters: slopes are the exponents.
CalibrationPoint power_law(ContactParameters const& p) {
  CalibrationPoint point{.parameters = p};
  point.repose.value = 0.4 * std::pow(p.sliding_friction, 0.3) * std::pow(p.rolling_friction / 0.15, 0.2) *
                       std::pow(p.cohesion_energy_density / 9e4, 0.25);
  point.slip.value = 0.8 * std::pow(p.wall_friction, 0.5) * std::pow(p.wall_cohesion / 9e4, 0.1);
  point.repose.u_num = point.slip.u_num = 0.01;
  point.largest_tilt = 1.2;
  return point;
}

TEST(ResponseSurfaceTest, IsExactForASurfaceOfSecondOrder) {
  auto const value = [](double u, double v) { return 3 + 2 * u - v + 0.5 * u * u - 0.7 * u * v + 0.1 * v * v; };
  std::vector<ResponseSurface::Point> points;
  for (double u : {-1.0, 0.0, 1.0})
    for (double v : {-1.0, 0.0, 1.0}) points.push_back({u, v, value(u, v), 1 + u + v * v});
  ResponseSurface const fitted(points);
  for (double u : {-0.9, 0.35, 0.8}) EXPECT_NEAR(fitted(u, 0.6 * u - 0.1), value(u, 0.6 * u - 0.1), 1e-6);
}

TEST(SearchRangeTest, PlacesRunFromMinusOneToOne) {
  SearchRange const range(settings());
  EXPECT_DOUBLE_EQ(range.friction(-1), 0.3);
  EXPECT_DOUBLE_EQ(range.cohesion(1), 16e4);
  auto const [u, v] = range.place({.sliding_friction = 0.7, .cohesion_energy_density = 9e4});
  EXPECT_NEAR(u, 0, 1e-12);
  EXPECT_NEAR(v, 0, 1e-12);
}

TEST(SensitivityTest, SlopesAndCompensationsOfAPowerLaw) {
  ContactParameters const at{0.7, 0.15, 9e4, 0.7, 9e4};
  double const step = 0.05;
  std::vector<CalibrationPoint> changed;
  for (std::size_t p = 0; p < ContactParameters::count; ++p) {
    for (double const sign : {1.0, -1.0}) {
      auto values = at.values();
      values[p] *= 1 + sign * step;
      changed.push_back(power_law(ContactParameters::of(values)));
    }
  }
  Sensitivity const s = sensitivity_of(power_law(at), changed, step);
  double const expected[2][5] = {{0.3, 0.2, 0.25, 0, 0}, {0, 0, 0, 0.5, 0.1}};
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t p = 0; p < 5; ++p) EXPECT_NEAR(s.slope[a][p], expected[a][p], 1e-3) << a << p;
  ASSERT_EQ(s.undetermined.size(), 4u);  // one for each other parameter, and the combination that is told worst
  for (std::size_t k = 0; k < 3; ++k) {  // the changes keep both angles
    for (std::size_t a = 0; a < 2; ++a) {
      double moved = 0;
      for (std::size_t p = 0; p < 5; ++p) moved += s.slope[a][p] * s.undetermined[k].change[p];
      EXPECT_NEAR(moved, 0, 1e-12) << s.undetermined[k].text;
    }
  }
  EXPECT_NEAR(s.undetermined[0].change[1], 0.1, 1e-12);
  // repose 0.3 f + 0.25 c, slip 0.5 f + 0.1 c: the worst combination raises one and lowers the other
  EXPECT_LT(s.undetermined[3].change[0] * s.undetermined[3].change[2], 0);
}

TEST(SensitivityTest, SingularValuesOfIndependentAngles) {
  ContactParameters const at{0.7, 0.15, 9e4, 0.7, 9e4};
  CalibrationPoint centre = power_law(at);
  centre.repose.u_num = 0.01 * centre.repose.value;  // 1 % each
  centre.slip.u_num = 0.01 * centre.slip.value;
  std::vector<CalibrationPoint> changed(10, centre);
  changed[0].repose.value *= 1.1;  // friction alone moves the angle of repose, slope 1
  changed[1].repose.value *= 0.9;
  Sensitivity const s = sensitivity_of(centre, changed, 0.1);
  EXPECT_NEAR(s.singular_values[0], 100, 1e-6);
  EXPECT_NEAR(s.singular_values[1], 0, 1e-6);
}

TEST(PointTest, LayerThatSticksCountsWithTheLargestTilt) {
  CalibrationPoint p = power_law({0.7, 0.15, 9e4, 0.7, 9e4});
  p.slip.value = std::nan("");
  EXPECT_FALSE(p.slipped());
  EXPECT_NEAR(p.errors(settings())[1], 1.2 / (41.6 * degree) - 1, 1e-12);
}

TEST(PageTest, TellsVerdictPointsAndWhatIsLeftOpen) {
  Case c;
  c.name = "a <case>";
  c.calibrate = settings();
  Calibration found;
  for (double friction : {0.3, 0.7, 1.1})
    for (double cohesion : {2e4, 9e4, 16e4})
      found.points.push_back(power_law({friction, 0.15, cohesion, friction, cohesion}));
  found.map_points = 9;
  found.verdict = "no point reaches both";
  found.sensitivity.emplace();
  found.sensitivity->undetermined.push_back({"rolling & sliding", {}});
  std::string const page = calibration_page(c, found);
  for (char const* part : {"a &lt;case&gt;", "no point reaches both", "rolling &amp; sliding", "angle of repose [deg]",
                           "slipping angle [deg]", "points.csv"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace layerloop::coupling
