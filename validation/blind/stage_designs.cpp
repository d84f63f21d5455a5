#include <array>

#include "validation/blind/stage_design.hpp"

namespace layerloop::validation {
namespace {

using enum ScenarioClass;

/// Soft and few grains, so that a bed takes 0.4 s.
constexpr auto powder_case = R"([powder]
material = "316L"
basis = "number"
diameters = ["24 um", "30 um"]
fractions = [0.5, 0.5]
particles = 110

[contact]
youngs_modulus = "4 MPa"
poisson_ratio = 0.3
restitution = 0.6
sliding_friction = 0.5
rolling_friction = 0
cohesion = "none"

[machine]
layer_thickness = "70 um"
recoating_speed = "20 mm/s"
accumulation_length = "150 um"
accumulation_depth = "50 um"
gap_length = "30 um"
deposition_length = "168 um"
width = "120 um"
blade_width = "50 um"
edge_radius = "5 um"
blade_clearance = "5 um"
)";

/// Piles and tilted plates of few grains, so that both take a second.
constexpr auto pile_case = R"([powder]
material = "316L"
basis = "number"
diameters = ["24 um", "30 um"]
fractions = [0.5, 0.5]

[contact]
youngs_modulus = "4 MPa"
poisson_ratio = 0.3
restitution = 0.5
sliding_friction = 0.5
rolling_friction = 0
cohesion = "none"

[calibrate]
base_diameter = "320 um"
pile_particles = 400
plate_length = "240 um"
plate_particles = 230
tilt_rate = "1.2 deg/ms"
tilt_from = "6 deg"
settling_time = "6 ms"
)";

constexpr auto laser_case = R"(
[laser]
power = "60 W"
wavelength = "1070 nm"
spot_diameter = "60 um"
spot_definition = "1/e2"
)";

constexpr auto even_light_case = R"(
[optics]
uniform_beam = true
rays = 4000

[absorb]
bed = "spread"
target_standard_error = 0.003
)";

constexpr auto run_case = R"(
[run]
layers = 1
bins = 4
pictures = false
)";

constexpr auto powder_track_case = R"(
[optics]
rays = 1000

[scan]
kind = "track"
scan_speed = "800 mm/s"
track_length = "90 um"

[heat]
cell_size = "8 um"
substrate_depth = "60 um"

[effects.evaporation]
enabled = true
)";

constexpr auto plate_track_case = R"([powder]
material = "316L"

[laser]
power = "100 W"
wavelength = "1070 nm"
spot_diameter = "80 um"
spot_definition = "1/e2"
absorptivity = 0.35

[scan]
kind = "track"
scan_speed = "800 mm/s"
track_length = "360 um"

[heat]
cell_size = "8 um"

[effects.evaporation]
enabled = true

[effects.latent_heat]
enabled = false

[effects.variable_conductivity]
enabled = false
)";

using Conditions = std::vector<std::map<std::string, double>>;

Conditions beds(std::vector<std::pair<double, double>> const& thickness_and_speed) {
  Conditions all;
  for (auto const& [thickness, speed] : thickness_and_speed)
    all.push_back({{"machine.layer_thickness", thickness}, {"machine.recoating_speed", speed}});
  return all;
}

/// Every bed under every light.
Conditions under(Conditions const& beds, Conditions const& lights) {
  Conditions all;
  for (auto const& bed : beds)
    for (auto const& light : lights) {
      all.push_back(bed);
      all.back().insert(light.begin(), light.end());
    }
  return all;
}

std::vector<std::string> const bed_keys{"machine.layer_thickness", "machine.recoating_speed"};

