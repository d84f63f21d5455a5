// The ledger of energy: closed forms of single contacts, and that it closes where everything acts at once.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <functional>

#include "dem/dosing.hpp"
#include "dem/recoater.hpp"
#include "pile.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

constexpr double radius = 12.5e-6;

Motion booked(ContactSettings const& contact, double smallest_radius) {
  Motion motion = test::motion(contact, smallest_radius);
  motion.keeps_energy_ledger = true;
  return motion;
}

double kinetic(PowderBed const& bed) {
  double sum = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    double const m = mass_of(bed.radius[i]), r = bed.radius[i];
    sum += 0.5 * m * Vec3(bed.vx[i], bed.vy[i], bed.vz[i]).squaredNorm() +
           0.2 * m * r * r * Vec3(bed.wx[i], bed.wy[i], bed.wz[i]).squaredNorm();
  }
  return sum;
}

TEST(Energy, ElasticGasKeepsIt) {
  ContactSettings contact = plain_contact();
  contact.restitution = 1;
  contact.sliding_friction = contact.wall_friction = 0;
  contact.time_step_fraction = 0.008;
  Rig rig = empty_space();
  rig.width = rig.length = 150e-6;
  rig.walls.blocks = {floor_block(), {"the ceiling", -0.1, 0.1, 120e-6, 0.1, 0, 0}};
  PowderBed bed;
  for (std::int64_t k = 0; k < 100; ++k) {
    auto const i = static_cast<double>(k % 5), j = static_cast<double>(k / 5 % 5), l = static_cast<double>(k / 25);
    bed.add(k, {30e-6 * i, 30e-6 * j, 15e-6 + 30e-6 * l}, 10e-6 + 1e-8 * static_cast<double>(k % 7), 0);
    double const phase = static_cast<double>(k);
    set_velocity(bed, static_cast<std::size_t>(k),
                 0.2 * Vec3(std::sin(phase), std::sin(3.7 * phase), std::cos(2.3 * phase)));
  }
  Simulation simulation(booked(contact, 10e-6), rig, alone());
  simulation.scatter(bed);
  double drift = 0, most_elastic = 0;
  for (int k = 0; k < 100; ++k) {
    simulation.advance(1000);
    EnergyLedger const energy = simulation.energy();
    drift = std::max(drift, energy.relative_error());
    most_elastic = std::max(most_elastic, energy.elastic);
    EXPECT_EQ(energy.dissipated(), 0);
  }
  EXPECT_GT(most_elastic, 1e-3 * kinetic(bed)) << "they did collide";
  EXPECT_LT(drift, 1e-6);
}

TEST(Energy, DampedCollisionDissipatesOneLessRestitutionSquared) {
  for (double step : {0.005, 0.149}) {
    ContactSettings contact = plain_contact();
    contact.time_step_fraction = step;
    PowderBed bed;
    bed.add(1, {-radius * 1.001, 50e-6, 0}, radius, 0);
    bed.add(2, {radius * 1.001, 50e-6, 0}, radius, 0);
    bed.vx = {0.05, -0.05};
    Simulation simulation(booked(contact, radius), empty_space(), alone());
    simulation.scatter(bed);
    double const before = kinetic(bed),
                 duration = 0.003 * radius / 0.1 + 3 * hertz_contact_time(radius, density, 0.1, contact);
    simulation.advance(static_cast<std::int64_t>(duration / simulation.time_step()));
    EnergyLedger const energy = simulation.energy();
    double const expected = (1 - 0.7 * 0.7) * before;
    EXPECT_NEAR(energy.dissipated_normal, expected, (step < 0.01 ? 3e-4 : 2e-2) * expected) << step;
    EXPECT_NEAR(energy.kinetic, kinetic(simulation.gather()) - before, 1e-8 * before);
    EXPECT_LT(energy.relative_error(), step < 0.01 ? 2e-6 : 1e-3) << step;
  }
}

/// A grain at rest on a plane: overlap where the Hertz force carries its weight.
struct OnFloor {
  ContactSettings contact = plain_contact();
  Rig rig = empty_space();
  PowderBed bed;

