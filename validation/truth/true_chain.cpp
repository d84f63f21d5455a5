#include "validation/truth/true_chain.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "validation/truth/true_pool.hpp"

namespace layerloop::validation {
namespace {

constexpr double density = 7900, melting_point = 1700, fusion = 2.7e5, grain = 30e-6;

/// One place of one condition.
struct Place {
  std::map<std::string, double> inputs{{"laser.power", 200},
                                       {"scan.scan_speed", 0.8},
                                       {"laser.spot_diameter", 80e-6},
                                       {"machine.layer_thickness", 0},
                                       {"machine.recoating_speed", 0.1},
                                       {"heat.ambient_temperature", 300},
                                       {"scan.hatch_spacing", 0},
                                       {"laser.absorptivity", 0.35},
                                       {"material.conductivity", 26},
                                       {"material.specific_heat", 720},
                                       {"contact.sliding_friction", 0.5}};
  double layer = 1, x = 0, y = 0;
  double order = 0;      ///< share of all conditions that came before
  double beam_time = 0;  ///< share of those of its build
  std::map<std::string, std::string> labels;

  double& operator[](std::string const& key) {
    auto const found = inputs.find(key);
    if (found == inputs.end()) throw std::invalid_argument("the world knows no " + key);
    return found->second;
  }
};

class Strengths {
 public:
  explicit Strengths(std::vector<HiddenCause> const& causes, double order) {
    for (HiddenCause const& cause : causes)
      if (order >= cause.from) values_[cause.name] += cause.strength;
  }
  double operator[](std::string const& name) const {
    auto const found = values_.find(name);
    return found == values_.end() ? 0 : found->second;
  }

 private:
  std::map<std::string, double> values_;
};

/// ln(1 + exp(x)), at sharpness c.
double corner(double x, double c) { return std::log1p(std::exp(-c * std::abs(x))) / c + std::max(x, 0.0); }

class World {
 public:
  World(Place place, Strengths strengths) : in(std::move(place)), s(std::move(strengths)) {
    disturb_machine();
    if (in["machine.layer_thickness"] > 0) spread();
    absorb();
    melt();
  }
  double packing = 0, open = 0, thickness = 0, absorbed = 0, width = 0, depth = 0;

 private:
  Place in;
  Strengths s;

  /// What happens before the chain begins, most of it in no catalogue.
  void disturb_machine() {
    double const along = in.x / 0.06, across = in.y / 0.06, built = (in.layer - 1) / 19;
    in["laser.power"] *= 1 - 0.1 * s["gas_flow"] * 0.25 * (1 + along) * (1 + along);
    in["laser.power"] *= 1 - 0.1 * s["power_drift"] * built;
    in["scan.scan_speed"] *= 1 - 0.25 * s["galvo_lag"] * std::pow(std::abs(across), 3);
    double const warm = (1 - std::exp(-1.5 * in.beam_time)) / 0.9;
    in["laser.spot_diameter"] *= 1 + 0.15 * s["spot_drift"] * warm;
    in["laser.spot_diameter"] *= 1 + 0.12 * s["focus_jump"];
    thickness = in["machine.layer_thickness"];
    if (thickness > 0) thickness += 10e-6 * s["substrate_tilt"] * across;
  }

  double other_lot() const {
    auto const lot = in.labels.find("lot");
    return s["lot_jump"] + (lot != in.labels.end() && lot->second == "L2" ? s["lot_change"] : 0);
  }

  void spread() {
    double const speed = in["machine.recoating_speed"] / 0.1, friction = in["contact.sliding_friction"] - 0.5;
    thickness *= 1 + 0.12 * s["blade_compliance"] * std::pow(speed, 0.8);
    double const n = thickness / grain;
    packing = 0.62 * (1 - 0.25 / n) * (1 - 0.35 * friction) * std::pow(speed, -0.05);
    open = 0.35 * std::exp(-0.5 * n) * (1 + 0.5 * friction) * std::pow(speed, 0.2);
    double const clumps = 0.8 * (1 - std::exp(-0.2 * s["cohesion"] / n)) * std::pow(speed, -0.2);
    packing *= 1 - clumps, open *= 1 + 2.3 * clumps;
    double const locked =
        0.7 * (1 - std::exp(-0.17 * s["rolling_resistance"] * std::pow(n, -0.8))) / std::pow(speed, 0.1);
    packing *= 1 - locked, open *= 1 + 2.3 * locked;
    packing *= std::exp(-0.08 * s["wall_friction"] * std::exp(-n) * std::pow(speed, 0.9));
    double const rubbed = 0.5 * s["wall_friction"] * std::exp(-0.5 * n) * std::pow(speed, 0.9);
    open *= (1 + rubbed) * (1 + rubbed);
    open *= 1 - 0.55 * (1 - std::exp(-0.5 * s["wall_cohesion"])) * std::pow(in.layer, -0.75);
    packing /= 1 + 0.05 * s["capillary_bridge"];
    open *= 1 + 0.2 * s["capillary_bridge"] * std::pow(speed, -0.8);
    packing /= 1 + 0.045 * s["electrostatic_charge"] * (1 - 0.6 / n);
    open /= 1 + 0.45 * s["electrostatic_charge"];
    packing *= 1 - 0.022 * s["gas_drag"] * std::pow(speed, 1.8) / (1 + 0.2 * speed * speed);
    packing *= std::pow(1 + s["blade_vibration"] / (1 + 2.5 * speed), 0.055);
    packing *= 1 + 0.03 * s["contact.youngs_modulus"] * std::pow(speed, 0.25);
    packing /= 1 + 0.25 * s["shrinkage"] * grown() / n;
    packing *= 1 - 0.05 * other_lot(), open *= 1 + 0.5 * other_lot();
    packing *= 1 - 0.08 * s["humidity"] * in.order;
    open = std::min(open, 0.98);
  }

