// Observables of a spread layer against closed forms.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/random.hpp"
#include "dem/coordination.hpp"
#include "dem/disc_union.hpp"
#include "dem/grain_sizes.hpp"
#include "dem/heap_angle.hpp"
#include "dem/layer_metrics.hpp"
#include "dem/reservoir.hpp"
#include "support.hpp"

namespace layerloop::dem {
namespace {
using namespace test;
using std::numbers::pi;
constexpr double everywhere = 100;

double union_area(std::vector<Disc> const& discs, double period = 1000) {
  return area_between(rim_of_union(discs, period), -everywhere, everywhere);
}

/// Area that two discs share at distance d.
double lens(double r, double s, double d) {
  double const a = (d * d + r * r - s * s) / (2 * d), b = d - a;
  return r * r * std::acos(a / r) - a * std::sqrt(r * r - a * a) + s * s * std::acos(b / s) -
         b * std::sqrt(s * s - b * b);
}

TEST(DiscUnion, OfOneDisc) {
  EXPECT_NEAR(union_area({{0.3, 0.7, 1.5}}), pi * 2.25, 1e-13);
  EXPECT_EQ(union_area({}), 0);
}

TEST(DiscUnion, OfTwoDiscsIsTheirSumLessTheLens) {
  for (double const d : {0.31, 0.9, 1.2, 1.69}) {
    double const r = 1, s = 0.7, expected = pi * (r * r + s * s) - lens(r, s, d);
    for (double const turn : {0.0, 0.5, 2.0, 4.0}) {
      double const area = union_area({{0.1, 0.2, r}, {0.1 + d * std::cos(turn), 0.2 + d * std::sin(turn), s}});
      EXPECT_NEAR(area, expected, 1e-12) << d << ' ' << turn;
    }
  }
}

TEST(DiscUnion, DiscsApartInsideOneAnotherAndAlike) {
  EXPECT_NEAR(union_area({{0, 0, 1}, {5, 0, 2}}), 5 * pi, 1e-12);
  EXPECT_NEAR(union_area({{0, 0, 2}, {0.5, 0.2, 0.7}}), 4 * pi, 1e-12);
  EXPECT_NEAR(union_area({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}), pi, 1e-12);
}

TEST(DiscUnion, OfThreeDiscsOnATriangle) {
  // Unit discs on an equilateral triangle of side 1: three discs, less three lenses, plus the Reuleaux triangle.
  double const reuleaux = 0.5 * (pi - std::sqrt(3.0));
  double const expected = 3 * pi - 3 * lens(1, 1, 1) + reuleaux;
  EXPECT_NEAR(union_area({{0, 0, 1}, {1, 0, 1}, {0.5, std::sqrt(0.75), 1}}), expected, 1e-12);
}

TEST(DiscUnion, RingLeavesItsHole) {
  // Six unit discs on a circle of radius 2 touch one another: nothing overlaps, and the hole counts as bare.
  std::vector<Disc> ring;
  for (int k = 0; k < 6; ++k) ring.push_back({2 * std::cos(k * pi / 3), 2 * std::sin(k * pi / 3), 1});
  EXPECT_NEAR(union_area(ring), 6 * pi, 1e-9);
}

TEST(DiscUnion, HexagonalCoverFillsThePeriodicStrip) {
  // Discs of radius a / sqrt(3) on a hexagonal lattice of pitch a just cover the plane: three meet at each corner.
  double const a = 1, radius = a / std::sqrt(3.0) * (1 + 1e-9);
  std::vector<Disc> discs;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 4; ++j) discs.push_back({i * a * std::sqrt(0.75), (j + 0.5 * (i % 2)) * a, radius});
  double const low = 2, high = 7;
  EXPECT_NEAR(area_between(rim_of_union(discs, 4 * a), low, high), (high - low) * 4 * a, 1e-9);
}

TEST(DiscUnion, PeriodicDiscsMeetTheirOwnImages) {
  // A disc of radius 1 on a period of 1.6 overlaps itself: pi less one lens at distance 1.6 for each period.
  EXPECT_NEAR(union_area({{0, 0.3, 1}}, 1.6), pi - lens(1, 1, 1.6), 1e-12);
  // Across the seam as inside.
  EXPECT_NEAR(union_area({{0, 0.1, 0.5}, {0, 9.8, 0.5}}, 10), union_area({{0, 5.0, 0.5}, {0, 4.7, 0.5}}, 10), 1e-12);
}

TEST(DiscUnion, StripsAddUp) {
  std::vector<Disc> discs;
  for (std::uint64_t i = 0; i < 60; ++i) {
    auto const u = uniform4(1, RandomStream::grain_position, i);
    discs.push_back({10 * u[0], 4 * u[1], 0.2 + 0.5 * u[2]});
  }
  std::vector<RimArc> const rim = rim_of_union(discs, 4);
  double sum = 0;
  for (int b = -2; b < 12; ++b) sum += area_between(rim, b, b + 1);
  EXPECT_NEAR(sum, area_between(rim, -everywhere, everywhere), 1e-11);
  // Half a disc, cut through its middle.
  EXPECT_NEAR(area_between(rim_of_union({{3, 0, 1}}, 4), 3, 9), pi / 2, 1e-13);
}

TEST(DiscUnion, AgreesWithMonteCarlo) {
  std::vector<Disc> discs;
  double const width = 3, length = 8;
  for (std::uint64_t i = 0; i < 50; ++i) {
    auto const u = uniform4(2, RandomStream::grain_position, i);
    discs.push_back({length * u[0], width * u[1], 0.1 + 0.5 * u[2]});
  }
  double const area = area_between(rim_of_union(discs, width), 1, 7);
  constexpr int points = 200000;
  int hits = 0;
  for (std::uint64_t i = 0; i < points; ++i) {
    auto const u = uniform4(3, RandomStream::grain_size, i);
    double const x = 1 + 6 * u[0], y = width * u[1];
    hits += std::ranges::any_of(
        discs, [&](Disc const& d) { return std::hypot(x - d.x, std::remainder(y - d.y, width)) < d.radius; });
  }
  double const share = static_cast<double>(hits) / points, box = 6 * width;
  EXPECT_NEAR(area, share * box, 4 * box * std::sqrt(share * (1 - share) / points));
}

TEST(Coordination, OfASimpleCubicLattice) {
  // 4 x 4 x 4 touching grains, periodic along y: 6 contacts inside, fewer at the faces of x and z.
  PowderBed bed;
  double const d = 20e-6;
  std::int64_t id = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) bed.add(id++, Vec3(i * d, j * d, k * d) * (1 - 1e-9), d / 2, 0);
  std::vector<std::int32_t> const contacts = touching_grains(bed, 4 * d * (1 - 1e-9));
  std::array<int, 7> count{};
  for (std::int32_t const c : contacts) ++count[static_cast<std::size_t>(c)];
  EXPECT_EQ(count[4], 16);  // edges of the x-z square: 2 + 2 along y
  EXPECT_EQ(count[5], 32);
  EXPECT_EQ(count[6], 16);
}