  explicit OnFloor(double speed) {
    contact.wall_friction = 0.3;
    double const weight = mass_of(radius) * standard_gravity;
    double const overlap = std::pow(weight / (4.0 / 3.0 * reduced_modulus(contact) * std::sqrt(radius)), 2.0 / 3.0);
    bed.add(0, {0, 50e-6, radius - overlap}, radius, 0);
    bed.vx[0] = speed;
    rig.walls.blocks = {floor_block()};
    rig.gravity = {0, 0, -standard_gravity};
  }
};

TEST(Energy, SlidingGrainDissipatesFrictionTimesWay) {
  double const v0 = 0.02, friction = 0.3, force = friction * mass_of(radius) * standard_gravity;
  OnFloor set(v0);
  Simulation simulation(booked(set.contact, radius), set.rig, alone());
  simulation.scatter(set.bed);
  double const rolls = 2 * v0 / (7 * friction * standard_gravity);
  auto const steps = static_cast<std::int64_t>(rolls / simulation.time_step());
  simulation.advance(steps / 2);
  double const t = simulation.time(), way = v0 * t - 3.5 * friction * standard_gravity * t * t / 2;
  EXPECT_NEAR(simulation.energy().dissipated_tangential, force * way, 2e-3 * force * way);
  simulation.advance(steps);
  double const all = mass_of(radius) * v0 * v0 / 7;
  EXPECT_NEAR(simulation.energy().dissipated_tangential, all, 2e-3 * all);
  EXPECT_LT(simulation.energy().relative_error(), 1e-6);
}

TEST(Energy, RollingGrainDissipatesAllItHas) {
  for (RollingModel const model : {RollingModel::cdt, RollingModel::epsd2}) {
    double const v = 0.021;
    OnFloor set(v);
    set.contact.rolling_friction = 0.15;
    set.contact.rolling_model = model;
    set.bed.wy[0] = v / radius;
    double const distance = 7 * v * v / (10 * set.contact.rolling_friction * standard_gravity);
    Simulation simulation(booked(set.contact, radius), set.rig, alone());
    simulation.scatter(set.bed);
    simulation.advance(static_cast<std::int64_t>(1.2 * 2 * distance / v / simulation.time_step()));
    EnergyLedger const energy = simulation.energy();
    double const all = 0.7 * mass_of(radius) * v * v;
    EXPECT_NEAR(energy.dissipated_rolling, all, 1e-2 * all);
    EXPECT_LT(energy.relative_error(), 1e-6);
  }
}

TEST(Energy, GasTakesWhatAGrainLoses) {
  ContactSettings contact = plain_contact();
  contact.gas_viscosity = 1e-3;
  PowderBed bed;
  bed.add(0, {0, 50e-6, 0}, radius, 0);
  bed.vx[0] = 0.01;
  Simulation simulation(booked(contact, radius), empty_space(), alone());
  simulation.scatter(bed);
  simulation.advance(20000);
  double const lost = kinetic(bed) - kinetic(simulation.gather());
  EXPECT_GT(lost, 0.1 * kinetic(bed));
  EXPECT_NEAR(simulation.energy().dissipated_gas, lost, 1e-6 * lost);
}

/// A pile that a wall pushes over floor and mesh.
EnergyLedger of_pile(std::function<void(Pile&)> const& change) {
  Pile pile(160);
  change(pile);
  Motion motion = motion_of(pile.checked);
  motion.keeps_energy_ledger = true;
  Simulation simulation(motion, pile.rig, alone());
  simulation.scatter(pile.bed);
  simulation.advance(25000);
  return simulation.energy();
}

