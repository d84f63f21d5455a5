#include "coupling/replicate_summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace layerloop::coupling {
namespace {

using nlohmann::json;

json run(double thickness, json diameter, std::int64_t fed) {
  return {{"verb", "spread"},
          {"seed", 3},
          {"layers",
           {{{"layer", 1},
             {"effective_thickness", thickness},
             {"heap_angle_accumulation", 30},
             {"heap_angle_accumulation_u_num", thickness},
             {"bins", {{{"x", 1e-4}, {"mean_diameter", diameter}}}}}}},
          {"ledger", {{"particles_fed", fed}, {"mass_fed", 0.5}, {"mass_relative_error", thickness}}},
          {"wall_time", {{"dem", 2.0}}}};
}

TEST(ReplicateSummary, GivesMeansIntervalsAndCounts) {
  json const all = summary_over_replicates({run(1, 20e-6, 100), run(2, nullptr, 100), run(6, 22e-6, 101)});
  json const& layer = all.at("layers").at(0);
  EXPECT_DOUBLE_EQ(layer["effective_thickness"], 3);
  EXPECT_NEAR(layer["effective_thickness_u_bed"], 4.30265 * std::sqrt(7.0 / 3), 1e-5);
  EXPECT_EQ(layer["effective_thickness_n"], 3);
  EXPECT_EQ(layer["heap_angle_accumulation_u_bed"], 0);
  EXPECT_EQ(layer["heap_angle_accumulation_u_num"], 3);
  EXPECT_FALSE(layer.contains("heap_angle_accumulation_u_num_u_bed"));
  EXPECT_EQ(layer["layer"], 1);
  EXPECT_FALSE(layer.contains("layer_n"));
  json const& bin = layer["bins"][0];
  EXPECT_EQ(bin["x"], 1e-4);
  EXPECT_DOUBLE_EQ(bin["mean_diameter"], 21e-6);
  EXPECT_EQ(bin["mean_diameter_n"], 2);
  EXPECT_NEAR(bin["mean_diameter_u_bed"], 12.7062 * 1e-6, 1e-10);
  EXPECT_EQ(all["verb"], "spread");
}

TEST(ReplicateSummary, LedgersAddUpAndTheWorstErrorStands) {
  json const all = summary_over_replicates({run(1, 20e-6, 100), run(2, 20e-6, 101)});
  EXPECT_EQ(all["ledger"]["particles_fed"], 201);
  EXPECT_DOUBLE_EQ(all["ledger"]["mass_fed"], 1);
  EXPECT_DOUBLE_EQ(all["ledger"]["mass_relative_error"], 2);
  EXPECT_DOUBLE_EQ(all["wall_time"]["dem"], 4);
}

}  // namespace
}  // namespace layerloop::coupling
