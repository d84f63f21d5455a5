// What the effects heat_accumulation, denudation and shrinkage hand from one layer to the next.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "coupling/effects/denudation.hpp"
#include "coupling/effects/heat_accumulation.hpp"
#include "coupling/effects/shrinkage.hpp"
#include "coupling/melt_columns.hpp"
#include "tests/coupling/solid_scenes.hpp"

namespace layerloop::coupling {
namespace {

Slab const steel{0.02, 15, 7.9e3 * 480};

/// Soon after the pulse the slab is a half space, and each reflection at its cold bottom (sign -1) and insulated top
/// adds an image: E / sqrt(pi k rho c t) (1 + 2 sum (-1)^m exp(-m^2 d^2 / (a t))).
TEST(HeatAccumulation, PulseAgreesWithItsImages) {
  double const energy = 9e5, a = steel.conductivity / steel.capacity, d = steel.thickness;
  for (double const time : {0.02, 1.0, 20.0, 100.0}) {
    double images = 1;
    for (int m = 1; m < 20; ++m) images += (m % 2 == 0 ? 2 : -2) * std::exp(-m * m * d * d / (a * time));
    double const exact = energy / std::sqrt(std::numbers::pi * steel.conductivity * steel.capacity * time) * images;
    EXPECT_NEAR(pulse_rise(steel, energy, time), exact, 1e-9 * energy / std::sqrt(steel.capacity)) << time;
    EXPECT_NEAR(pulse_rise(steel, energy, time) / exact, 1, 1e-6) << time;
  }
}

Case case_with(double layers, double layer_time, double energy) {
  Case checked = small_case();
  checked.material = built_in_materials().at("316L");
  checked.material.conductivity = {{300}, {15}};
  checked.material.specific_heat = {{300}, {480}};
  checked.material.density = 7.9e3;
  checked.heat.ambient_temperature = 300;
  checked.effects["heat_accumulation"] = {
      true,
      1,
      {{"layer_time", layer_time}, {"plate_thickness", 0.02}, {"earlier_layers", layers}, {"layer_energy", energy}}};
  return checked;
}

/// Many small pulses are a steady flux: in the end the rise is flux * thickness / conductivity.
TEST(HeatAccumulation, EndsAtTheSteadyState) {
  double const power = 4e4;  // [W/m^2]
  double const steady = power * 0.02 / 15;
  EXPECT_NEAR(start_temperature(case_with(80'000, 0.01, 0.01 * power), {}), 300 + steady, 0.01 * steady);
}

/// The same slab in 400 cells, stepped through 12 layers; the heat of a layer that has been computed counts like that
/// of one which the case names.
TEST(HeatAccumulation, AgreesWithASlabStepByStep) {
  double const energy = 9e5, layer_time = 8, d = 0.02, a = 15 / (7.9e3 * 480);
  int const cells = 400;
  double const h = d / cells, dt = 0.4 * h * h / a;
  auto const steps = static_cast<int>(std::ceil(layer_time / dt));
  std::vector<double> rise(cells, 0), old;
  for (int layer = 0; layer < 12; ++layer) {
    rise[0] += energy / (7.9e3 * 480 * h);
    for (int s = 0; s < steps; ++s) {
      old = rise;
      double const factor = a * layer_time / steps / (h * h);
      for (int i = 0; i < cells; ++i) {
        auto const at = static_cast<std::size_t>(i);
        double const above = i == 0 ? old[at] : old[at - 1], below = i == cells - 1 ? -old[at] : old[at + 1];
        rise[at] += factor * (above - 2 * old[at] + below);
      }
    }
  }
  EXPECT_NEAR(start_temperature(case_with(12, layer_time, energy), {}) - 300, rise[0], 2e-3 * rise[0]);
  std::vector<double> const computed(5, energy);
  EXPECT_NEAR(start_temperature(case_with(7, layer_time, energy), computed) - 300, rise[0], 2e-3 * rise[0]);
}

TEST(HeatAccumulation, NullStrengthAndFirstLayerChangeNoBit) {
  std::vector<double> const energy{9e5, 8e5};
  Case checked = case_with(0, 20, 0);
  EXPECT_EQ(start_temperature(checked, {}), 300);
  EXPECT_GT(start_temperature(checked, energy), 300);
  checked.effects["heat_accumulation"].strength = 0;
  EXPECT_EQ(start_temperature(checked, energy), 300);
  EXPECT_THROW(start_temperature(case_with(1000, 0.1, 1e6), {}), PhysicsError);
}

/// Grains in rows beside a track along x.
PowderBed rows_of_grains(std::int64_t count) {
  PowderBed bed;
  for (std::int64_t i = 0; i < count; ++i) {
    double const y = 5e-6 + 10e-6 * static_cast<double>(i % 40), x = 130e-6 + 160e-6 * static_cast<double>(i) / count;
    bed.add(i, {x, y, 5e-6}, 5e-6, 0);
  }
  return bed;
}

Case wide_case() {
  Case checked = small_case();
  checked.machine.width = 400 * um;
  checked.laser.spot_diameter = 50 * um;
  checked.material.density = 8000;
  return checked;
}

/// Shares lost over distance from the axis follow 1 - r / reach, and mass and count agree.
TEST(Denudation, LossFallsWithDistanceFromTheTrack) {
  Case checked = wide_case();
  checked.effects["denudation"] = {true, 0.8, {{"width_factor", 2.0}}};
  Track const track{Vec3(120 * um, 200 * um, 0), Vec3(320 * um, 200 * um, 0), 0, 1e-4, 100};
  std::int64_t const count = 40'000;  // 1000 a row
  PowderBed const before = rows_of_grains(count);
  PowderBed bed = before;
  Denuded const lost = denude(bed, {track}, checked, 1);
  EXPECT_EQ(lost.grains + static_cast<std::int64_t>(bed.size()), count);
  double const grain = 8000 * 4 / 3.0 * std::numbers::pi * std::pow(5e-6, 3);
  EXPECT_NEAR(lost.mass, static_cast<double>(lost.grains) * grain, 1e-10 * lost.mass);
  std::vector<int> left(40, 0);
  for (std::size_t row = 0; row < bed.size(); ++row) ++left[static_cast<std::size_t>(bed.y[row] / (10 * um))];
  for (int r = 0; r < 40; ++r) {
    double const distance = std::abs(5 + 10 * r - 200) * um, chance = std::max(0.0, 0.8 * (1 - distance / (100 * um)));
    EXPECT_NEAR(left[static_cast<std::size_t>(r)] / 1000.0, 1 - chance, 4 * std::sqrt(chance * (1 - chance) / 1000));
  }
}

TEST(Denudation, TracksReachThroughThePeriodicSideAndEndWhereTheyEnd) {
  Case checked = wide_case();
  checked.effects["denudation"] = {true, 1, {{"width_factor", 1.0}}};
  PowderBed bed;
  Vec3 const on_axis(200 * um, 398 * um, 0), beyond_side(200 * um, 3 * um, 0), behind(80 * um, 395 * um, 0),
      far(200 * um, 100 * um, 0);
  for (Vec3 const& centre : {on_axis, beyond_side, behind, far})
    bed.add(static_cast<std::int64_t>(bed.size()), centre, 5 * um, 0);
  Track const track{Vec3(150 * um, 398 * um, 0), Vec3(250 * um, 398 * um, 0), 0, 1e-4, 100};
  std::vector<Track> const often(200, track);  // certain but for what lies out of reach
  denude(bed, often, checked, 1);
  ASSERT_EQ(bed.size(), 2u);
  EXPECT_EQ(bed.id[0], 2);
  EXPECT_EQ(bed.id[1], 3);
}

TEST(Denudation, NullStrengthKeepsTheBed) {
  Case checked = wide_case();
  Track const track{Vec3(120 * um, 200 * um, 0), Vec3(320 * um, 200 * um, 0), 0, 1e-4, 100};
  for (EffectSettings const& off : {EffectSettings{false, 1, {}}, EffectSettings{true, 0, {}}}) {
    checked.effects["denudation"] = off;
    PowderBed bed = rows_of_grains(400);
    EXPECT_EQ(denude(bed, {track}, checked, 1).grains, 0);
    EXPECT_EQ(bed.id, rows_of_grains(400).id);
  }
}

/// A trench of two depths, level as a liquid: with heights h above its floors, sum h = e times the metal, and each
/// column keeps h / e.
TEST(Shrinkage, SurfaceSinksWithTheDepthBelowItAndMassStays) {
  constexpr int nx = 12, nz = 20, shallow = 14, deep = 4;
  auto const trench = [&](double expansion) {
    MeltColumns melt{{Vec3::Zero(), 5 * um, {nx, 1, nz}}, {}, {}, {}, std::vector<char>(nx, 1)};
    for (auto* values : {&melt.solid, &melt.grains, &melt.liquid}) values->assign(nx * nz, 0.0);
    for (std::int64_t c = 0; c < melt.grid.size(); ++c) {
      auto const [i, j, k] = melt.grid.coordinates(c);
      int const floor = i < nx / 2 ? shallow : deep;
      (k < floor ? melt.solid : melt.liquid)[static_cast<std::size_t>(c)] = k < 17 ? 1.0 : 0.0;
    }
    melt.expansion = expansion;
    return melt;
  };
  auto const heights = [&](double expansion) {
    std::vector<double> column(nx, 0.0);
    for (CellVolume const& m : settle_melt(trench(expansion), 400 * um).metal)
      column[static_cast<std::size_t>(m.cell % nx)] += m.volume;
    return column;
  };
  double const e = 1.06, metal = 6 * (17 - shallow) + 6 * (17 - deep);
  double const level = (e * metal + 6 * shallow + 6 * deep) / nx;
  std::vector<double> const frozen = heights(e);
  double sum = 0;
  for (int i = 0; i < nx; ++i) {
    double const floor = i < nx / 2 ? shallow : deep;
    EXPECT_NEAR(frozen[static_cast<std::size_t>(i)], (level - floor) / e, 1e-3) << i;
    sum += frozen[static_cast<std::size_t>(i)];
  }
  EXPECT_NEAR(sum, metal, 1e-12 * metal);
  for (double const height : heights(1)) EXPECT_TRUE(height == 17 - shallow || height == 17 - deep) << height;
}

TEST(Shrinkage, IsThatOfTheDensitiesAndNothingWithoutTheEffect) {
  Case checked = small_case();
  checked.material = built_in_materials().at("316L");
  EXPECT_EQ(liquid_expansion(checked), 1);
  checked.effects["shrinkage"] = {true, 1, {}};
  EXPECT_NEAR(liquid_expansion(checked), 7107.3 / 6936, 1e-12);  // Pichler et al., Int. J. Thermophys. 41 (2020)
  checked.effects["shrinkage"].strength = 0;
  EXPECT_EQ(liquid_expansion(checked), 1);
  checked.effects["shrinkage"].strength = 1;
  checked.material.liquid_density = {};
  EXPECT_THROW(liquid_expansion(checked), InputError);
}

}  // namespace
}  // namespace layerloop::coupling
