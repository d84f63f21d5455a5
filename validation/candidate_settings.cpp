#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/grain_size.hpp"
#include "coupling/melt_plate.hpp"
#include "dem/contact_law.hpp"
#include "dem/softening.hpp"
#include "validation/candidates.hpp"
#include "validation/held_strength.hpp"

namespace layerloop::validation {
namespace {

using Settings = std::vector<std::string>;

std::string set(std::string const& key, double value) { return fmt::format("{}={}", key, value); }

Settings switched_on(Effect const& effect, double strength) {
  std::string const table = "effects." + effect.name;
  return {table + ".enabled=true", set(table + ".strength", std::clamp(strength, 0.0, effect.largest_strength))};
}

/// What an effect stands for where the case gives it nothing to act with, at strength 1.
constexpr double reference_bond_number = 10;  ///< pull-off force over the weight of a mean grain
constexpr double reference_rolling_friction = 0.2;
constexpr double reference_oxide = 10e-9;  ///< [m], some times the native film

/// Cohesion where there is none: SJKR2 whose pull-off force, which goes as the cube of the energy density, is
/// `strength` times the reference for the grain of mean volume.
Settings new_cohesion(double strength, Case const& base) {
  ContactSettings contact = base.contact;
  contact.cohesion = Cohesion::sjkr2;
  contact.cohesion_energy_density = 1;
  double const radius = 0.5 * std::cbrt(mean_grain_volume(base.powder) * 6 / std::numbers::pi);
  double const wanted = std::max(0.0, strength) * reference_bond_number;
  double const energy = std::cbrt(wanted / dem::bond_number(radius, base.material.density, contact));
  return {"contact.cohesion=sjkr2", set("contact.cohesion_energy_density", energy)};
}

/// Fines join the powder: the grains that are fed become more, so that their mass stays.
Settings with_fines(Effect const& effect, double strength, Case const& base) {
  Settings settings = switched_on(effect, strength);
  if (base.powder.particles == 0 || base.powder.diameters.empty()) return settings;
  Case finer = base;
  finer.effects["fines"].enabled = true;
  finer.effects["fines"].strength = strength;
  for (EffectParameter const& p : effect.parameters)
    finer.effects["fines"].parameters[p.name] = effect_parameter(base.effects, "fines", p.name);
  double const factor = mean_grain_volume(fed_powder(base)) / mean_grain_volume(fed_powder(finer));
  settings.push_back(
      fmt::format("powder.particles={}", std::llround(static_cast<double>(base.powder.particles) * factor)));
  return settings;
}

/// Effects that are switched on by default, and act once the case has what they scale.
Settings partner_settings(Effect const& effect, double strength, Case const& base) {
  std::string const& name = effect.name;
  if (name == "cohesion" && base.contact.cohesion == Cohesion::none) {
    Settings settings = switched_on(effect, 1), law = new_cohesion(strength, base);
    settings.insert(settings.end(), law.begin(), law.end());
    return settings;
  }
  double share = 0;
  std::string key;
  if (name == "rolling_resistance" && base.contact.rolling_friction == 0) {
    key = "contact.rolling_friction", share = strength * reference_rolling_friction;
  } else if (name == "wall_friction" && base.contact.wall_friction == base.contact.sliding_friction) {
    key = "contact.wall_friction", share = (1 + strength) * base.contact.sliding_friction;
  } else if (name == "surface_oxide" && base.optics.oxide_thickness == 0) {
    key = "optics.oxide_thickness", share = strength * reference_oxide;
  } else if (name == "diffuse_scattering") {
    key = "optics.diffuse_share", share = base.optics.diffuse_share * base.effect_strength(name) + strength;
  } else {
    return {};
  }
  Settings settings = switched_on(effect, 1);
  settings.push_back(set(key, std::max(0.0, share)));
  return settings;
}

/// What the case holds of an effect counts only where it acts (rolling friction 0 has strength 1 of nothing).
Settings effect_settings(Effect const& effect, double strength, Case const& base) {
  if (effect.name == "fines") return with_fines(effect, held_strength(effect, base) + strength, base);
  if (Settings const partner = partner_settings(effect, strength, base); !partner.empty()) return partner;
  bool const cold_optics = effect.name == "optical_temperature" && base.optics.temperature == 300;
  if (!cold_optics) return switched_on(effect, held_strength(effect, base) + strength);
  Settings settings = switched_on(effect, strength);
  settings.push_back(set("optics.temperature", base.material.liquidus));
  return settings;
}

/// The cells that a plate would have by itself, made larger; those of a machine have to divide its width and
/// length, so that they change by steps.
Settings resized_cells(double factor, Case const& base) {
  bool const machine = base.has_machine();
  Case const placed = machine ? base : coupling::with_plate(base, coupling::estimate_pool(base));
  double const wanted = placed.heat.cell_size * factor;
  if (!machine) return {set("heat.cell_size", std::min(wanted, base.laser.spot_radius()))};
  double const width = base.machine.width, length = base.machine.deposition_length;
  double best = placed.heat.cell_size;
  for (double n = 1; n <= width / (0.5 * wanted); ++n) {
    double const cell = width / n, along = length / cell;
    bool const divides = std::abs(along - std::round(along)) < 1e-7 * along;
    if (divides && std::abs(std::log(cell / wanted)) < std::abs(std::log(best / wanted))) best = cell;
  }
  return {set("heat.cell_size", best)};
}

Settings key_settings(std::string const& key, double strength, Case const& base) {
  if (key == "heat.cell_size") return resized_cells(std::pow(1.5, strength), base);
  if (key == "optics.rays")
    return {fmt::format("{}={}", key, std::llround(static_cast<double>(base.optics.rays) * std::pow(4, strength)))};
  if (key == "contact.time_step_fraction") return {set(key, base.contact.time_step_fraction * std::pow(0.7, strength))};
  if (key == "contact.youngs_modulus") {
    double const factor = std::pow(2, strength);
    Settings settings{set(key, base.contact.youngs_modulus * factor)};
    if (base.contact.cohesion == Cohesion::sjkr || base.contact.cohesion == Cohesion::sjkr2)
      settings.push_back(set("contact.cohesion_energy_density",
                             dem::scale_cohesion(base.contact.cohesion_energy_density, factor).same_pull_off));
    return settings;
  }
  if (key == "laser.power") return {set(key, base.laser.power * (1 + strength))};
  if (key == "laser.spot_diameter") return {set(key, base.laser.spot_diameter * (1 + strength))};
  if (key == "scan.scan_speed") return {set(key, base.scan.scan_speed * (1 + strength))};
  throw std::out_of_range("no candidate " + key);
}

}  // namespace

std::vector<std::string> settings_of(Candidate const& candidate, double strength, Case const& base) {
  if (strength == 0 || !candidate.quantities.empty()) return {};
  auto const effect = std::ranges::find(effect_catalogue(), candidate.name, &Effect::name);
  if (effect != effect_catalogue().end()) return effect_settings(*effect, strength, base);
  if (auto const modifier = base.modifiers.find(candidate.name); modifier != base.modifiers.end()) {
    std::string const table = "modifiers." + candidate.name;
    double const held = modifier->second.enabled ? modifier->second.strength : 0;
    return {table + ".enabled=true", set(table + ".strength", held + strength)};
  }
  return key_settings(candidate.name, strength, base);
}

}  // namespace layerloop::validation