StageDesign powder() {
  return {.name = "powder",
          .case_text = powder_case + std::string(run_case),
          .conditions = beds({{70e-6, 0.018},
                              {70e-6, 0.024},
                              {70e-6, 0.030},
                              {100e-6, 0.018},
                              {100e-6, 0.024},
                              {100e-6, 0.030},
                              {85e-6, 0.021},
                              {85e-6, 0.027}}),
          .bed_keys = bed_keys,
          .held_out = 2,
          .instruments = {{"bed.effective_thickness", "", 1e-6, 0, 3.5e-6, true, 2},
                          {"bed.relative_density", "", 0.01, 0, 0.035, true, 2},
                          {"bed.surface_coverage", "", 0.008, 0, 0.02, true, 2},
                          {"bed.roughness_sa", "", 0.4e-6, 0, 1.5e-6, true, 2}},
          .calibration = {{"contact.sliding_friction", "contact.sliding_friction", 0.5, 0.08}},
          .beds = 2,
          .measured_beds = 3,
          .true_resolution = {{"contact.time_step_fraction", 0.12}},
          .classes = {one_effect, nothing, one_effect, real_life, one_effect, one_effect, one_effect, real_life,
                      one_effect, one_effect, one_effect, one_effect, one_effect},
          .hidden_effects = {"cohesion", "rolling_resistance", "electrostatic_charge", "gas_drag"},
          .biased_inputs = {"machine.layer_thickness", "machine.recoating_speed"},
          .foreign_causes = {{"lot_change", 5, {"lot", "build"}, {"bed.", "everything"}}},
          .jumps = {{"lot_jump", 5, {}, {}}}};
}

StageDesign piles() {
  Conditions conditions;
  for (double const base : {320e-6, 370e-6, 420e-6})
    for (double const friction : {0.4, 0.6})
      conditions.push_back({{"calibrate.base_diameter", base}, {"contact.sliding_friction", friction}});
  return {.name = "piles",
          .case_text = pile_case,
          .conditions = conditions,
          .bed_keys = {"calibrate.base_diameter", "contact.sliding_friction"},
          .held_out = 1,
          .instruments = {{"pile.angle_of_repose", "", 0.012, 0, 0.045, true, 2},
                          {"plate.slipping_angle", "", 0.006, 0, 0.015, true, 2}},
          .calibration = {{"contact.restitution", "contact.restitution", 0.5, 0.1}},
          .beds = 2,
          .measured_beds = 3,
          .true_resolution = {{"contact.time_step_fraction", 0.12}},
          .classes = {one_effect, nothing, one_effect, real_life, one_effect, one_effect},
          .hidden_effects = {"rolling_resistance", "cohesion"},
          .biased_inputs = {"contact.sliding_friction"},
          .foreign_causes = {},
          .jumps = {{"lot_jump", 5, {}, {}}}};
}

StageDesign light() {
  return {.name = "light",
          .case_text = powder_case + std::string(laser_case) + even_light_case + run_case,
          .conditions = under(beds({{70e-6, 0.018}, {70e-6, 0.027}, {100e-6, 0.024}, {85e-6, 0.021}}),
                              {{{"laser.wavelength", 1070e-9}, {"laser.incidence_angle", 0}},
                               {{"laser.wavelength", 1070e-9}, {"laser.incidence_angle", 0.4}},
                               {{"laser.wavelength", 780e-9}, {"laser.incidence_angle", 0}},
                               {{"laser.wavelength", 515e-9}, {"laser.incidence_angle", 0}}}),
          .bed_keys = bed_keys,
          .held_out = 4,
          .instruments = {{"absorptivity", "", 0.006, 0, 0.012, false, 2},
                          {"bed.effective_thickness", "", 1e-6, 0, 3.5e-6, true, 2},
                          {"bed.surface_coverage", "", 0.008, 0, 0.02, true, 2}},
          .calibration = {{"error of laser.incidence_angle", "laser.incidence_angle", 0, 0.1, true}},
          .beds = 2,
          .measured_beds = 3,
          .true_resolution = {{"contact.time_step_fraction", 0.12}, {"optics.rays", 16000}},
          .classes = {one_effect, nothing, one_effect, real_life, one_effect, one_effect, not_physics, one_effect,
                      real_life, one_effect, foreign_cause, one_effect, one_effect, real_life, one_effect, one_effect},
          .hidden_effects = {"surface_oxide", "diffuse_scattering"},
          .biased_inputs = {"laser.incidence_angle"},
          .foreign_causes = {{"lot_change", 5, {"lot", "build"}, {"absorptivity", "everything"}}},
          .jumps = {{"lot_jump", 5, {}, {}}}};
}

