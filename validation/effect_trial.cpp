#include <set>

#include "core/case_file.hpp"
#include "validation/effect_test.hpp"

namespace layerloop::validation {
namespace {

constexpr char const* metal_and_light = R"(
[case]
name = "trial of an effect"
seed = 3
[laser]
power = "60 W"
wavelength = "1070 nm"
spot_diameter = "60 um"
spot_definition = "1/e2"
[optics]
rays = 4000
[scan]
scan_speed = "0.6 m/s"
)";
constexpr char const* plate = R"(
kind = "track"
track_length = "200 um"
[powder]
material = "316L"
[heat]
cell_size = "5 um"
[effects.evaporation]
enabled = true
)";
constexpr char const* layers = R"(
kind = "hatch"
track_length = "80 um"
tracks = 2
hatch_spacing = "50 um"
[powder]
material = "316L"
basis = "number"
diameters = ["21 um", "28 um"]
fractions = [0.5, 0.5]
particles = 650
[contact]
youngs_modulus = "20 MPa"
poisson_ratio = 0.3
restitution = 0.7
sliding_friction = 0.5
rolling_friction = 0.1
cohesion = "none"
[machine]
layer_thickness = "80 um"
recoating_speed = "60 mm/s"
dose_factor = 1.0
accumulation_length = "300 um"
accumulation_depth = "60 um"
gap_length = "50 um"
deposition_length = "200 um"
width = "130 um"
blade_width = "50 um"
edge_radius = "5 um"
blade_clearance = "4 um"
[heat]
cell_size = "5 um"
substrate_depth = "60 um"
[run]
bins = 5
pictures = false
checkpoint = false
[effects.evaporation]
enabled = true
)";

/// What an effect needs beside it to act at all.
std::vector<std::string> partners_of(std::string const& name) {
  if (name == "wall_cohesion") return {"contact.cohesion=sjkr2", "contact.cohesion_energy_density=12500"};
  if (name == "evaporation") return {"laser.power=50"};  // without it the metal may not boil
  return {};
}

bool needs_layers(Effect const& effect) {
  static std::set<std::string> const names{"powder_conductivity", "heat_accumulation", "spot_drift",
                                           "diffuse_scattering"};
  return effect.stage == EffectStage::solid || names.contains(effect.name);
}

/// One other contact, and every grain takes another path: what grains do is averaged.
int seeds_for(Effect const& effect) { return effect.stage == EffectStage::dem ? 4 : 1; }

std::vector<std::string> joined(std::vector<std::string> first, std::vector<std::string> const& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

EffectTrial trial_of(Effect const& effect, std::vector<std::string> const& settings) {
  bool const grains = effect.stage == EffectStage::dem, layered = grains || needs_layers(effect);
  Process const process = grains ? Process::spreading : layered ? Process::melting : Process::exposing;
  std::string const text = std::string(metal_and_light) + (layered ? layers : plate);
  std::vector<std::string> own = partners_of(effect.name);
  if (!grains && layered) own.push_back("run.layers=2");
  return {[=](std::vector<std::string> const& set) {
            return case_of_text(text, "the built-in trial", joined(joined(own, settings), set), process);
          },
          seeds_for(effect)};
}

EffectTrial trial_of(Effect const& effect, std::string const& case_file, std::vector<std::string> const& settings) {
  Process const process = effect.stage == EffectStage::dem                                  ? Process::spreading
                          : read_case(case_file, settings, Process::exposing).has_machine() ? Process::melting
                                                                                            : Process::exposing;
  return {[=](std::vector<std::string> const& set) { return read_case(case_file, joined(settings, set), process); },
          seeds_for(effect)};
}

}  // namespace layerloop::validation
