// Powders of several materials: who is of which, and what two unlike bodies do to each other.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "pile.hpp"

namespace layerloop::dem {
namespace {
using namespace test;
using std::numbers::pi;

Material metal(std::string name, double density) {
  Material m;
  m.name = std::move(name);
  m.density = density;
  return m;
}

/// Aluminium with copper, 96:4 by weight.
Case mixed_case() {
  Case c = small_case();
  c.material = metal("AlSi10Mg", 2670);
  c.admixtures = {metal("Cu", 8960)};
  c.powder.mixture = {{"AlSi10Mg", 0.96}, {"Cu", 0.04}};
  return c;
}

TEST(Mixture, NumbersGiveTheWeights) {
  Case const c = mixed_case();
  double const p = (0.04 / 8960) / (0.04 / 8960 + 0.96 / 2670);  // share of copper by number
  constexpr std::int64_t n = 200'000;
  double copper = 0, mass[2] = {0, 0}, squares = 0;
  for (std::int64_t id = 0; id < n; ++id) {
    std::int32_t const material = draw_material(c, id);
    double const m = c.density(material) * std::pow(draw_radius(c, id), 3);
    copper += material;
    mass[material] += m;
    squares += std::pow(m * (material - 0.04), 2);
  }
  EXPECT_NEAR(copper / n, p, 3 * std::sqrt(p * (1 - p) / n));  // binomial
  double const all = mass[0] + mass[1];
  EXPECT_NEAR(mass[1] / all, 0.04, 3 * std::sqrt(squares) / all);
}

TEST(Mixture, DoesNotChangeTheSizes) {
  Case const mixed = mixed_case();
  Case plain = mixed;
  plain.admixtures.clear();
  plain.powder.mixture.clear();
  for (std::int64_t id = 0; id < 100; ++id) {
    EXPECT_EQ(draw_radius(mixed, id), draw_radius(plain, id));
    EXPECT_EQ(draw_material(plain, id), 0);
  }
}

/// Each of both materials has its own of everything, walls too.
Case unlike_case() {
  Case c = mixed_case();
  c.powder.mixture = {{"AlSi10Mg", 0.5}, {"Cu", 0.5}};
  c.bodies["Cu"] = {.youngs_modulus = 0.5e9, .poisson_ratio = 0.35};
  c.bodies[walls_name] = {.youngs_modulus = 2e9, .poisson_ratio = 0.25};
  PairSettings &both = c.pairs[{"AlSi10Mg", "Cu"}], &copper = c.pairs[{"Cu", "Cu"}], &wall = c.pairs[{"Cu", "wall"}];
  both.restitution = 0.5, both.sliding_friction = 0.4, both.rolling_friction = 0.05;
  copper.sliding_friction = 0.3, copper.cohesion_energy_density = 2e5;
  wall.restitution = 0.6, wall.sliding_friction = 0.2;
  return c;
}

double reduced(double E1, double nu1, double E2, double nu2) {
  return 1 / ((1 - nu1 * nu1) / E1 + (1 - nu2 * nu2) / E2);
}
double reduced_shear(double E1, double nu1, double E2, double nu2) {
  return 1 / (2 * (2 - nu1) * (1 + nu1) / E1 + 2 * (2 - nu2) * (1 + nu2) / E2);
}

TEST(Mixture, LawsOfPairs) {
  Case const c = unlike_case();
  Mixture const m = mixture_of(c);
  ASSERT_EQ(m.materials(), 2U);
  ContactLaw const &al = m.between_grains[0], &both = m.between_grains[1], &cu = m.between_grains[3];
  EXPECT_NEAR(both.normal_stiffness, 4.0 / 3 * reduced(0.2e9, 0.3, 0.5e9, 0.35), 1e-6);
  EXPECT_NEAR(both.tangential_stiffness, 8 * reduced_shear(0.2e9, 0.3, 0.5e9, 0.35), 1e-6);
  EXPECT_NEAR(al.normal_stiffness, 4.0 / 3 * reduced(0.2e9, 0.3, 0.2e9, 0.3), 1e-6);
  EXPECT_NEAR(m.at_walls[1].normal_stiffness, 4.0 / 3 * reduced(0.5e9, 0.35, 2e9, 0.25), 1e-6);
  EXPECT_NEAR(m.at_walls[1].tangential_stiffness, 8 * reduced_shear(0.5e9, 0.35, 2e9, 0.25), 1e-6);
  EXPECT_EQ(both.normal_stiffness, m.between_grains[2].normal_stiffness);
  EXPECT_EQ(both.sliding_friction, 0.4);
  EXPECT_EQ(both.rolling_friction, 0.05);
  EXPECT_EQ(al.sliding_friction, c.contact.sliding_friction);
  EXPECT_EQ(cu.sliding_friction, 0.3);
  EXPECT_EQ(cu.cohesion, 4 * pi * 2e5);
  EXPECT_EQ(both.cohesion, 4 * pi * c.contact.cohesion_energy_density);
  EXPECT_EQ(m.at_walls[0].sliding_friction, c.contact.wall_friction);
  EXPECT_EQ(m.at_walls[1].sliding_friction, 0.2);
  EXPECT_EQ(m.at_walls[1].cohesion, 2 * pi * c.contact.cohesion_energy_density);
}

TEST(Mixture, EffectsScaleWhatPairsHave) {
  Case c = unlike_case();
  c.effects["cohesion"] = {true, 0.5};
  c.effects["wall_friction"] = {true, 0};  // walls rub as grains do
  Mixture const m = mixture_of(c);
  EXPECT_DOUBLE_EQ(m.between_grains[3].cohesion, 0.5 * 4 * pi * 2e5);
  EXPECT_EQ(m.at_walls[1].sliding_friction, 0.3);
  EXPECT_EQ(m.at_walls[0].sliding_friction, c.contact.sliding_friction);
}

TEST(Mixture, StepIsThatOfTheFastestWave) {
  Case const c = unlike_case();
  auto const wave = [](double E, double nu, double rho) {
    return pi * 6.5e-6 * std::sqrt(rho * 2 * (1 + nu) / E) / (0.1631 * nu + 0.8766);
  };
  double const al = wave(0.2e9, 0.3, 2670), cu = wave(0.5e9, 0.35, 8960);
  EXPECT_NEAR(motion_of(c).time_step, 0.149 * std::min(al, cu), 1e-6 * al);
  Case stiff = c;
  stiff.bodies["Cu"].youngs_modulus = 2e9;
  double const faster = wave(2e9, 0.35, 8960);
  ASSERT_LT(faster, al);
  EXPECT_NEAR(motion_of(stiff).time_step, 0.149 * faster, 1e-6 * al);
  Motion const motion = motion_of(stiff);
  EXPECT_EQ(shortest_contact_time(motion, 6.5e-6, 0.1),
            hertz_contact_time(6.5e-6, 8960, 0.1, contact_between(stiff, "Cu", "Cu")));
}

/// Head-on impact of unequal grains of both materials: largest overlap, restitution, momentum.
TEST(Mixture, CollisionOfTwoMaterials) {
  Case c = unlike_case();
  c.contact.cohesion = Cohesion::none;
  c.contact.time_step_fraction = 0.002;
  double const r0 = 12e-6, r1 = 20e-6, v = 0.1, e = 0.5;
  auto const collide = [&](double restitution) {
    c.pairs[{"AlSi10Mg", "Cu"}].restitution = restitution;
    PowderBed bed;
    bed.add(1, {-r0 * 1.0005, 50e-6, 0}, r0, 0);
    bed.add(2, {r1 * 1.0005, 50e-6, 0}, r1, 1);
    bed.vx = {v, 0};
    Simulation simulation(motion_of(c), empty_space(), alone());
    simulation.scatter(bed);
    for (int k = 0; k < 2000 && (k < 5 || simulation.touching_pairs() > 0 || simulation.time() < 1e-6); ++k)
      simulation.advance(20);
    return std::pair{simulation.gather(), simulation.largest_overlap() * 2 * r0};
  };
  double const m0 = 2670 * 4.0 / 3 * pi * std::pow(r0, 3), m1 = 8960 * 4.0 / 3 * pi * std::pow(r1, 3);
  auto const [after, unused] = collide(e);
  EXPECT_NEAR((after.vx[1] - after.vx[0]) / v, e, 1e-3);
  EXPECT_NEAR((m0 * after.vx[0] + m1 * after.vx[1]) / (m0 * v), 1, 1e-9);
  double const m = m0 * m1 / (m0 + m1), R = r0 * r1 / (r0 + r1), E = reduced(0.2e9, 0.3, 0.5e9, 0.35);
  double const expected = std::pow(15 * m * v * v / (16 * E * std::sqrt(R)), 0.4);
  EXPECT_NEAR(collide(1).second, expected, 2e-3 * expected);
}

/// Chung & Ooi, Granular Matter 13 (2011) 643, test 2: an elastic sphere on a rigid plane, R = 0.1 m at 0.2 m/s.
/// Closed forms: dmax = (15 m v^2 / (16 E sqrt R))^(2/5), F = 4/3 E sqrt R dmax^(3/2).
TEST(Mixture, RigidWall) {
  struct Sphere {
    double E, nu, density, overlap, force;
  };
  for (Sphere const& s : {Sphere{70e9, 0.3, 2699, 49.72e-6, 11.37e3}, Sphere{40e9, 0.35, 1800, 52.14e-6, 7.233e3}}) {
    Case c = small_case();
    c.material = metal("sphere", s.density);
    c.powder.diameters = {0.2};
    c.powder.fractions = {1};
    c.contact = plain_contact();
    c.contact.restitution = 1;
    c.contact.time_step_fraction = 0.005;
    c.bodies["sphere"] = {.youngs_modulus = s.E, .poisson_ratio = s.nu};
    c.bodies[walls_name].youngs_modulus = std::numeric_limits<double>::infinity();
    Rig rig = empty_space();
    rig.width = 1.2;
    rig.x_range = rig.z_range = {-2, 2};
    rig.walls.blocks = {{"the floor", -1, 1, -1, 0}};
    PowderBed bed;
    bed.add(0, {0, 0.6, 0.1 * 1.00001}, 0.1, 0);
    bed.vz[0] = -0.2;
    Simulation simulation(motion_of(c), rig, alone());
    simulation.scatter(bed);
    while (simulation.time() < 800e-6) simulation.advance(50);
    double const overlap = simulation.largest_overlap() * 0.2, E = 0.75 * motion_of(c).at_walls.normal_stiffness;
    EXPECT_NEAR(overlap, s.overlap, 1e-3 * s.overlap);
    EXPECT_NEAR(4.0 / 3 * E * std::sqrt(0.1) * std::pow(overlap, 1.5), s.force, 1e-3 * s.force);
    EXPECT_NEAR(simulation.gather().vz[0], 0.2, 1e-3 * 0.2);
  }
}

/// What tables of one material give is what [contact] gives, bit for bit; and so are two materials that are alike.
TEST(Mixture, TablesGiveTheBitsOfContact) {
  Pile plain(160);
  plain.checked.material.name = "A";
  Pile tables = plain;
  ContactSettings& contact = tables.checked.contact;
  tables.checked.bodies["A"] = tables.checked.bodies[walls_name] = {contact.youngs_modulus, contact.poisson_ratio};
  tables.checked.pairs[{"A", "A"}] = {contact.restitution, contact.sliding_friction, contact.rolling_friction,
                                      contact.cohesion_energy_density, std::nullopt};
  tables.checked.pairs[{"A", "wall"}] = {contact.restitution, contact.wall_friction, contact.rolling_friction,
                                         contact.cohesion_energy_density, std::nullopt};
  contact.youngs_modulus *= 3;
  contact.poisson_ratio = 0.1;
  contact.restitution = contact.sliding_friction = contact.wall_friction = contact.rolling_friction = 0.9;
  contact.cohesion_energy_density *= 3;
  PowderBed const expected = plain.run(alone(), 24000);
  ASSERT_GT(expected.contacts.size(), 60U);
  EXPECT_EQ(differences(tables.run(alone(), 24000), expected), 0);

  Pile twins = plain;
  twins.checked.admixtures = {metal("B", twins.checked.material.density)};
  twins.checked.powder.mixture = {{"A", 0.5}, {"B", 0.5}};
  for (std::size_t i = 0; i < twins.bed.size(); ++i) twins.bed.material[i] = static_cast<std::int32_t>(i % 2);
  EXPECT_EQ(differences(twins.run(alone(), 24000), expected), 0);
}

TEST(Mixture, UnknownMaterialIsRefused) {
  Case const c = mixed_case();
  PowderBed bed;
  bed.add(1, {0, 50e-6, 0}, 10e-6, 2);
  Simulation simulation(motion_of(c), empty_space(), alone());
  EXPECT_THROW(simulation.scatter(bed), InputError);
}

TEST(Mixture, HeavyGrainsFallAsTheirDensitySays) {
  Case const c = mixed_case();
  PowderBed bed;
  bed.add(1, {0, 50e-6, 0}, 10e-6, 0);
  bed.add(2, {50e-6, 50e-6, 0}, 10e-6, 1);
  Motion const motion = motion_of(c);
  EXPECT_DOUBLE_EQ(1 / record_of(bed, 0, motion.density_of(0)).state.inverse_mass, 2670 * bed.volume(0));
  EXPECT_DOUBLE_EQ(1 / record_of(bed, 1, motion.density_of(1)).state.inverse_mass, 8960 * bed.volume(1));
}

}  // namespace
}  // namespace layerloop::dem
