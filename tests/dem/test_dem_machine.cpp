// The machine: recoaters, dosing by a piston, end walls, plates, and effects at their null value.
#include <gtest/gtest.h>

#include <cmath>

#include "core/grain_size.hpp"
#include "dem/machine_rig.hpp"
#include "dem/recoater.hpp"
#include "dem/softening.hpp"
#include "dem/textured_plate.hpp"
#include "pile.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

void enable(Case& c, std::string const& effect, double strength, std::map<std::string, double> parameters) {
  c.effects[effect] = {true, strength, std::move(parameters)};
}

struct Layer {
  PowderBed dosed, bed;
  SpreadOutcome outcome;
  explicit Layer(Case const& c) {
    TriangleSurface const plate = plate_of(c);
    dose(dosed, c, plate, c.powder.particles, 0, alone(), false);
    bed = dosed;
    outcome = spread(bed, c, plate, alone(), false);
  }
  std::int64_t deposited(Case const& c) const {
    return std::ranges::count_if(bed.x, [&](double x) { return x > c.machine.deposition_begin(); });
  }
};

Case tiny_case() {
  Case c = small_case();
  c.machine.recoating_speed = 0.2;
  c.machine.deposition_length = 120e-6;
  c.powder.particles = 150;
  return c;
}

TEST(Effects, AtStrengthZeroChangeNoBit) {
  Case const plain = tiny_case();
  Case off = plain;
  enable(off, "blade_vibration", 0, {{"amplitude", 2e-6}, {"frequency", 500}});
  enable(off, "blade_compliance", 0, {});
  enable(off, "fines", 0, {{"mass_fraction", 0.05}, {"diameter", 8e-6}});
  Layer const a(plain), b(off);
  EXPECT_GT(differences(a.dosed, a.bed), 100);  // the stroke did something
  EXPECT_EQ(differences(a.dosed, b.dosed), 0);
  EXPECT_EQ(differences(a.bed, b.bed), 0);
}

TEST(Effects, FinesHaveTheirShareOfTheMass) {
  Case c = small_case();
  enable(c, "fines", 2, {{"mass_fraction", 0.02}, {"diameter", 9e-6}});
  for (SizeBasis const basis : {SizeBasis::number, SizeBasis::volume}) {
    c.powder.basis = basis;
    double fine = 0, all = 0, count = 0;
    constexpr std::int64_t n = 60000;
    for (std::int64_t id = 0; id < n; ++id) {
      double const r = draw_radius(c, id), volume = r * r * r;
      all += volume;
      if (r < 5e-6) fine += volume, ++count;
    }
    double const error = 1 / std::sqrt(count) + 2 / std::sqrt(double(n));  // of the count of fines, of the mean volume
    EXPECT_NEAR(fine / all, 0.04, 4 * 0.04 * error);
    EXPECT_NEAR(all / n * 4.0 / 3.0 * std::numbers::pi, mean_grain_volume(fed_powder(c)),
                0.05 * mean_grain_volume(fed_powder(c)));
  }
}

TEST(Effects, ABladeThatYieldsLiftsByItsForceOverItsStiffness) {
  Case c = tiny_case();
  c.machine.recoater = RecoaterKind::compliant_blade;
  c.machine.blade_stiffness = 1e5;
  c.machine.blade_mass = 0.06;
  c.machine.blade_damping = 0.3;
  enable(c, "blade_compliance", 4, {});
  Rig const rig = machine_rig(c, {}, {}, Tools::moving_recoater);
  Suspension const& s = rig.walls.blocks.back().motion.suspension.value();
  EXPECT_DOUBLE_EQ(s.stiffness, 1e5 * c.machine.width / 4);
  EXPECT_DOUBLE_EQ(s.mass, 0.06 * c.machine.width);
  EXPECT_DOUBLE_EQ(s.damping, 2 * 0.3 * std::sqrt(s.stiffness * s.mass));
  c.effects.clear();
  EXPECT_DOUBLE_EQ(machine_rig(c, {}, {}, Tools::moving_recoater).walls.blocks.back().motion.suspension->stiffness,
                   1e5 * c.machine.width);
}