StageDesign tracks() {
  Conditions conditions;
  std::vector<std::array<double, 3>> const lines{// W, m/s, um
                                                 {90, 0.4, 80},   {70, 0.4, 60},   {110, 0.7, 80},  {140, 0.7, 80},
                                                 {105, 1.0, 60},  {165, 1.0, 80},  {130, 1.3, 60},  {195, 1.3, 80},
                                                 {130, 0.5, 120}, {170, 0.5, 120}, {170, 0.9, 120}, {215, 0.9, 120},
                                                 {95, 0.5, 80},   {90, 0.6, 60},   {165, 1.15, 80}, {190, 0.7, 120}};
  for (auto const& [power, speed, spot] : lines)
    conditions.push_back({{"laser.power", power}, {"scan.scan_speed", speed}, {"laser.spot_diameter", 1e-6 * spot}});
  return {.name = "tracks",
          .case_text = plate_track_case,
          .conditions = conditions,
          .bed_keys = {},
          .held_out = 4,
          .instruments = {{"pool.width", "sections", 1.5e-6, 0.01, 0, false, 3},
                          {"pool.depth", "sections", 1e-6, 0.01, 0, false, 3},
                          {"pool.length", "camera", 4e-6, 0.01, 0, false, 2}},
          .calibration = {{"laser.absorptivity", "laser.absorptivity", 0.35, 0.035},
                          {"error of laser.spot_diameter", "laser.spot_diameter", 0, 0.04, true}},
          .beds = 1,
          .measured_beds = 1,
          .true_resolution = {{"heat.cell_size", 6e-6}},
          .classes = {one_effect, nothing, one_effect, real_life, wrong_calibration, one_effect, foreign_cause,
                      not_physics, real_life, one_effect, nothing, foreign_cause, real_life, wrong_calibration},
          .hidden_effects = {"marangoni", "latent_heat", "variable_conductivity", "plume_attenuation"},
          .biased_inputs = {"laser.power", "scan.scan_speed", "laser.spot_diameter"},
          .foreign_causes = {{"power_drift", 4, {"order", "build", "condition"}, {"pool.", "everything"}},
                             {"dirty_window", 4, {"machine"}, {"pool.", "everything"}}},
          .jumps = {{"focus_jump", 2, {}, {}}}};
}

StageDesign layer() {
  return {.name = "layer",
          .case_text = powder_case + std::string(laser_case) + powder_track_case + run_case,
          .conditions = under(beds({{55e-6, 0.018}, {55e-6, 0.027}, {80e-6, 0.024}, {70e-6, 0.021}}),
                              {{{"laser.power", 45}, {"scan.scan_speed", 0.8}, {"laser.spot_diameter", 60e-6}},
                               {{"laser.power", 70}, {"scan.scan_speed", 1.2}, {"laser.spot_diameter", 64e-6}}}),
          .bed_keys = bed_keys,
          .held_out = 2,
          .instruments = {{"pool.width", "", 2.5e-6, 0, 6e-6, false, 2},
                          {"pool.length", "", 4e-6, 0, 8e-6, false, 2},
                          {"absorptivity", "", 0.01, 0, 0.02, false, 2},
                          {"bed.effective_thickness", "", 1e-6, 0, 3.5e-6, true, 2}},
          .calibration = {{"error of laser.spot_diameter", "laser.spot_diameter", 0, 0.04, true}},
          .beds = 2,
          .measured_beds = 3,
          .true_resolution = {{"contact.time_step_fraction", 0.12}, {"heat.cell_size", 6e-6}},
          .classes = {one_effect, nothing, one_effect, real_life, one_effect, one_effect},
          .hidden_effects = {"cohesion", "surface_oxide", "rolling_resistance", "diffuse_scattering"},
          .biased_inputs = {"laser.power", "scan.scan_speed", "laser.spot_diameter"},
          .foreign_causes = {{"dirty_window", 4, {"machine"}, {"pool.", "everything"}}},
          .jumps = {{"focus_jump", 2, {}, {}}, {"lot_jump", 5, {}, {}}}};
}

}  // namespace

std::vector<StageDesign> const& stage_designs() {
  static std::vector<StageDesign> const all{powder(), piles(), light(), tracks(), layer()};
  return all;
}

}  // namespace layerloop::validation
