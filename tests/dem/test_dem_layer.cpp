// Feed, stroke, plate and the measures of a layer.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "dem/dosing.hpp"
#include "dem/layer_metrics.hpp"
#include "dem/machine_rig.hpp"
#include "dem/recoater.hpp"
#include "support.hpp"

namespace layerloop::dem {
namespace {
using namespace test;
using std::numbers::pi;

TEST(Sizes, MatchFractionsByNumber) {
  Case const c = small_case();
  constexpr int n = 200000;
  std::map<double, int> count;
  for (int id = 0; id < n; ++id) ++count[2 * draw_radius(c, id)];
  ASSERT_EQ(count.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    double const p = c.powder.fractions[k], sigma = std::sqrt(p * (1 - p) / n);
    EXPECT_NEAR(double(count[c.powder.diameters[k]]) / n, p, 4 * sigma);
  }
}

TEST(Sizes, MatchFractionsByVolume) {
  Case c = small_case();
  c.powder.basis = SizeBasis::volume;
  std::map<double, double> volume;
  double total = 0;
  for (int id = 0; id < 200000; ++id) {
    double const d = 2 * draw_radius(c, id);
    volume[d] += d * d * d;
    total += d * d * d;
  }
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(volume[c.powder.diameters[k]] / total, c.powder.fractions[k], 0.01);
}

double overlap(PowderBed const& bed, double period, std::size_t i, std::size_t j) {
  Vec3 apart = bed.position(i) - bed.position(j);
  apart.y() = std::remainder(apart.y(), period);
  return bed.radius[i] + bed.radius[j] - apart.norm();
}

TEST(Cloud, HasNoOverlapAndDependsOnIdsOnly) {
  Case const c = small_case();
  PowderBed bed, again;
  add_cloud(bed, c, 400, 10);
  add_cloud(again, c, 400, 10);
  EXPECT_EQ(bed.x, again.x);
  for (std::size_t i = 0; i < bed.size(); ++i) {
    EXPECT_GE(bed.x[i], bed.radius[i]);
    EXPECT_LE(bed.x[i], c.machine.accumulation_length - bed.radius[i]);
    EXPECT_GE(bed.z[i] - bed.radius[i], -c.machine.accumulation_depth - 1e-12);
    for (std::size_t j = 0; j < i; ++j) ASSERT_LE(overlap(bed, c.machine.width, i, j), 0);
  }
}

/// A whole layer on the small machine, made once.
struct SmallLayer {
  Case checked = small_case();
  TriangleSurface plate = plate_of(checked);
  PowderBed dosed, spread_bed;
  SpreadOutcome outcome;
  SmallLayer() {
    dose(dosed, checked, plate, checked.powder.particles, 0, alone(), false);
    spread_bed = dosed;
    outcome = spread(spread_bed, checked, plate, alone(), false);
  }
};

SmallLayer const& small_layer() {
  static SmallLayer const layer;
  return layer;
}

TEST(Stroke, FeedSettlesInTheAccumulationZone) {
  SmallLayer const& layer = small_layer();
  MachineSettings const& m = layer.checked.machine;
  ASSERT_EQ(layer.dosed.size(), 200U);
  double lowest = 1, volume = 0;
  for (std::size_t i = 0; i < layer.dosed.size(); ++i) {
    EXPECT_GT(layer.dosed.x[i], 0);
    EXPECT_LT(layer.dosed.x[i], m.accumulation_length);
    lowest = std::min(lowest, layer.dosed.z[i] - layer.dosed.radius[i]);
    volume += layer.dosed.z[i] + layer.dosed.radius[i] < 0 ? layer.dosed.volume(i) : 0.0;
  }
  EXPECT_NEAR(lowest, -m.accumulation_depth, 0.1e-6);
}

TEST(Stroke, EveryGrainIsInTheBedOrInTheOverflow) {
  SmallLayer const& layer = small_layer();
  EXPECT_EQ(static_cast<std::int64_t>(layer.spread_bed.size()) + layer.outcome.overflow_grains, 200);
  double const fed = total_volume(layer.dosed);
  EXPECT_NEAR(total_volume(layer.spread_bed) + layer.outcome.overflow_volume, fed, 1e-15 * fed);
}

TEST(Stroke, BladeLeavesNothingAboveItsEdgeAndGrainsOnThePlate) {
  SmallLayer const& layer = small_layer();
  MachineSettings const& m = layer.checked.machine;
  std::int64_t on_plate = 0;
  for (std::size_t i = 0; i < layer.spread_bed.size(); ++i) {
    bool const in_zone = layer.spread_bed.x[i] > m.deposition_begin();
    on_plate += in_zone;
    if (in_zone) {
      EXPECT_LT(layer.spread_bed.z[i], 21e-6);  // a grain that springs up behind the blade comes to lie on others
      EXPECT_GT(layer.spread_bed.z[i] - layer.spread_bed.radius[i], -m.layer_thickness - 0.1e-6);
    }
  }
  EXPECT_GT(on_plate, 5);
  EXPECT_LT(layer.outcome.largest_overlap, 0.03);
  EXPECT_GT(layer.outcome.blade_force, 0);
  EXPECT_NEAR(layer.outcome.steps_per_contact, 30 * std::pow(2, 0.2), 1);  // about 30 at 6.5 um and 0.1 m/s
}

TEST(Plate, LoweringMakesNoOverlap) {
  SmallLayer const& layer = small_layer();
  Case const& c = layer.checked;
  PowderBed const& before = layer.spread_bed;
  PowderBed after = before;
  lower_plate(after, c);
  std::int64_t moved = 0;
  Rig const rig = machine_rig(c, {}, before, Tools::none);
  for (std::size_t i = 0; i < after.size(); ++i) {
    bool const moves = after.z[i] != before.z[i];
    moved += moves;
    if (moves) {
      EXPECT_NEAR(before.z[i] - after.z[i], c.machine.layer_thickness, 1e-18);
      EXPECT_GT(after.x[i], c.machine.deposition_begin());
    }
    for (std::size_t j = 0; j < i; ++j) {
      double const allowed = std::max(0.0, overlap(before, c.machine.width, i, j));
      EXPECT_LE(overlap(after, c.machine.width, i, j), allowed + 1e-18);
    }
    for (RoundedBlock block : rig.walls.blocks) {
      block.z0 = -1;
      double const was = nearest(block, before.x[i], before.z[i]).distance - before.radius[i];
      double const is = nearest(block, after.x[i], after.z[i]).distance - after.radius[i];
      EXPECT_GE(is, std::min(0.0, was) - 1e-18) << block.name;
    }
  }
  EXPECT_GT(moved, 5);
  auto const went = [&](std::int64_t id) {
    auto const i = static_cast<std::size_t>(std::ranges::lower_bound(before.id, id) - before.id.begin());
    return after.z[i] != before.z[i];
  };
  for (ContactSpring const& s : after.contacts) {
    if (s.key_b >= 0) {
      EXPECT_EQ(went(s.key_a), went(s.key_b));
    } else {
      EXPECT_LT(wall_key_of(s.key_b), first_triangle_key);
    }
  }
}

TEST(Plate, GrainsThatOverhangAWallAndThoseBelowThemStay) {
  Case const c = small_case();
  MachineSettings const& m = c.machine;
  double const edge = m.deposition_begin(), middle = 0.5 * (edge + m.deposition_end()), z = -m.layer_thickness;
  PowderBed bed;
  bed.add(0, {edge + 4e-6, 50e-6, 0 + 9e-6}, 10e-6, 0);  // leans over the platform's edge
  bed.add(1, {edge + 16e-6, 50e-6, 25e-6}, 10e-6, 0);    // rests on it
  bed.add(2, {middle, 50e-6, z + 10e-6}, 10e-6, 0);      // free
  lower_plate(bed, c);
  EXPECT_EQ(bed.z[0], 9e-6);
  EXPECT_EQ(bed.z[1], 25e-6);
  EXPECT_DOUBLE_EQ(bed.z[2], 2 * z + 10e-6);
}

TEST(Metrics, OfASquareLatticeOfSpheres) {
  Case c = small_case();
  double const R = 20e-6;
  c.powder.diameters = {2 * R};
  c.powder.fractions = {1};
  c.machine.layer_thickness = 50e-6;
  c.machine.deposition_length = 600e-6;
  c.machine.width = 120e-6;
  MachineSettings const& m = c.machine;
  double const floor = -m.layer_thickness, x0 = m.deposition_begin();
  HeightMap solid{x0, 0, 0.5e-6, 1200, 240, std::vector<double>(1200 * 240, floor)};
  LayerBase const before = layer_base({}, solid, c);
  PowderBed bed;
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < 3; ++j) bed.add(3 * i + j, {x0 + (i + 0.5) * 2 * R, (j + 0.5) * 2 * R, floor + R}, R, 0);
  LayerMetrics const metrics = measure_layer(bed, solid, before, c);

