// Effects on contacts: bit for bit absent at their null value, and each changes what it says.
#include <gtest/gtest.h>
#include <omp.h>

#include "dem/contact_effects.hpp"
#include "pile.hpp"

namespace layerloop::dem {
namespace {
using namespace test;

std::map<std::string, EffectSettings> all_effects(bool enabled, double strength) {
  std::map<std::string, EffectSettings> effects;
  for (char const* name : {"capillary_bridge", "electrostatic_charge", "gas_drag"})
    effects[name] = {enabled, strength, {}};
  for (char const* name : {"cohesion", "rolling_resistance", "wall_friction", "wall_cohesion"})
    effects[name] = {true, 1, {}};
  effects["capillary_bridge"].parameters = {
      {"liquid_volume", 1e-4}, {"surface_tension", 0.072}, {"contact_angle", 0.2}};
  effects["electrostatic_charge"].parameters = {{"charge_density", 2e-5}};
  effects["gas_drag"].parameters = {{"viscosity", 2e-4}};
  return effects;
}

PowderBed spread(std::map<std::string, EffectSettings> const& effects) {
  Pile pile(120);
  pile.checked.effects = effects;
  pile.rig.width = 200e-6;  // charge reaches a radius farther than touch
  return pile.run(alone(), 6000);
}

TEST(ContactEffects, LeaveEveryBitAtTheirNullValue) {
  omp_set_num_threads(1);
  PowderBed const without = spread({}), off = spread(all_effects(false, 1)), null = spread(all_effects(true, 0));
  EXPECT_EQ(differences(without, off), 0);
  EXPECT_EQ(differences(without, null), 0);
  auto effects = all_effects(false, 1);
  for (char const* name : {"capillary_bridge", "electrostatic_charge", "gas_drag"}) {
    effects[name].enabled = true;
    EXPECT_NE(differences(without, spread(effects)), 0) << name;
    effects[name].enabled = false;
  }
}

TEST(ContactEffects, WithoutCohesionIsTheCaseWithoutCohesion) {
  auto effects = all_effects(false, 1);
  effects["cohesion"].strength = 0;
  PowderBed const null = spread(effects);
  effects["cohesion"] = {false, 1, {}};
  EXPECT_EQ(differences(null, spread(effects)), 0);
  Pile pile(120);
  pile.checked.contact.cohesion = Cohesion::none;
  pile.rig.width = 200e-6;
  EXPECT_EQ(differences(null, pile.run(alone(), 6000)), 0);
}

TEST(ContactEffects, ScaleWhatTheCaseGives) {
  Case checked = small_case();
  checked.contact.wall_friction = 0.3;
  checked.effects = all_effects(false, 1);
  auto const contact = [&](char const* name, double strength) {
    Case changed = checked;
    changed.effects[name].strength = strength;
    return contact_with_effects(changed);
  };
  EXPECT_EQ(contact("rolling_resistance", 0).rolling_friction, 0);
  EXPECT_EQ(contact("rolling_resistance", 2).rolling_friction, 0.3);
  EXPECT_EQ(contact("wall_friction", 0).wall_friction, 0.7);
  EXPECT_EQ(contact("wall_friction", 1).wall_friction, 0.3);
  EXPECT_EQ(wall_law(contact("wall_cohesion", 0)).cohesion, 0);
  EXPECT_EQ(wall_law(contact("wall_cohesion", 2)).cohesion, 2 * wall_law(checked.contact).cohesion);
  EXPECT_EQ(grain_law(contact("cohesion", 3)).cohesion, 3 * grain_law(checked.contact).cohesion);
}

}  // namespace
}  // namespace layerloop::dem
