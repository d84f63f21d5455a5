#include "validation/blind/chain_formulas.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "validation/blind/pool_table.hpp"

namespace layerloop::validation {
namespace {

using enum ChainEffect;

// A steel like 316L and its powder.
constexpr double density = 7900, melting_point = 1700, latent_heat_of_fusion = 2.7e5, grain_diameter = 30e-6;
constexpr double keyhole_threshold =
    9;  ///< normalised enthalpy: King et al., J. Mater. Process. Technol. 214 (2014) 2915

/// max(x, 0) with a rounded corner of width `w`.
double ramp(double x, double w) { return 0.5 * (x + std::sqrt(x * x + w * w)); }

/// Loose packing at walls (blade and plate are a grain's size away), less with friction and with blade speed.
void spread(ChainInputs const& in, ChainStrengths const& s, ChainState& state) {
  double const speed = in.recoating_speed / 0.1;
  state.effective_thickness = in.layer_thickness * (1 + 0.12 * s[blade_compliance] * speed);
  double const grains = state.effective_thickness / grain_diameter;  // that lie on one another
  double const friction = in.sliding_friction - 0.5;
  double packing = 0.62 * (1 - 0.25 / grains) * (1 - 0.35 * friction) * std::pow(speed, -0.05);
  double open = 0.35 * std::exp(-0.5 * grains) * (1 + 0.5 * friction) * std::pow(speed, 0.2);  // share without grains
  // Adhesion over weight (Bond number) matters most where few grains weigh on one another.
  double const clumps = 0.16 * s[cohesion] / (grains * std::pow(speed, 0.15));
  double const locked = 0.12 * s[rolling_resistance] / std::pow(grains, 0.85) / std::pow(speed, 0.12);
  packing /= (1 + clumps) * (1 + locked);
  open *= (1 + 2 * clumps) * (1 + 2 * locked);
  packing *= 1 - 0.08 * s[wall_friction] * std::exp(-grains) * speed;
  open *= 1 + 1.0 * s[wall_friction] * std::exp(-0.5 * grains) * speed;
  open *=
      1 - s[wall_cohesion] / (2 + s[wall_cohesion]) / (1 + in.layer);  // grains stay where they touch the bare plate
  packing *= std::exp(-0.05 * s[capillary_bridge]);
  open *= 1 + 0.2 * s[capillary_bridge] / speed;
  packing *= std::exp(-0.04 * s[electrostatic_charge] * (1 - 0.5 / grains));
  open *= std::exp(-0.4 * s[electrostatic_charge]);  // like charges spread out
  packing *= 1 - 0.10 * s[gas_drag] * speed * speed / (4 + speed * speed);
  packing *= 1 + 0.05 * std::log1p(s[blade_vibration] / (1 + 2 * speed));  // compaction by taps: Knight et al. 1995
  packing *= 1 + 0.03 * s[youngs_modulus] * std::pow(speed, 0.3);
  packing /= 1 + 0.25 * s[shrinkage] * (1 - std::exp(-0.5 * (in.layer - 1))) / grains;
  state.relative_density = packing;
  state.surface_coverage = 1 - std::min(open, 0.98);
}

/// Temperature rise of the spot over that of melting, for a plate that is scanned fast.
double normalised_enthalpy(ChainInputs const& in, double absorptivity) {
  double const radius = 0.5 * in.spot_diameter, diffusivity = in.conductivity / (density * in.specific_heat);
  double const heat = density * in.specific_heat * (melting_point - in.ambient_temperature);
  return absorptivity * in.power /
         (std::numbers::pi * heat * std::sqrt(diffusivity * in.scan_speed * radius * radius * radius));
}

/// Share of a track that the one beside it has bared: within two spot diameters.
double bared_share(ChainInputs const& in) {
  return in.hatch_spacing > 0 ? 1 / (1 + std::pow(in.hatch_spacing / (2 * in.spot_diameter), 6)) : 0;
}

/// A grey cavity: light that grains reflect meets others, more often in beds that are dense and several grains deep.
void absorb(ChainInputs const& in, ChainStrengths const& s, ChainState& state) {
  double metal = in.absorptivity;
  bool const powder = in.layer_thickness > 0;
  double const energy = in.power / in.scan_speed / 250;
  if (powder) metal += 0.08 * s[surface_oxide] * (1 - metal) / (1 + energy * energy);  // burnt off by hot tracks
  metal *=
      1 + 0.03 * s[optical_temperature] * (normalised_enthalpy(in, metal) - 4) / (1 + 0.1 * s[optical_temperature]);
  double bounces = 0;
  if (powder) {
    double const depth = state.relative_density * state.effective_thickness / grain_diameter;
    bounces = 1.6 * (1 - std::exp(-0.9 * depth));
    bounces *= 1 + 0.5 * s[diffuse_scattering] * (state.relative_density / 0.5) * (state.relative_density / 0.5);
    bounces *= 1 - 0.8 * s[denudation] * bared_share(in);
    bounces *= state.surface_coverage;
  }
  double absorbed = metal * (1 + bounces) / (1 + metal * bounces);
  double const boiling = ramp(normalised_enthalpy(in, absorbed) / keyhole_threshold - 1, 0.1) - ramp(-1, 0.1);
  absorbed += (1 - absorbed) * (1 - std::exp(-0.15 * s[keyhole] * boiling));
  absorbed *= std::exp(-0.05 * s[plume_attenuation] * energy * energy);
  state.absorptivity = absorbed;
}

/// Eagar and Tsai's pool, reckoned from the plate: the powder above it is melted, and not counted in the depth.
void melt(ChainInputs const& in, ChainStrengths const& s, ChainState& state) {
  double const ambient =
      in.ambient_temperature + 40 * s[heat_accumulation] * std::sqrt(in.layer - 1) * (in.hatch_spacing > 0 ? 1.5 : 1);
  double const rise = melting_point - ambient, radius = 0.5 * in.spot_diameter;
  double const enthalpy = normalised_enthalpy(in, state.absorptivity);
  double const heat = density * (in.specific_heat + latent_heat_of_fusion * (1 + s[latent_heat]) / rise);
  double const conductivity = in.conductivity * (1 + 0.08 * s[variable_conductivity] * (enthalpy - 4));
  double power = in.power * state.absorptivity;
  power /= 1 + 0.03 * s[evaporation] * ramp(enthalpy - 6, 1);
  power *= 1 - 0.06 * s[surface_losses] * std::pow(0.8 / in.scan_speed, 1.5);
  DimensionlessPool const pool =
      dimensionless_pool(power / (conductivity * radius * rise), in.scan_speed * radius * heat / conductivity);
  double width = 2 * radius * pool.half_width, depth = radius * pool.depth;
  double const flow = ramp(enthalpy - 4, 1);  // the hotter the spot, the steeper the surface tension falls outwards
  width *= 1 + 0.015 * s[marangoni] * flow;
  depth /= 1 + 0.02 * s[marangoni] * flow;
  if (in.layer_thickness > 0) {
    double const powder = state.relative_density * state.effective_thickness;
    double const beside = 1 - 0.8 * s[denudation] * bared_share(in);
    depth -= 0.6 * powder * beside * (1 + 0.4 * s[shrinkage] * (1 - std::exp(-0.5 * (in.layer - 1))));
    width *= 1 - 0.12 * s[powder_conductivity] * state.relative_density * state.effective_thickness / 30e-6;
  }
  double const over = enthalpy / keyhole_threshold - 1;
  depth *= 1 + 0.4 * s[keyhole] * (ramp(over, 0.1) - ramp(-1, 0.1));
  constexpr double cell = 5e-6;  // errors of second order
  depth *= 1 + 8 * s[heat_cell_size] * (cell / depth) * (cell / depth);
  width *= 1 + 16 * s[heat_cell_size] * (cell / width) * (cell / width);
  state.pool_width = width, state.pool_depth = depth;
}

}  // namespace

ChainState chain_state(ChainInputs inputs, ChainStrengths const& strengths) {
  ChainState state;
  inputs.spot_diameter *= 1 + 0.15 * strengths[spot_drift] * inputs.beam_time;
  if (inputs.layer_thickness > 0) spread(inputs, strengths, state);
  absorb(inputs, strengths, state);
  melt(inputs, strengths, state);
  return state;
}

double ChainState::*chain_quantity(std::string const& name) {
  static std::map<std::string, double ChainState::*> const members{
      {"bed.relative_density", &ChainState::relative_density},
      {"bed.surface_coverage", &ChainState::surface_coverage},
      {"bed.effective_thickness", &ChainState::effective_thickness},
      {"absorptivity", &ChainState::absorptivity},
      {"pool.width", &ChainState::pool_width},
      {"pool.depth", &ChainState::pool_depth}};
  auto const found = members.find(name);
  return found == members.end() ? nullptr : found->second;
}

double ChainInputs::*chain_input(std::string const& key) {
  static std::map<std::string, double ChainInputs::*> const members{
      {"laser.power", &ChainInputs::power},
      {"scan.scan_speed", &ChainInputs::scan_speed},
      {"laser.spot_diameter", &ChainInputs::spot_diameter},
      {"machine.layer_thickness", &ChainInputs::layer_thickness},
      {"machine.recoating_speed", &ChainInputs::recoating_speed},
      {"heat.ambient_temperature", &ChainInputs::ambient_temperature},
      {"scan.hatch_spacing", &ChainInputs::hatch_spacing},
      {"laser.absorptivity", &ChainInputs::absorptivity},
      {"material.conductivity", &ChainInputs::conductivity},
      {"material.specific_heat", &ChainInputs::specific_heat},
      {"contact.sliding_friction", &ChainInputs::sliding_friction}};
  auto const found = members.find(key);
  return found == members.end() ? nullptr : found->second;
}

}  // namespace layerloop::validation
