#include "coupling/run_record.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/random.hpp"
#include "sample_run.hpp"

namespace layerloop::coupling {
namespace {

using nlohmann::json;

RunRecord through_text(RunRecord const& record) { return json::parse(json(record).dump()).get<RunRecord>(); }

/// Doubles of every size and sign, from random bits, and those that printing is apt to spoil.
std::vector<double> awkward_numbers(std::size_t count) {
  using Limits = std::numeric_limits<double>;
  std::vector<double> values{0.0,
                             -0.0,
                             0.1,
                             1.0 / 3.0,
                             Limits::denorm_min(),
                             -Limits::min(),
                             Limits::max(),
                             5e-324 * 3,
                             std::nextafter(1.0, 2.0),
                             1e23,
                             9007199254740993.0,
                             Limits::infinity(),
                             -Limits::infinity()};
  for (std::uint64_t i = 0; values.size() < count; ++i) {
    auto const u = uniform4(7, RandomStream::grain_size, i);
    double const value = std::bit_cast<double>(static_cast<std::uint64_t>(u[0] * 0x1p32) << 32 |
                                               static_cast<std::uint64_t>(u[1] * 0x1p32));
    if (!std::isnan(value)) values.push_back(value);
  }
  return values;
}

bool same_bits(std::vector<double> const& a, std::vector<double> const& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
           return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
         });
}