TEST(Sizes, QuantilesAndMeansOfAKnownMixture) {
  // 8 grains of diameter 1 and one of 2: equal volumes.
  std::vector<double> radii(8, 0.5);
  radii.push_back(1);
  EXPECT_EQ(diameter_quantile(radii, 0.5, Weight::number), 1);
  EXPECT_EQ(diameter_quantile(radii, 0.9, Weight::number), 2);
  EXPECT_EQ(diameter_quantile(radii, 0.49, Weight::volume), 1);
  EXPECT_EQ(diameter_quantile(radii, 0.51, Weight::volume), 2);
  EXPECT_DOUBLE_EQ(mean_diameter(radii, 1, 0), 10.0 / 9);
  EXPECT_DOUBLE_EQ(mean_diameter(radii, 3, 2), 16.0 / 12);
  EXPECT_DOUBLE_EQ(mean_diameter(radii, 4, 3), 24.0 / 16);
  EXPECT_TRUE(std::isnan(mean_diameter({}, 1, 0)));
  EXPECT_TRUE(std::isnan(diameter_quantile({}, 0.5, Weight::number)));
  // The thesis' powder: number mean 25.0, D[3,2] 29.9, D[4,3] 32.1 um.
  PowderSettings const thesis = small_case().powder;
  EXPECT_EQ(fed_diameter_quantile(thesis, 0.5, Weight::number), 28e-6);
  EXPECT_EQ(fed_diameter_quantile(thesis, 0.4, Weight::number), 21e-6);
  EXPECT_EQ(fed_diameter_quantile(thesis, 0.9, Weight::volume), 42e-6);
}

TEST(Lacey, IsNoughtApartAndOneForARandomMixtureOnAverage) {
  std::vector<std::size_t> const all(4, 50);
  std::vector<std::size_t> apart = all;
  apart[2] = apart[3] = 0;
  EXPECT_NEAR(lacey_index(apart, all), 0, 1e-15);
  EXPECT_TRUE(std::isnan(lacey_index(all, all)));
  // Mean over random mixtures of 30 % coarse, dealt without replacement as the estimate has it.
  double mean = 0, square = 0;
  constexpr int draws = 4000;
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    std::vector<std::size_t> coarse(4, 0);
    std::size_t left = 60;
    for (std::size_t i = 0; i < 200; ++i) {
      double const share = static_cast<double>(left) / static_cast<double>(200 - i);
      if (uniform4(4, RandomStream::grain_size, draw, static_cast<std::uint32_t>(i))[0] >= share) continue;
      ++coarse[i / 50];
      --left;
    }
    double const index = lacey_index(coarse, all);
    mean += index / draws;
    square += index * index / draws;
  }
  EXPECT_NEAR(mean, 1, 4 * std::sqrt((square - mean * mean) / draws));
}