TEST(Recoater, RollerSpreadsAndLosesNoGrain) {
  Case c = tiny_case();
  c.machine.recoater = RecoaterKind::roller;
  c.machine.roller_diameter = 300e-6;
  c.machine.roller_spin = 1;
  Walls parked;
  add_parked_recoater(parked, c.machine);
  Roller const& roller = parked.rollers.at(0);
  EXPECT_DOUBLE_EQ(roller.z - roller.radius, c.machine.blade_clearance);
  EXPECT_DOUBLE_EQ(roller.x + roller.radius, 0);
  EXPECT_DOUBLE_EQ(-roller.spin * roller.radius, c.machine.recoating_speed);  // the lowest line goes ahead
  Layer const layer(c);
  EXPECT_GT(layer.deposited(c), 0);
  EXPECT_EQ(static_cast<std::int64_t>(layer.bed.size()) + layer.outcome.overflow_grains, c.powder.particles);
  EXPECT_GT(layer.outcome.blade_force, layer.outcome.mean_blade_force);
  EXPECT_GT(layer.outcome.mean_blade_force, 0);
}

TEST(Recoater, HighEndWallKeepsTheSurplusInTheZone) {
  Case flush = tiny_case(), high = flush, open = flush;
  high.machine.end_wall = EndWall::high;
  open.machine.end_wall = EndWall::open;
  Layer const a(flush), b(high), c(open);
  EXPECT_GT(b.deposited(high), a.deposited(flush));
  EXPECT_GE(a.deposited(flush), c.deposited(open));
  for (double const x : b.bed.x) EXPECT_LT(x, high.machine.deposition_end());
}

TEST(Dosing, PistonLiftsThePowderByTheDoseAndLosesNothing) {
  Case first = tiny_case();
  first.machine.dosing = Dosing::feed;
  first.machine.dose_factor = 0.4;
  first.powder.particles = 50;  // they stand about as high as the platforms
  Case const second = case_of_layer(first, 2);
  double const rise = 0.4 * 50e-6 * 120.0 / 150.0;
  EXPECT_NEAR(first.machine.accumulation_depth - second.machine.accumulation_depth, rise, 1e-18);
  TriangleSurface const plate = plate_of(first);
  PowderBed bed;
  std::int64_t const next = dose(bed, first, plate, first.powder.particles, 0, alone(), false);
  PowderBed lifted = bed, settled = bed;
  raise_feed(lifted, second);
  for (std::size_t i = 0; i < bed.size(); ++i) EXPECT_NEAR(lifted.z[i] - bed.z[i], rise, 1e-15);
  EXPECT_LT(lifted.contacts.size(), bed.contacts.size());  // those to the walls of the zone are gone
  EXPECT_GT(lifted.contacts.size(), bed.contacts.size() / 2);
  EXPECT_EQ(dose(settled, second, plate, 0, next, alone(), false), next);
  ASSERT_EQ(settled.id, bed.id);
  double lowest = 1;
  for (std::size_t i = 0; i < bed.size(); ++i) lowest = std::min(lowest, settled.z[i] - settled.radius[i]);
  EXPECT_NEAR(lowest, -second.machine.accumulation_depth, 0.1e-6);
}

TEST(Dosing, RainHasNoPiston) {
  Case const c = tiny_case();
  EXPECT_EQ(case_of_layer(c, 7).machine.accumulation_depth, c.machine.accumulation_depth);
}

