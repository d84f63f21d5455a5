// What candidates do to a case: nothing at strength 0, and a case that is good at their prior scale.
#include "validation/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/case_file.hpp"

namespace layerloop::validation {
namespace {

std::string const light = R"(
[laser]
power = "100 W"
wavelength = "1070 nm"
spot_diameter = "60 um"
spot_definition = "1/e2"
[scan]
kind = "track"
scan_speed = "500 mm/s"
track_length = "300 um"
hatch_spacing = "50 um"
)";
std::string const plate = "[powder]\nmaterial = \"316L\"\n" + light;
std::string const powder = R"(
[case]
preset = "thesis"
[powder]
material = "316L"
particles = 1200
[contact]
cohesion = "none"
rolling_friction = 0
[machine]
layer_thickness = "50 um"
accumulation_length = "500 um"
deposition_length = "500 um"
accumulation_depth = "100 um"
blade_clearance = "10 um"
[heat]
cell_size = "5 um"
substrate_depth = "50 um"
)" + light;

struct Trial {
  std::string text;
  Process process;
  std::vector<std::string> quantities;
};

Study study_of(std::vector<std::string> const& quantities) {
  Study study;
  study.conditions = {{.id = "a"}};
  for (std::string const& quantity : quantities) study.observables.push_back({0, quantity});
  return study;
}

Case read(Trial const& trial, std::vector<std::string> const& settings = {}) {
  return case_of_text(trial.text, "trial.toml", settings, trial.process);
}

std::set<std::string> names_of(std::vector<Candidate> const& candidates) {
  std::set<std::string> names;
  for (Candidate const& c : candidates) names.insert(c.name);
  return names;
}

std::vector<Trial> const trials{
    {plate, Process::exposing, {"pool.width", "pool.depth", "absorptivity"}},
    {powder, Process::exposing, {"pool.depth", "absorptivity"}},
    {powder, Process::spreading, {"bed.relative_density", "bed.roughness_sa"}},
    {powder, Process::calibrating, {"pile.angle_of_repose", "plate.slipping_angle"}},
    {powder, Process::absorbing, {"absorptivity"}},
    {powder, Process::melting, {"part.relative_density"}},
};

TEST(Candidates, DoNothingAtNullAndGiveAGoodCaseAtTheirPriorScale) {
  for (Trial const& trial : trials) {
    Case const base = read(trial);
    std::string const before = resolved_toml(base);
    for (Candidate const& c : candidates_for(study_of(trial.quantities), base)) {
      EXPECT_TRUE(settings_of(c, 0, base).empty()) << c.name;
      EXPECT_GT(c.prior_scale, 0) << c.name;
      for (double const strength : {c.prior_scale, c.two_sided ? -c.prior_scale : 0.5 * c.prior_scale}) {
        std::vector<std::string> const settings = settings_of(c, strength, base);
        if (c.kind == EffectClass::instrument && !c.quantities.empty()) {
          EXPECT_TRUE(settings.empty()) << c.name;
          continue;
        }
        ASSERT_FALSE(settings.empty()) << c.name;
        EXPECT_TRUE(resolved_toml(read(trial, settings)) != before) << c.name << " at " << strength;
      }
    }
  }
}

TEST(Candidates, AreThoseThatTheQuantitiesSee) {
  auto const names = [](std::size_t trial) {
    return names_of(candidates_for(study_of(trials[trial].quantities), read(trials[trial])));
  };
  std::set<std::string> const on_plate = names(0), on_powder = names(1), beds = names(2), piles = names(3);
  EXPECT_TRUE(on_plate.contains("keyhole") && on_plate.contains("heat.cell_size") && on_plate.contains("laser.power"));
  EXPECT_FALSE(on_plate.contains("cohesion") || on_plate.contains("powder_conductivity"));
  EXPECT_TRUE(on_powder.contains("cohesion") && on_powder.contains("powder_conductivity"));
  EXPECT_TRUE(beds.contains("blade_vibration") && beds.contains("contact.youngs_modulus"));
  EXPECT_FALSE(beds.contains("keyhole") || beds.contains("surface_oxide"));
  EXPECT_TRUE(piles.contains("rolling_resistance"));
  EXPECT_FALSE(piles.contains("blade_vibration"));
  EXPECT_TRUE(names(4).contains("diffuse_scattering")) << "on by default, of a share of 0";
  EXPECT_FALSE(names(0).contains("variable_conductivity")) << "all of it is there";
  EXPECT_TRUE(names(5).contains("denudation") && names(5).contains("heat_accumulation"));
}

TEST(Candidates, WhatCannotBeTestedHasAReason) {
  Study const study = study_of({"pool.depth"});
  Case const base = read({plate + "\n", Process::exposing, {}}, {"laser.absorptivity=0.35"});
  std::set<std::string> const offered = names_of(candidates_for(study, base));
  std::vector<Untestable> const rest = untestable_effects(study, base);
  for (Effect const& effect : effect_catalogue()) {
    auto const untestable = std::ranges::find(rest, effect.name, &Untestable::name);
    EXPECT_NE(offered.contains(effect.name), untestable != rest.end()) << effect.name;
  }
  auto const oxide = std::ranges::find(rest, "surface_oxide", &Untestable::name);
  ASSERT_NE(oxide, rest.end());
  EXPECT_EQ(oxide->why, "laser.absorptivity is given as a number, so that no light is traced");
}