/// Wedge of touching rows: the surface falls along x at the angle, from the blade at `front` down to `ground`.
PowderBed wedge(MachineSettings const& m, double front, double angle, double crest) {
  PowderBed bed;
  double const r = 3e-6, slope = std::tan(angle * pi / 180);
  std::int64_t id = 0;
  for (double x = front + r; x < front + crest / slope; x += r)
    for (double y = 0; y < m.width; y += r)
      bed.add(id++, {x, y, crest - slope * (x - front) - r / std::cos(angle * pi / 180)}, r, 0);
  return bed;
}

TEST(HeapAngle, OfAPlaneWedge) {
  MachineSettings m = small_case().machine;
  m.deposition_length = 2e-3;
  for (double const angle : {20.0, 30.0, 45.0})
    EXPECT_NEAR(heap_angle(wedge(m, 100e-6, angle, 250e-6), m, 100e-6, 0), angle, 0.5) << angle;
  EXPECT_TRUE(std::isnan(heap_angle({}, m, 100e-6, 0)));
}

TEST(HeapAngle, WatchTellsAccumulationFromDeposition) {
  MachineSettings m = small_case().machine;
  m.accumulation_length = 1e-3;
  m.deposition_length = 2e-3;
  HeapWatch watch(m, 0);
  double const in_accumulation = 0.5e-3, in_deposition = m.deposition_begin() + 0.5e-3;
  watch(wedge(m, 0.1e-3, 60, 250e-6), 0.1e-3);  // too early
  watch(wedge(m, in_accumulation, 30, 250e-6), in_accumulation);
  watch(wedge(m, in_accumulation, 34, 250e-6), in_accumulation);
  watch(wedge(m, in_deposition, 20, 250e-6), in_deposition);
  EXPECT_NEAR(watch.accumulation().mean, 32, 0.5);
  EXPECT_NEAR(watch.accumulation().standard_error, 2, 0.2);
  EXPECT_NEAR(watch.deposition().mean, 20, 0.5);
  EXPECT_TRUE(std::isnan(watch.deposition().standard_error));
}

TEST(Reservoir, OfASquareLattice) {
  Case c = small_case();
  MachineSettings& m = c.machine;
  m.accumulation_length = 400e-6;
  m.accumulation_depth = 100e-6;
  m.width = 100e-6;
  double const R = 10e-6;
  PowderBed bed;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 5; ++j) bed.add(5 * i + j, {(i + 0.5) * 2 * R, (j + 0.5) * 2 * R, -100e-6 + R}, R, 0);
  bed.add(1000, {m.deposition_begin() + 50e-6, 50e-6, 0}, 20e-6, 0);  // not in the reservoir
  Reservoir const reservoir = measure_reservoir(bed, m);
  double const height = pi / 4 * 5.0 / 3.0 * R;  // bare floor counts as 0
  EXPECT_NEAR(reservoir.height, height, 0.03 * height);
  EXPECT_NEAR(reservoir.density, pi / 6 * 2 * R / height, 0.03 * 0.8);
  EXPECT_NEAR(reservoir.mean_diameter, 2 * R, 1e-18);
  EXPECT_NEAR(reservoir.volume, 100 * 4.0 / 3 * pi * R * R * R, 1e-20);
}

TEST(PixelScatter, IsTheSizeOfTheErrorOfThickness) {
  // One row of three hemispheres in every bin, anywhere in it: mean height 3 pi R^2 / area * 5/3 R.
  Case c = small_case();
  double const R = 20e-6, pitch = 60e-6;
  int const rows = 40;
  c.machine.deposition_length = rows * pitch;
  c.machine.width = 120e-6;
  c.run.bins = rows;
  MachineSettings const& m = c.machine;
  double const relt = 3 * pi * R * R / (pitch * m.width) * 5.0 / 3.0 * R;
  PowderBed bed;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < 3; ++j) {
      auto const shift = uniform4(8, RandomStream::grain_position, static_cast<std::uint64_t>(3 * i + j));
      double const x = m.deposition_begin() + i * pitch + R + shift[0] * (pitch - 2 * R);
      bed.add(3 * i + j,
              {x, (j + uniform4(9, RandomStream::grain_position, static_cast<std::uint64_t>(i))[0]) * 2 * R,
               R - m.layer_thickness},
              R, 0);
    }
  }
  for (std::int32_t const pixels : {24, 60}) {
    double const h = m.width / pixels;
    auto const nx = static_cast<std::int32_t>(std::lround(m.deposition_length / h));
    HeightMap const plate{m.deposition_begin(),
                          0,
                          h,
                          nx,
                          pixels,
                          std::vector<double>(static_cast<std::size_t>(nx * pixels), -m.layer_thickness)};
    LayerMetrics const metrics = measure_layer(bed, plate, layer_base({}, plate, c), c);
    double error = 0, claimed = 0;
    for (LayerBin const& bin : metrics.bins) {
      double const u = bin.real_effective_thickness_u_num, e = bin.real_effective_thickness - relt;
      error += e * e / rows;
      claimed += u * u / rows;
      EXPECT_NEAR(bin.volume_fraction_real_u_num / bin.volume_fraction_real, u / bin.real_effective_thickness, 1e-12);
    }
    EXPECT_LT(std::sqrt(error), 2 * std::sqrt(claimed)) << pixels;
    EXPECT_GT(std::sqrt(error), 0.2 * std::sqrt(claimed)) << pixels;
    EXPECT_LT(std::sqrt(claimed), 0.03 * relt) << pixels;
  }
}