TEST(RunRecord, every_double_comes_back_bit_for_bit) {
  RunRecord record;
  record.layers.resize(1);
  record.layers[0].metrics.surface.values = awkward_numbers(100'000);
  EXPECT_TRUE(
      same_bits(through_text(record).layers[0].metrics.surface.values, record.layers[0].metrics.surface.values));
}

TEST(RunRecord, every_float_comes_back_bit_for_bit) {
  RunRecord record;
  record.layers.resize(1);
  MeltSection section;
  for (double const value : awkward_numbers(20'000)) section.peak_temperature.push_back(static_cast<float>(value));
  section.peak_temperature.push_back(std::numeric_limits<float>::denorm_min());
  section.state = {0, 1, 2, 255};
  record.layers[0].sections = {section};
  MeltSection const back = through_text(record).layers[0].sections.at(0);
  EXPECT_EQ(back.peak_temperature, section.peak_temperature);
  EXPECT_EQ(back.state, section.state);
}

TEST(RunRecord, not_a_number_stays_one) {
  RunRecord record;
  record.ledger.heat_in = std::nan("");
  EXPECT_TRUE(std::isnan(through_text(record).ledger.heat_in));
}

TEST(RunRecord, every_member_survives) {
  // Each member set to a value of its own, so that a swapped or forgotten one shows: text of the copy equals the text.
  SampleRun run = sample_run();
  Ledger& l = run.record.ledger;
  double mark = 0.5;
  for (double* member :
       {&l.mass_fed, &l.mass_bed, &l.mass_overflow, &l.mass_melted, &l.mass_evaporated, &l.mass_lost,
        &l.mass_relative_error, &l.power_incident, &l.power_absorbed, &l.power_escaped, &l.power_attenuated,
        &l.power_residual, &l.ray_energy_relative_error, &l.power_rescaling, &l.heat_in, &l.heat_stored, &l.heat_out,
        &l.heat_energy_relative_error, &l.surface_height_correction})
    *member = mark += 1;
  l.particles_trapped = 99;
  run.record.layers[1].pictures = {{"a.png", "caption \"quoted\" ü"}};
  RunRecord const back = through_text(run.record);
  EXPECT_EQ(json(back), json(run.record));
  EXPECT_EQ(back.ledger.mass_fed, 1.5);
  EXPECT_EQ(back.ledger.surface_height_correction, mark);
  EXPECT_EQ(back.ledger.particles_trapped, 99);
  EXPECT_EQ(back.layers[1].pictures, run.record.layers[1].pictures);
  EXPECT_EQ(back.layers[0].blade_note, run.record.layers[0].blade_note);
  EXPECT_EQ(back.layers[0].metrics.bins[1].x, 190e-6);
  EXPECT_EQ(back.wall_time.total, 7);
}

TEST(RunRecord, no_member_is_forgotten) {
  // These structures hold eight-byte numbers only, so their size counts their members.
  json const all = sample_run().record;
  json const& layer = all["layers"][0];
  EXPECT_EQ(all["ledger"].size(), sizeof(Ledger) / 8);
  EXPECT_EQ(all["wall_time"].size(), sizeof(WallTime) / 8);
  EXPECT_EQ(layer["consolidation"].size(), sizeof(Consolidation) / 8);
  EXPECT_EQ(layer["pool"].size(), sizeof(PoolSize) / 8);
  EXPECT_EQ(layer["metrics"]["bins"][0].size(), sizeof(LayerBin) / 8);
  EXPECT_EQ(layer["stroke"].size(), sizeof(StrokeMetrics) / 8);
}

TEST(RunRecord, damaged_text_is_named) {
  json damaged = sample_run().record;
  damaged["ledger"].erase("mass_bed");
  EXPECT_THROW(damaged.get<RunRecord>(), FileError);
  EXPECT_THROW(json::parse("{\"layers\": 3}").get<RunRecord>(), FileError);
}

TEST(Summary, holds_the_keys_that_scripts_rely_on) {
  SampleRun const run = sample_run();
  json const all = summary(run.checked, run.record, run.extras);
  ASSERT_EQ(all.at("layers").size(), 2u);
  json const& layer = all["layers"][0];
  for (char const* key : {"effective_thickness", "real_effective_thickness", "void_layer", "volume_fraction_nominal",
                          "volume_fraction_real", "surface_coverage", "roughness_sa", "d10", "d50", "d90",
                          "absorptivity", "melted_mass", "part_relative_density"})
    EXPECT_TRUE(layer.at(key).is_number()) << key;
  for (char const* key : {"width", "depth", "length", "width_u_num", "depth_u_num", "length_u_num"})
    EXPECT_TRUE(layer.at("pool").at(key).is_number()) << key;
  EXPECT_EQ(layer["absorptivity_u_num"], 0.004);
  EXPECT_EQ(layer["pool"]["depth_u_num"], 3e-6);
  EXPECT_DOUBLE_EQ(layer["melted_mass_u_num"].get<double>(), 0.5e-10);
  EXPECT_FALSE(layer.contains("surface")) << "maps do not belong into the summary";
  for (char const* key : {"dem", "rays", "heat", "mesh", "io", "total"})
    EXPECT_TRUE(all.at("wall_time").at(key).is_number()) << key;
  for (char const* key :
       {"mass_fed", "particles_lost", "power_residual", "heat_energy_relative_error", "surface_height_correction"})
    EXPECT_TRUE(all.at("ledger").at(key).is_number()) << key;
  EXPECT_FALSE(all["ledger"].contains("energy_wall_work")) << "it was not booked";
  Case booked = run.checked;
  booked.run.energy_ledger = true;
  EXPECT_TRUE(summary(booked, run.record, run.extras)["ledger"].at("energy_relative_error_dem").is_number());
  EXPECT_EQ(all["seed"], 42);
  EXPECT_EQ(all["version"], "1.2.3");
  EXPECT_EQ(all["case"], run.checked.name);
  EXPECT_EQ(all["definitions"]["effective_thickness"], run.extras.definitions.at("effective_thickness"));
}

TEST(Summary, leaves_the_laser_out_where_a_zone_was_frozen) {
  SampleRun run = sample_run();
  run.checked.machine.frozen_zone = {120e-6, 180e-6};
  json const layer = summary(run.checked, run.record, run.extras)["layers"][0];
  EXPECT_FALSE(layer.contains("absorptivity"));
  EXPECT_FALSE(layer.contains("pool"));
  EXPECT_TRUE(layer.contains("effective_thickness"));
}

TEST(Summary, OfSpreadPowderHasStrokeAndBinsAtTheTop) {
  SampleRun run = sample_run();
  run.checked.process = Process::spreading;
  run.record.layers[1].stroke.heap_angle_accumulation = 31;
  run.record.layers[1].stroke.heap_angle_deposition = std::nan("");
  json const all = summary(run.checked, run.record, run.extras);
  EXPECT_EQ(all["verb"], "spread");
  EXPECT_EQ(all["heap_angle_accumulation"], 31);
  EXPECT_TRUE(all["heap_angle_deposition"].is_null()) << "nothing was there to measure";
  for (char const* key : {"reservoir_mean_diameter", "reservoir_mass_ratio", "settled_height", "settled_density"})
    EXPECT_TRUE(all.at(key).is_number()) << key;
  ASSERT_EQ(all["bins"].size(), 2u);
  for (char const* key : {"x", "relative_density", "effective_thickness", "mean_diameter"})
    EXPECT_TRUE(all["bins"][0].at(key).is_number()) << key;
  EXPECT_TRUE(all["bins"][1]["relative_density"].is_null());
  EXPECT_FALSE(all["layers"][0].contains("absorptivity"));
  EXPECT_FALSE(all["layers"][0].contains("part_relative_density"));
}

}  // namespace
}  // namespace layerloop::coupling