/// What the case lacks is physics; what it holds already is a number that may be off.
TEST(Candidates, ClassTellsWhetherTheCaseHasTheEffect) {
  Study const study = study_of({"bed.relative_density"});
  auto const cohesion = [&](std::vector<std::string> const& settings) {
    Case const base = read(trials[2], settings);
    std::vector<Candidate> const all = candidates_for(study, base);
    return *std::ranges::find(all, "cohesion", &Candidate::name);
  };
  EXPECT_EQ(cohesion({}).kind, EffectClass::physics);
  EXPECT_FALSE(cohesion({}).two_sided);
  Candidate const held = cohesion({"contact.cohesion=sjkr2"});
  EXPECT_EQ(held.kind, EffectClass::calibration);
  EXPECT_TRUE(held.two_sided);
  EXPECT_EQ(settings_of(held, 0.5, read(trials[2], {"contact.cohesion=sjkr2"})).back(),
            "effects.cohesion.strength=1.5");
}

/// Pull-off force of SJKR2 (16 pi^3/3) k^3 R^2 / E^2, R the reduced radius and E the reduced modulus: ten weights of
/// the grain of mean volume at strength 1, whatever the stiffness.
TEST(Candidates, NewCohesionIsABondNumberAtAnyStiffness) {
  Candidate const c{"cohesion", EffectStage::dem};
  for (char const* modulus : {"0.2e9", "1.6e9"}) {
    Case const base = read(trials[2], {std::string("contact.youngs_modulus=") + modulus});
    double volume = 0;
    for (std::size_t i = 0; i < base.powder.diameters.size(); ++i)
      volume += base.powder.fractions[i] * std::numbers::pi / 6 * std::pow(base.powder.diameters[i], 3);
    double const r = std::cbrt(volume * 3 / (4 * std::numbers::pi)), weight = base.material.density * volume * 9.81;
    double const E = 0.5 * base.contact.youngs_modulus / (1 - 0.3 * 0.3);
    for (double const strength : {0.5, 1.0, 3.0}) {
      double const k = read(trials[2], settings_of(c, strength, base)).contact.cohesion_energy_density;
      double const force = 16 * std::pow(std::numbers::pi, 3) / 3 * k * k * k * std::pow(0.5 * r, 2) / (E * E);
      EXPECT_NEAR(force / weight, 10 * strength, 0.01 * strength);
    }
  }
}

/// Powder keeps its mass when fines join it.
TEST(Candidates, FinesReplaceCoarseGrainsByMass) {
  Trial const& spread = trials[2];
  Case const base = read(spread);
  std::vector<Candidate> const all = candidates_for(study_of(spread.quantities), base);
  Candidate const fines = *std::ranges::find(all, "fines", &Candidate::name);
  Case const finer = read(spread, settings_of(fines, 1, base));
  auto const volume = [](Case const& c) {
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < c.powder.diameters.size(); ++i) {
      sum += c.powder.fractions[i] * std::pow(c.powder.diameters[i], 3);
      weight += c.powder.fractions[i];
    }
    return static_cast<double>(c.powder.particles) * sum / weight;
  };
  Case mixed = finer;  // 2 % by mass of 8 um beside the sizes of the case
  double const coarse = volume(base) / static_cast<double>(base.powder.particles), fine = std::pow(8e-6, 3);
  double const share = 0.02 / 0.98 * coarse / fine;  // fines for every coarse grain
  double const total = static_cast<double>(mixed.powder.particles) / (1 + share) * (coarse + share * fine);
  EXPECT_NEAR(total / volume(base), 1, 1e-3);
}

TEST(Candidates, InstrumentsActOnReadingsOfTheirQuantity) {
  Study const study = study_of({"pool.depth", "pool.width"});
  std::vector<Candidate> const candidates{
      {"offset of pool.depth", EffectStage::heat, EffectClass::instrument, 1, 10, true, "", {"pool.depth"}},
      {"scale of pool.width", EffectStage::heat, EffectClass::instrument, 1, 10, true, "", {"pool.width"}}};
  Eigen::VectorXd values(2), strengths(2);
  values << 50e-6, 100e-6;
  strengths << -2, 1;
  apply_instruments(study, candidates, strengths, values);
  EXPECT_DOUBLE_EQ(values[0], 42e-6);
  EXPECT_DOUBLE_EQ(values[1], 105e-6);
}

TEST(Catalogue, HoldsAtLeastTwentyPhysicalEffectsOverAllStages) {
  std::set<EffectStage> stages;
  int physics = 0;
  for (Effect const& effect : effect_catalogue()) {
    if (effect.kind != EffectClass::physics) continue;
    ++physics;
    stages.insert(effect.stage);
  }
  EXPECT_GE(physics, 20);
  EXPECT_EQ(stages.size(), 4u);
}

}  // namespace
}  // namespace layerloop::validation