// What eq. 14 of the thesis and its kin say of layers in which nothing moves between the strokes. The surface is put
// there by hand: each stroke fills the same share of the void.
class Layers : public testing::Test {
 protected:
  /// Metrics of layers of which each fills `filled` of the void and then consolidates to `packing` of its thickness.
  std::vector<LayerMetrics> build(int layers, double filled, double packing) const {
    Case c = small_case();
    MachineSettings const& m = c.machine;
    HeightMap surface{m.deposition_begin(), 0, 10e-6, 20, 10, std::vector<double>(200, 0.0)};
    std::vector<LayerMetrics> all;
    for (int n = 0; n < layers; ++n) {
      for (double& z : surface.values) z -= m.layer_thickness;
      LayerBase const before = layer_base({}, surface, c);
      HeightMap after = surface;
      for (double& z : after.values) z += filled * (m.blade_clearance - z);
      all.push_back(measure_layer({}, after, before, c));
      for (std::size_t p = 0; p < after.values.size(); ++p)
        surface.values[p] += packing * (after.values[p] - surface.values[p]);
    }
    return all;
  }
  double const nominal_ = small_case().machine.layer_thickness;
};

TEST_F(Layers, VoidAndThicknessObeyEquationFourteen) {
  std::vector<LayerMetrics> const all = build(8, 0.6, 1);
  EXPECT_NEAR(all[0].void_layer, nominal_, 1e-18);
  for (std::size_t n = 0; n < all.size(); ++n) {
    EXPECT_NEAR(all[n].real_effective_thickness, all[n].void_layer - nominal_ + all[n].effective_thickness, 1e-18);
    if (n > 0) {
      EXPECT_NEAR(all[n].void_layer, 2 * nominal_ - all[n - 1].effective_thickness, 1e-18);
      EXPECT_NEAR(all[n].void_layer, nominal_ + all[n - 1].void_layer - all[n - 1].real_effective_thickness, 1e-18);
    }
  }
}

TEST_F(Layers, FreePowderTendsToTheNominalThickness) {
  double const f = 0.6;
  std::vector<LayerMetrics> const all = build(40, f, 1);
  EXPECT_NEAR(all.back().real_effective_thickness, nominal_, 1e-12 * nominal_);
  EXPECT_NEAR(all.back().void_layer, nominal_ / f, 1e-12 * nominal_);
  // The distance to the steady state shrinks by 1 - f a layer.
  for (std::size_t n = 1; n < 10; ++n) {
    double const was = nominal_ - all[n - 1].real_effective_thickness, is = nominal_ - all[n].real_effective_thickness;
    EXPECT_NEAR(is / was, 1 - f, 1e-9);
  }
}

TEST_F(Layers, FusedPowderTendsToTheNominalThicknessOverItsPacking) {
  for (double const p : {0.45, 0.55, 0.62}) {
    std::vector<LayerMetrics> const all = build(80, 0.9, p);
    EXPECT_NEAR(all.back().real_effective_thickness, nominal_ / p, 1e-9 * nominal_);
  }
}

TEST(Definitions, CoverEveryQuantity) {
  std::map<std::string, std::string> const words = definitions();
  for (char const* name : {"roughness_sq", "roughness_sz", "d10_number", "mean_diameter", "sauter_diameter",
                           "mass_diameter", "coordination_number", "rattler_fraction", "segregation_index",
                           "lacey_index", "heap_angle_accumulation", "heap_angle_deposition", "settled_height",
                           "settled_density", "reservoir_mean_diameter", "reservoir_mass_ratio", "blade_force"})
    EXPECT_GT(words.at(name).size(), 20U) << name;
}

}  // namespace
}  // namespace layerloop::dem