/// Pull-off of SJKR2 ~ k^3/E^2 (bond_number) stays by the first scaling.
TEST(Softening, ScaledCohesionKeepsThePullOffForceAndIsSaidInTheNote) {
  Case soft = small_case(), stiff = soft;
  stiff.contact.youngs_modulus = 200e9;
  CohesionScaling const scaled = scale_cohesion(soft.contact.cohesion_energy_density, 1000);
  stiff.contact.cohesion_energy_density = scaled.same_pull_off;
  EXPECT_NEAR(bond_number(10e-6, density, stiff.contact) / bond_number(10e-6, density, soft.contact), 1, 1e-12);
  EXPECT_NEAR(scaled.same_sticking, 9e4 * std::pow(1000, 0.8), 1e-6 * scaled.same_sticking);
  EXPECT_NE(softening_note(soft).find("9e+06 J/m3"), std::string::npos) << softening_note(soft);
  EXPECT_EQ(softening_note(stiff), "");
  soft.contact.cohesion = Cohesion::none;
  EXPECT_EQ(softening_note(soft), "");
}

TEST(RoughPlate, HasItsRmsHeightAndCorrelationAndCloses) {
  Case c = small_case();
  c.machine.width = 1000e-6;
  c.machine.deposition_length = 1500e-6;
  c.machine.plate_roughness = 4e-6;
  c.machine.plate_correlation_length = 40e-6;
  TriangleSurface const plate = textured_plate(c);
  EXPECT_EQ(count_open_edges(plate), 0);
  std::size_t const half = plate.vertices.size() / 2, ny = 126, nx = half / ny;
  ASSERT_EQ(nx * ny, half);
  auto const height = [&](std::size_t i, std::size_t j) { return plate.vertices[half + i + nx * j].z(); };
  double mean = 0, square = 0, pair = 0, pairs = 0;
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i) mean += height(i, j) / static_cast<double>(half);
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i) {
      square += std::pow(height(i, j) - mean, 2) / static_cast<double>(half);
      if (i + 5 >= nx) continue;  // five points are one correlation length
      pair += (height(i, j) - mean) * (height(i + 5, j) - mean);
      ++pairs;
    }
  EXPECT_NEAR(mean, 12e-6, 0.3e-6);
  EXPECT_NEAR(std::sqrt(square), 4e-6, 0.3e-6);  // some 900 independent patches
  EXPECT_NEAR(pair / pairs / square, std::exp(-1.0), 0.06);
  for (std::size_t i = 0; i < nx; ++i) EXPECT_NEAR(height(i, 0), height(i, ny - 1), 1e-15);  // periodic along y
}

TEST(FrozenGrains, CoverTheirShareAsHemispheresOfThePowder) {
  Case c = small_case();
  c.machine.width = 400e-6;
  c.machine.deposition_length = 800e-6;
  c.machine.plate_grains = 0.3;
  TriangleSurface const plate = textured_plate(c);
  EXPECT_EQ(count_open_edges(plate), 0);
  // a hemisphere of radius r covers pi r^2 and holds 2/3 pi r^3 over the plate
  double area = 0, volume = 0;
  std::vector<FrozenGrain> const grains = frozen_grains(c);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    FrozenGrain const& g = grains[i];
    area += std::numbers::pi * g.radius * g.radius;
    volume += 2.0 / 3.0 * std::numbers::pi * std::pow(g.radius, 3);
    EXPECT_GE(g.x - g.radius, c.machine.deposition_begin());
    EXPECT_LE(g.x + g.radius, c.machine.deposition_end());
    for (std::size_t j = 0; j < i; ++j) {
      double const dy = std::remainder(g.y - grains[j].y, c.machine.width);
      EXPECT_GE(std::hypot(g.x - grains[j].x, dy), g.radius + grains[j].radius);
    }
  }
  double const zone = c.machine.deposition_length * c.machine.width;
  EXPECT_NEAR(area / zone, 0.3, std::numbers::pi * 21e-6 * 21e-6 / zone);
  double lowest = 0, highest = 0;
  for (Vec3 const& v : plate.vertices) lowest = std::min(lowest, v.z()), highest = std::max(highest, v.z());
  EXPECT_NEAR(enclosed_volume(plate) - (-lowest) * zone, volume, 0.03 * volume);
  EXPECT_NEAR(highest, 21e-6, 0.1e-6);
}

}  // namespace
}  // namespace layerloop::dem
