#include "coupling/report/processing_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

namespace layerloop::coupling {
namespace {

/// Pools whose width and depth are straight in power and speed, so that interpolation is exact.
WindowPoint point_at(double power, double speed) {
  return {power, speed, 1e-6 * (60 + 0.4 * power - 20 * speed), 1e-6 * (20 + 0.2 * power - 10 * speed)};
}

ProcessingWindow window() {
  ProcessingWindow made{.points = {}, .hatch_spacing = 100e-6, .layer_thickness = 40e-6, .pool_origin = "a formula"};
  for (double const power : {300.0, 100.0, 200.0})
    for (double const speed : {2.0, 0.5, 1.0}) made.points.push_back(point_at(power, speed));
  return made;
}

std::size_t occurrences(std::string const& text, std::string const& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(ProcessingWindow, PoolsBetweenThePointsAreInterpolated) {
  for (double const power : {100.0, 137.0, 200.0, 300.0})
    for (double const speed : {0.5, 0.8, 1.7, 2.0}) {
      WindowPoint const pool = point_at(power, speed);
      EXPECT_NEAR(overlap_number_at(window(), power, speed), overlap_number({pool.width, pool.depth, 100e-6, 40e-6}),
                  1e-9);
    }
  EXPECT_TRUE(std::isnan(overlap_number_at(window(), 301, 1)));
  EXPECT_TRUE(std::isnan(overlap_number_at(window(), 200, 0.4)));
}

TEST(ProcessingWindow, APointLessLeavesCirclesAndNoMap) {
  ProcessingWindow scattered = window();
  scattered.points.pop_back();
  EXPECT_TRUE(std::isnan(overlap_number_at(scattered, 200, 1)));
  std::string const drawn = processing_window_figure(scattered, "window.csv");
  EXPECT_EQ(occurrences(drawn, "<image"), 0U);
  EXPECT_EQ(occurrences(drawn, "<circle"), 8U);
  EXPECT_EQ(occurrences(processing_window_figure(window(), "window.csv"), "<image"), 1U);
  scattered.points.clear();
  EXPECT_EQ(processing_window_figure(scattered, "window.csv"), "");
}

TEST(ProcessingWindow, LinesOfEnergyDensityPassWhereTheirNumberSays) {
  // The frame, from two circles: 100 W at 500 mm/s and 300 W at 2000 mm/s.
  std::string const drawn = processing_window_figure(window(), "window.csv");
  std::regex const circle("cx=\"([0-9.]+)\" cy=\"([0-9.]+)\" r=\"4.5\"[^>]*><title>([0-9.]+) W, ([0-9.]+) mm/s");
  double x[2] = {}, y[2] = {};
  for (std::sregex_iterator it(drawn.begin(), drawn.end(), circle), end; it != end; ++it) {
    if ((*it)[3] == "100" && (*it)[4] == "500") x[0] = std::stod((*it)[1]), y[0] = std::stod((*it)[2]);
    if ((*it)[3] == "300" && (*it)[4] == "2000") x[1] = std::stod((*it)[1]), y[1] = std::stod((*it)[2]);
  }
  auto const speed = [&](double px) { return 500 + 1500 * (px - x[0]) / (x[1] - x[0]); };
  auto const power = [&](double py) { return 100 + 200 * (py - y[0]) / (y[1] - y[0]); };
  std::regex const isoline(
      "stroke=\"#1b2530\" stroke-dasharray=\"5 4\"/><text x=\"([0-9.]+)\" y=\"([0-9.]+)\" "
      "text-anchor=\"(middle|start)\" class=\"legend\">([0-9.]+)</text>");
  int lines = 0;
  for (std::sregex_iterator it(drawn.begin(), drawn.end(), isoline), end; it != end; ++it, ++lines) {
    bool const top = (*it)[3] == "middle";
    double const v = speed(std::stod((*it)[1]) - (top ? 0 : 5)), P = power(std::stod((*it)[2]) + (top ? 5 : -4));
    EXPECT_NEAR(P / (1e-3 * v * 100e-6 * 40e-6) * 1e-9, std::stod((*it)[4]), 0.01 * std::stod((*it)[4]));
  }
  EXPECT_GE(lines, 3);
}

TEST(ProcessingWindow, NumbersBesideItAreThoseOfTheOverlap) {
  std::string const csv = processing_window_csv(window());
  EXPECT_EQ(std::ranges::count(csv, '\n'), 10);
  // 300 W at 2 m/s: 140 um wide, 60 um deep; Q = (100/140)^2 + (40/60)^2.
  EXPECT_NE(csv.find("300,2000,37.5,140,60,0.954649,1\n"), std::string::npos) << csv;
}

}  // namespace
}  // namespace layerloop::coupling