  double grown() const { return 1 - std::pow(0.57, in.layer - 1); }

  double enthalpy(double absorptivity) {
    double const radius = 0.5 * in["laser.spot_diameter"], heat = density * in["material.specific_heat"];
    double const diffusivity = in["material.conductivity"] / heat;
    return absorptivity * in["laser.power"] /
           (std::numbers::pi * heat * (melting_point - in["heat.ambient_temperature"]) *
            std::sqrt(diffusivity * in["scan.scan_speed"] * std::pow(radius, 3)));
  }

  double bared() {
    double const apart = in["scan.hatch_spacing"] / (2 * in["laser.spot_diameter"]);
    return apart > 0 ? 0.5 * std::erfc(2.7 * (apart - 1)) : 0;
  }

  void absorb() {
    double metal = in["laser.absorptivity"], bounces = 0;
    double const energy = in["laser.power"] / in["scan.scan_speed"] / 250;
    bool const powder = thickness > 0;
    if (powder) metal += 0.08 * s["surface_oxide"] * (1 - metal) * std::exp(-0.7 * energy * energy);
    if (powder) metal += 0.02 * other_lot();
    metal *= 1 + 0.05 * s["optical_temperature"] * (std::pow(enthalpy(metal), 0.8) - 3.03) /
                     (1 + 0.1 * s["optical_temperature"]);
    if (powder) {
      bounces = 1.6 * (1 - std::exp(-0.9 * packing * thickness / grain)) * (1 - open);
      bounces *= 1 + 0.5 * s["diffuse_scattering"] * std::pow(packing / 0.5, 1.6);
      bounces *= 1 - 0.8 * s["denudation"] * bared();
    }
    absorbed = metal * (1 + bounces) / (1 + metal * bounces);
    double const boiling = corner(enthalpy(absorbed) / 9 - 1, 12);
    absorbed += (1 - absorbed) * 0.15 * s["keyhole"] * boiling / (1 + 0.15 * s["keyhole"] * boiling);
    absorbed /= 1 + 0.05 * s["plume_attenuation"] * std::pow(energy, 2.2);
  }

