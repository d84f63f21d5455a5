#pragma once
#include <array>
#include <cstddef>
#include <string>

namespace layerloop::validation {

/// What an observable's place in the design and the calibration say. SI.
struct ChainInputs {
  double power = 200, scan_speed = 0.8, spot_diameter = 80e-6;
  double layer_thickness = 0;  ///< 0: bare plate
  double recoating_speed = 0.1, ambient_temperature = 300;
  double hatch_spacing = 0;  ///< 0: one track
  double layer = 1;
  double beam_time = 0;  ///< share of the build that was exposed before
  double absorptivity = 0.35, conductivity = 26, specific_heat = 720, sliding_friction = 0.5;
};

/// Causes that act inside the chain.
enum class ChainEffect : std::size_t {
  cohesion,
  rolling_resistance,
  wall_friction,
  wall_cohesion,
  capillary_bridge,
  electrostatic_charge,
  gas_drag,
  blade_vibration,
  blade_compliance,
  surface_oxide,
  diffuse_scattering,
  optical_temperature,
  plume_attenuation,
  spot_drift,
  marangoni,
  latent_heat,
  variable_conductivity,
  evaporation,
  keyhole,
  powder_conductivity,
  heat_accumulation,
  surface_losses,
  denudation,
  shrinkage,
  heat_cell_size,
  youngs_modulus,
  count
};
constexpr std::size_t chain_effects = static_cast<std::size_t>(ChainEffect::count);

struct ChainStrengths {
  std::array<double, chain_effects> values{};
  double operator[](ChainEffect effect) const { return values[static_cast<std::size_t>(effect)]; }
};

/// What the chain says at one place of the design. SI; pool not a number where nothing melts.
struct ChainState {
  double relative_density = 0, surface_coverage = 0, effective_thickness = 0;
  double absorptivity = 0, pool_width = 0, pool_depth = 0;
};

ChainState chain_state(ChainInputs inputs, ChainStrengths const& strengths);

/// Member of the state by the quantity's name; none: nullptr.
double ChainState::*chain_quantity(std::string const& name);
/// Member of the inputs by the case's key; none: nullptr.
double ChainInputs::*chain_input(std::string const& key);

}  // namespace layerloop::validation