  double const coverage = pi / 4, volume_over_area = 4.0 / 3.0 * pi * R * R * R / (4 * R * R);
  double const relt = coverage * 5.0 / 3.0 * R;  // mean top of a hemisphere: R + 2/3 R
  EXPECT_NEAR(metrics.surface_coverage, coverage, 1e-12);
  EXPECT_NEAR(metrics.real_effective_thickness, relt, 3e-3 * relt);
  EXPECT_NEAR(metrics.effective_thickness, relt, 3e-3 * relt);  // the plate is one layer below the blade
  EXPECT_NEAR(metrics.void_layer, m.layer_thickness, 1e-15);
  EXPECT_NEAR(metrics.volume_fraction_nominal, volume_over_area / m.layer_thickness, 1e-12);
  EXPECT_NEAR(metrics.volume_fraction_real, volume_over_area / relt, 3e-3);  // = 0.8 whatever the pitch
  EXPECT_NEAR(metrics.volume_fraction_real, 0.8, 3e-3);
  EXPECT_DOUBLE_EQ(metrics.d10, 2 * R);
  EXPECT_DOUBLE_EQ(metrics.d90, 2 * R);
  ASSERT_EQ(metrics.bins.size(), 15U);
  for (LayerBin const& bin : metrics.bins) {
    EXPECT_EQ(bin.grains, 3);
    EXPECT_NEAR(bin.volume_fraction_real, 0.8, 3e-3);
    EXPECT_DOUBLE_EQ(bin.mean_diameter, 2 * R);
  }
  // Sa: the bare share lies at 0, the covered share has heights R + sqrt(R^2 - r^2); integrated with a fine radial sum
  double const mean = relt;
  double deviation = (1 - coverage) * mean;
  constexpr int n = 100000;
  for (int k = 0; k < n; ++k) deviation += coverage / n * std::abs(R + R * std::sqrt(1 - (k + 0.5) / n) - mean);
  EXPECT_NEAR(metrics.roughness_sa, deviation, 5e-3 * deviation);
}

TEST(Metrics, SecondLayerCountsOnlyWhatIsNew) {
  Case c = small_case();
  c.powder.diameters = {20e-6};
  c.powder.fractions = {1};
  MachineSettings const& m = c.machine;
  HeightMap solid{m.deposition_begin(), 0, 0.5e-6, 400, 200, std::vector<double>(80000, -100e-6)};
  PowderBed bed;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 5; ++j)
      bed.add(5 * i + j, {m.deposition_begin() + (i + 0.5) * 20e-6, (j + 0.5) * 20e-6, -90e-6}, 10e-6, 0);
  LayerBase const before = layer_base(bed, solid, c);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 5; ++j)
      bed.add(100 + 5 * i + j, {m.deposition_begin() + (i + 0.5) * 20e-6, (j + 0.5) * 20e-6, -70e-6}, 10e-6, 0);
  LayerMetrics const metrics = measure_layer(bed, solid, before, c);
  EXPECT_NEAR(metrics.real_effective_thickness, pi / 4 * 20e-6, 5e-3 * 20e-6);  // covered places rise by a diameter
  EXPECT_NEAR(metrics.volume_fraction_nominal, pi / 6 * 20e-6 / m.layer_thickness, 1e-12);
  double const base_height = -100e-6 + pi / 4 * 5.0 / 3.0 * 10e-6;
  EXPECT_NEAR(metrics.void_layer, -base_height, 0.1e-6);
  EXPECT_EQ(metrics.bins[7].grains % 5, 0);
}

TEST(Metrics, EveryQuantityHasADefinition) {
  for (char const* name : {"effective_thickness", "real_effective_thickness", "void_layer", "volume_fraction_nominal",
                           "volume_fraction_real", "surface_coverage", "roughness_sa", "d10", "d50", "d90", "bins"})
    EXPECT_GT(definitions().at(name).size(), 10U) << name;
}

}  // namespace
}  // namespace layerloop::dem