  void melt() {
    double ambient = in["heat.ambient_temperature"];
    ambient += 54 * s["heat_accumulation"] * std::log(in.layer) * (in["scan.hatch_spacing"] > 0 ? 1.5 : 1);
    double const rise = melting_point - ambient, radius = 0.5 * in["laser.spot_diameter"], h = enthalpy(absorbed);
    double const heat = density * (in["material.specific_heat"] + fusion * (1 + s["latent_heat"]) / rise);
    double const conductivity = in["material.conductivity"] * std::pow(h / 4, 0.45 * s["variable_conductivity"]);
    double power = in["laser.power"] * absorbed;
    power *= std::exp(-0.03 * s["evaporation"] * corner(h - 6, 1.5));
    power *= std::exp(-0.06 * s["surface_losses"] * std::pow(0.8 / in["scan.scan_speed"], 1.4));
    TruePool const pool =
        true_pool(power / (conductivity * radius * rise), in["scan.scan_speed"] * radius * heat / conductivity);
    width = 2 * radius * pool.half_width, depth = radius * pool.depth;
    double const flow = corner(h - 4, 1.2);
    width *= 1 + 0.015 * s["marangoni"] * flow, depth *= std::exp(-0.02 * s["marangoni"] * flow);
    if (thickness > 0) {
      double const powder = packing * thickness;
      depth -= 0.6 * powder * (1 - 0.8 * s["denudation"] * bared()) * (1 + 0.4 * s["shrinkage"] * grown());
      width *= std::exp(-0.115 * s["powder_conductivity"] * std::pow(powder / 30e-6, 0.9));
    }
    depth *= 1 + 0.4 * s["keyhole"] * corner(h / 9 - 1, 12);
    depth *= 1 + 4.5 * s["heat.cell_size"] * std::pow(5e-6 / depth, 1.8);
    width *= 1 + 8.5 * s["heat.cell_size"] * std::pow(5e-6 / width, 1.8);
  }
};

double read(World const& world, std::string const& quantity) {
  if (quantity == "pool.width") return world.width;
  if (quantity == "pool.depth") return world.depth;
  if (quantity == "absorptivity") return world.absorbed;
  if (quantity == "bed.relative_density") return world.packing;
  if (quantity == "bed.surface_coverage") return 1 - world.open;
  if (quantity == "bed.effective_thickness") return world.thickness;
  throw std::invalid_argument("the world knows no " + quantity);
}

/// Errors of inputs and readings, by the catalogue's words.
void bias_inputs(Place& place, std::vector<HiddenCause> const& causes) {
  static std::string const prefix = "error of ";
  for (HiddenCause const& cause : causes) {
    if (!cause.name.starts_with(prefix)) continue;
    if (!cause.label.empty() && place.labels["machine"] != cause.label) continue;
    place[cause.name.substr(prefix.size())] *= 1 + cause.strength;
  }
}

double misread(double value, std::string const& quantity, std::vector<HiddenCause> const& causes) {
  for (HiddenCause const& cause : causes) {
    if (cause.name == "scale of " + quantity) value *= 1 + cause.strength;
    if (cause.name == "offset of " + quantity) value += cause.strength * (quantity.starts_with("pool.") ? 4e-6 : 0.02);
  }
  return value;
}

std::vector<Place> places_of(Study const& study) {
  std::map<std::string, double> size, seen;
  std::vector<Place> places(study.conditions.size());
  for (Condition const& condition : study.conditions) size[condition.labels.at("build")] += 1;
  for (std::size_t c = 0; c < places.size(); ++c) {
    Condition const& condition = study.conditions[c];
    for (auto const& [key, value] : condition.inputs) places[c][key] = value;
    places[c].labels = condition.labels;
    places[c].order = static_cast<double>(c) / static_cast<double>(places.size());
    std::string const& build = condition.labels.at("build");
    places[c].beam_time = seen[build]++ / size[build];
  }
  return places;
}

}  // namespace

std::vector<ForeignCause> const& foreign_causes() {
  std::vector<std::string> const pool{"pool.width", "pool.depth", "everything"};
  std::vector<std::string> const bed{"bed.relative_density", "bed.surface_coverage", "everything"};
  static std::vector<ForeignCause> const causes{
      {"gas_flow", 5, {" x"}, pool},
      {"galvo_lag", 3, {" y"}, pool},
      {"power_drift", 5, {"layer"}, pool},
      {"substrate_tilt", 1.5, {" y"}, {"bed.relative_density", "bed.surface_coverage", "pool.depth", "everything"}},
      {"lot_change",
       4,
       {"lot", "build"},
       {"bed.relative_density", "bed.surface_coverage", "absorptivity", "everything"}},
      {"humidity", 4, {"order", "build", "condition"}, bed}};
  return causes;
}

Eigen::VectorXd true_values(Study const& study, Eigen::VectorXd const& calibration,
                            std::vector<HiddenCause> const& causes) {
  std::vector<Place> const places = places_of(study);
  Eigen::VectorXd values(static_cast<Eigen::Index>(study.observables.size()));
  std::map<std::pair<std::size_t, std::optional<int>>, World> worlds;
  for (std::size_t i = 0; i < study.observables.size(); ++i) {
    Observable const& seen = study.observables[i];
    auto found = worlds.find({seen.condition, seen.layer});
    if (found == worlds.end()) {
      Place place = places[seen.condition];
      place.layer = seen.layer.value_or(1), place.x = seen.x.value_or(0), place.y = seen.y.value_or(0);
      for (std::size_t k = 0; k < study.calibration.size(); ++k) {
        double& number = place[study.calibration[k].key];
        double const value = calibration[static_cast<Eigen::Index>(k)];
        number = study.calibration[k].relative ? number * (1 + value) : value;
      }
      bias_inputs(place, causes);
      Strengths const strengths(causes, place.order);
      found = worlds.try_emplace({seen.condition, seen.layer}, place, strengths).first;
    }
    values[static_cast<Eigen::Index>(i)] = misread(read(found->second, seen.quantity), seen.quantity, causes);
  }
  return values;
}

}  // namespace layerloop::validation