TEST(Energy, ClosesUnderEveryLaw) {
  omp_set_num_threads(1);
  std::vector<std::pair<char const*, std::function<void(Pile&)>>> const laws = {
      {"sjkr2, cdt", [](Pile&) {}},
      {"epsd2", [](Pile& p) { p.checked.contact.rolling_model = RollingModel::epsd2; }},
      {"sjkr, spring kept",
       [](Pile& p) {
         p.checked.contact.cohesion = Cohesion::sjkr;
         p.checked.contact.sliding_spring = SlidingSpring::kept;
       }},
      {"dmt",
       [](Pile& p) {
         p.checked.contact.cohesion = Cohesion::dmt;
         p.checked.contact.surface_energy = 1e-5;
       }},
      {"clamped", [](Pile& p) { p.checked.contact.restitution_form = RestitutionForm::clamped; }},
      {"a shaking wall that yields",
       [](Pile& p) {
         p.rig.walls.blocks[1].motion.suspension = Suspension{1e-9, 5, 1e-5};
         p.rig.walls.blocks[1].motion.amplitude = 1e-6;
         p.rig.walls.blocks[1].motion.frequency = 2e3;
       }},
      {"overflow", [](Pile& p) { p.rig.sink_x = 215e-6; }},
  };
  for (auto const& [name, change] : laws) {
    EnergyLedger const energy = of_pile(change);
    EXPECT_LT(energy.relative_error(), 1e-3) << name;
    EXPECT_GT(energy.wall_work, 0) << name;
    EXPECT_GT(energy.dissipated_normal, 0) << name;
    EXPECT_GT(energy.dissipated_tangential, 0) << name;
    EXPECT_GT(energy.dissipated_rolling, 0) << name;
    fmt::print("{:28} work of the wall {:.3e} J, done {:.3e} J, residual {:+.1e} of it; out {:.1e} J\n", name,
               energy.wall_work, energy.work_done, energy.residual / energy.work_done, energy.carried_out);
  }
}

struct Layer {
  PowderBed bed;
  EnergyLedger dosing, stroke;
};

Layer make_layer(bool booked) {
  Case checked = small_case();
  checked.run.energy_ledger = booked;
  Layer layer;
  TriangleSurface const plate = plate_of(checked);
  dose(layer.bed, checked, plate, checked.powder.particles, 0, alone(), false, &layer.dosing);
  layer.stroke = spread(layer.bed, checked, plate, alone(), false).energy;
  return layer;
}

TEST(Energy, OfAStrokeClosesToAThousandthOfTheWorkOfTheBlade) {
  Layer const one = make_layer(true);
  EnergyLedger const& e = one.stroke;
  fmt::print(
      "stroke: blade {:.3e} J, kinetic {:.1e}, potential {:.1e}, elastic {:.1e}, normal {:.2e}, tangential {:.2e}, "
      "rolling {:.2e}, out {:.1e}, residual {:+.1e}; dosing: done {:.2e}, residual {:+.1e}\n",
      e.wall_work, e.kinetic, e.potential, e.elastic, e.dissipated_normal, e.dissipated_tangential,
      e.dissipated_rolling, e.carried_out, e.residual, one.dosing.work_done, one.dosing.residual);
  EXPECT_GT(e.wall_work, 0);
  EXPECT_LT(std::abs(e.residual), 1e-3 * e.wall_work);
  EXPECT_LT(one.dosing.relative_error(), 1e-3);
  EXPECT_EQ(differences(one.bed, make_layer(false).bed), 0) << "books change no bit of the motion";
}

TEST(Energy, DoesNotDependOnThreads) {
  Pile pile(900);
  Motion motion = motion_of(pile.checked);
  motion.keeps_energy_ledger = true;
  auto const on = [&](int threads) {
    omp_set_num_threads(threads);
    Simulation simulation(motion, pile.rig, alone());
    simulation.scatter(pile.bed);
    simulation.advance(12000);
    omp_set_num_threads(1);
    return simulation.energy();
  };
  EnergyLedger const one = on(1), two = on(2);
  EXPECT_GT(one.dissipated_tangential, 0);
  EXPECT_EQ(one.kinetic, two.kinetic);
  EXPECT_EQ(one.elastic, two.elastic);
  EXPECT_EQ(one.dissipated(), two.dissipated());
  EXPECT_EQ(one.residual, two.residual);
}

}  // namespace
}  // namespace layerloop::dem
