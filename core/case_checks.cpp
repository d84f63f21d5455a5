#include "core/case_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "core/grain_size.hpp"
#include "core/modifier.hpp"
#include "core/rayleigh_time.hpp"
#include "core/units.hpp"

namespace layerloop {
namespace {

constexpr double pi = std::numbers::pi;

std::string length(double metres) { return format_quantity(metres, Dimension::length); }

bool divides(double cell, double extent) {
  double const cells = extent / cell;
  return std::round(cells) >= 1 && std::abs(cells - std::round(cells)) < 1e-6 * cells;
}

/// One method a group of checks; `known` guards each against values that are wrong by themselves.
class CaseChecks {
 public:
  CaseChecks(Case const& c, CaseOrigin const& origin) : c_(c), origin_(origin) {}

  void run() const {
    powder();
    mixture();
    pairs();
    effects();
    time_step();
    energy_ledger();
    modifiers();
    material();
    calibrate();
    if (c_.has_light()) light();
    if (c_.has_laser()) isotherm();
    if (c_.process == Process::exposing) plate();
    if (!c_.has_machine()) return;
    feed();
    piston();
    machine();
    frozen_zone();
    cells();
    if (!c_.has_laser()) return;
    scan();
    beam();
    optics();
  }

 private:
  bool known(std::initializer_list<char const*> keys) const {
    return std::all_of(keys.begin(), keys.end(), [this](char const* key) { return origin_.sound(key); });
  }

  template <class... Values>
  void report(char const* key, fmt::format_string<Values...> text, Values&&... values) const {
    origin_.report(key, fmt::format("{} {}", key, fmt::format(text, std::forward<Values>(values)...)));
  }

  double largest() const { return std::ranges::max(fed_powder(c_).diameters); }
  double smallest() const { return std::ranges::min(fed_powder(c_).diameters); }
  bool distribution_known() const {
    return known({"powder.diameters", "powder.fractions", "effects.fines.strength", "effects.fines.mass_fraction",
                  "effects.fines.diameter"}) &&
           !c_.powder.diameters.empty() && c_.powder.diameters.size() == c_.powder.fractions.size() &&
           fines_share() < 1;
  }

  double fines_share() const {
    double const strength = c_.effect_strength("fines");
    return strength > 0 ? strength * c_.effects.at("fines").parameters.at("mass_fraction") : 0.0;
  }

  void effects() const {
    if (known({"effects.fines.strength", "effects.fines.mass_fraction"}) && fines_share() >= 1)
      report("effects.fines.strength", "makes {:g} of the powder's mass fines (must be below 1)", fines_share());
    double const strength = c_.effect_strength("blade_vibration");
    if (strength == 0 || !known({"effects.blade_vibration.strength", "effects.blade_vibration.amplitude",
                                 "effects.blade_vibration.frequency", "machine.blade_clearance"}))
      return;
    double const amplitude = strength * c_.effects.at("blade_vibration").parameters.at("amplitude");
    if (amplitude > c_.machine.blade_clearance) {
      report("effects.blade_vibration.amplitude",
             "= {} (the recoater would strike the platforms) raise machine.blade_clearance from {} to at least that",
             length(amplitude), length(c_.machine.blade_clearance));
    }
  }

  /// The piston must not come up to the platforms before the last layer.
  void piston() const {
    MachineSettings const& m = c_.machine;
    if (m.dosing != Dosing::feed ||
        !known({"machine.dosing", "machine.dose_factor", "machine.layer_thickness", "machine.deposition_length",
                "machine.accumulation_length", "machine.accumulation_depth", "run.layers"}))
      return;
    double const risen = static_cast<double>(c_.run.layers - 1) * m.feed_rise();
    if (risen > m.accumulation_depth) {
      report("machine.accumulation_depth",
             "= {} (the piston rises by {} for each of {} layers and would stand above the platforms) deepen the zone, "
             "or lower machine.dose_factor or run.layers",
             length(m.accumulation_depth), length(m.feed_rise()), c_.run.layers);
    }
  }

  void powder() const {
    PowderSettings const& powder = c_.powder;
    if (known({"powder.particles", "powder.bed"}) && powder.particles == 0 && powder.bed.empty())
      report("powder.particles", "= 0 (empty powder) feed grains");
    if (!known({"powder.diameters", "powder.fractions"})) return;
    if (powder.diameters.empty()) {
      report("powder.diameters", "is empty (empty powder) give at least one grain size");
    } else if (powder.diameters.size() != powder.fractions.size()) {
      report("powder.fractions", "has {} values (powder.diameters has {}) give one for each diameter",
             powder.fractions.size(), powder.diameters.size());
    } else if (double const sum = std::accumulate(powder.fractions.begin(), powder.fractions.end(), 0.0);
               std::abs(sum - 1) > 1e-6) {
      report("powder.fractions", "sum to {:.6g} (must sum to 1)", sum);
    }
  }

  void mixture() const {
    std::map<std::string, double> const& mixture = c_.powder.mixture;
    if (mixture.empty() || !known({"powder.mixture", "powder.material"})) return;
    double sum = 0;
    for (auto const& [name, share] : mixture) sum += share;
    if (!mixture.contains(c_.powder.material))
      report("powder.mixture", "lacks powder.material = \"{}\" (the main material is part of it) add its share",
             c_.powder.material);
    else if (std::abs(sum - 1) > 1e-6)
      report("powder.mixture", "sums to {:.6g} (must sum to 1)", sum);
    else if (mixture.size() > 1 &&
             (c_.process == Process::melting || c_.process == Process::calibrating || c_.machine.frozen_zone))
      report("powder.mixture",
             "has {} materials (what melts or freezes is of one material so far, and calibration varies the values of "
             "one) leave the table out, or use the verbs spread or absorb without machine.frozen_zone",
             mixture.size());
  }

  /// What a material or pair has of its own must not stand beside values that are varied, or have nothing to act on.
  void pairs() const {
    bool const has_energy = c_.contact.cohesion == Cohesion::sjkr || c_.contact.cohesion == Cohesion::sjkr2;
    bool const has_surface = c_.contact.cohesion == Cohesion::jkr || c_.contact.cohesion == Cohesion::dmt;
    for (auto const& [names, pair] : c_.pairs) {
      std::string const table = "contact." + names[0] + "." + names[1];
      if (c_.process == Process::calibrating)
        origin_.report(table, fmt::format("[{}] is given (calibrate varies what [contact] gives) leave it out", table));
      if (!known({"contact.cohesion"})) continue;
      if (pair.cohesion_energy_density && !has_energy)
        origin_.report(table + ".cohesion_energy_density",
                       fmt::format("{}.cohesion_energy_density is given (contact.cohesion is neither \"sjkr\" nor "
                                   "\"sjkr2\") leave it out",
                                   table));
      if (pair.surface_energy && !has_surface)
        origin_.report(table + ".surface_energy",
                       fmt::format("{}.surface_energy is given (contact.cohesion is neither \"jkr\" nor \"dmt\") leave "
                                   "it out",
                                   table));
    }
  }

  /// The feed must stand above the platforms, or the blade passes over it, and must stay on its zone.
  void feed() const {
    MachineSettings const& m = c_.machine;
    if (!c_.powder.bed.empty()) return;  // it may stand in the feed
    if (!distribution_known() || !known({"powder.basis", "powder.particles", "machine.accumulation_length",
                                         "machine.accumulation_depth", "machine.width"})) {
      return;
    }
    double const volume = static_cast<double>(c_.powder.particles) * mean_grain_volume(fed_powder(c_));
    if (!(volume > 0)) return;
    double const solid_height = volume / (m.accumulation_length * m.width);
    double const loosest = solid_height / 0.5, densest = solid_height / 0.64;
    if (loosest <= m.accumulation_depth) {
      report("powder.particles",
             "= {} (they settle to {} in an accumulation zone {} deep: the blade passes over them) "
             "feed more grains or lower machine.accumulation_depth",
             c_.powder.particles, length(loosest), length(m.accumulation_depth));
    } else if (densest - m.accumulation_depth > m.accumulation_length) {
      report("powder.particles",
             "= {} (they would stand {} above a zone {} long and slide off it) feed fewer grains or "
             "lengthen machine.accumulation_length",
             c_.powder.particles, length(densest - m.accumulation_depth), length(m.accumulation_length));
    }
  }

  void time_step() const {
    ContactSettings const& contact = c_.contact;
    if (!distribution_known() || !known({"contact.time_step_fraction", "contact.youngs_modulus",
                                         "contact.poisson_ratio", "material.density", "run.unsafe_time_step"})) {
      return;
    }
    double const limit = shortest_rayleigh_time(c_, 0.5 * smallest());
    if (contact.time_step_fraction > 0.15 && !c_.run.unsafe_time_step) {
      report(
          "contact.time_step_fraction",
          "= {:g} (time step {} is above the stable limit: 0.15 of the Rayleigh time, {}, of a grain of {}) lower it, "
          "or set run.unsafe_time_step = true to see the guards stop the run",
          contact.time_step_fraction, format_quantity(contact.time_step_fraction * limit, Dimension::time),
          format_quantity(limit, Dimension::time), length(smallest()));
    }
  }

  /// Contacts that act apart are not booked.
  void energy_ledger() const {
    if (!c_.run.energy_ledger || !known({"run.energy_ledger", "contact.cohesion"})) return;
    char const* apart = nullptr;
    if (c_.contact.cohesion == Cohesion::jkr) apart = "contact.cohesion = \"jkr\"";
    for (char const* effect : {"capillary_bridge", "electrostatic_charge"})
      if (c_.effect_strength(effect) > 0) apart = effect;
    for (ActiveUserEffect const& active : active_user_effects(c_.effects))
      if (dynamic_cast<PairAttraction const*>(active.effect)) apart = "an effect of a library";
    if (!c_.admixtures.empty() || !c_.bodies.empty() || !c_.pairs.empty())
      report("run.energy_ledger",
             "= true (none is kept for materials of their own: [powder.mixture], [contact.A]) leave one of them out");
    if (apart) report("run.energy_ledger", "= true (none is kept with {}) leave one of them out", apart);
    if (!c_.has_machine()) report("run.energy_ledger", "= true (none is kept while calibrating) leave it out");
  }

  void modifiers() const {
    for (auto const& [name, modifier] : c_.modifiers) {
      std::string const table = "modifiers." + name, key = table + ".expression";
      if (!known({(table + ".target").c_str(), key.c_str()})) continue;
      if (effect_catalogue_has(name)) {
        origin_.report(table,
                       fmt::format("[{}] has the name of an effect (both would be called {}) rename it", table, name));
        continue;
      }
      try {
        Expression const formula(modifier.expression, variables_of(modifier.target));
      } catch (InputError const& fault) {
        origin_.report(key, fmt::format("{}: {}", key, fault.what()));
      }
    }
  }

  static bool effect_catalogue_has(std::string const& name) {
    return std::ranges::find(effect_catalogue(), name, &Effect::name) != effect_catalogue().end();
  }

  void machine() const {
    MachineSettings const& m = c_.machine;
    if (known({"machine.substrate", "machine.plate_roughness", "machine.plate_grains"}) && !m.substrate.empty() &&
        m.has_textured_plate()) {
      report(m.plate_roughness > 0 ? "machine.plate_roughness" : "machine.plate_grains",
             "is given beside machine.substrate (one plate only) leave one out");
    }
    if (known({"machine.recoater", "machine.edge_radius", "machine.blade_width"}) &&
        m.recoater != RecoaterKind::roller && m.edge_radius > 0.5 * m.blade_width) {
      report("machine.edge_radius", "= {} (must be at most half of machine.blade_width = {})", length(m.edge_radius),
             length(m.blade_width));
    }
    if (!distribution_known()) return;
    if (known({"machine.width"}) && m.width <= 3 * largest()) {
      report("machine.width",
             "= {} (must be above 3 largest grains, {}, or a grain meets its own periodic image) widen it",
             length(m.width), length(3 * largest()));
    }
    if (known({"machine.layer_thickness", "machine.blade_clearance"}) &&
        m.layer_thickness + m.blade_clearance < smallest()) {
      report("machine.layer_thickness", "= {} (no grain fits under the blade: the smallest has {})",
             length(m.layer_thickness), length(smallest()));
    }
  }

  void frozen_zone() const {
    MachineSettings const& m = c_.machine;
    if (!m.frozen_zone || !known({"machine.frozen_zone", "machine.accumulation_length", "machine.gap_length",
                                  "machine.deposition_length"})) {
      return;
    }
    auto const [from, to] = *m.frozen_zone;
    if (!(from < to)) {
      report("machine.frozen_zone", "= [{}, {}] (must ascend)", length(from), length(to));
    } else if (from < m.deposition_begin() * (1 - 1e-9) || to > m.deposition_end() * (1 + 1e-9)) {
      report("machine.frozen_zone", "= [{}, {}] (must lie in the deposition zone, [{}, {}])", length(from), length(to),
             length(m.deposition_begin()), length(m.deposition_end()));
    }
  }

  void calibrate() const {
    CalibrateSettings const& c = c_.calibrate;
    auto const angle = [](double radians) { return format_quantity(radians, Dimension::angle); };
    if (known({"calibrate.tilt_from", "calibrate.tilt_to"}) && c.tilt_from >= c.tilt_to)
      report("calibrate.tilt_from", "= {} (must be below calibrate.tilt_to = {})", angle(c.tilt_from),
             angle(c.tilt_to));
    if (known({"calibrate.friction"}) && c.friction && !(c.friction->at(0) < c.friction->at(1)))
      report("calibrate.friction", "= [{:g}, {:g}] (must ascend)", c.friction->at(0), c.friction->at(1));
    if (known({"calibrate.cohesion"}) && c.cohesion && !(c.cohesion->at(0) < c.cohesion->at(1)))
      report("calibrate.cohesion", "= [{:g}, {:g}] J/m3 (must ascend)", c.cohesion->at(0), c.cohesion->at(1));
    bool const has_energy_density = c_.contact.cohesion == Cohesion::sjkr || c_.contact.cohesion == Cohesion::sjkr2;
    if (known({"calibrate.search", "contact.cohesion"}) && c.search && !has_energy_density)
      report("calibrate.search", "= true (it varies the cohesion energy density) set contact.cohesion = \"sjkr2\"");
    if (!distribution_known()) return;
    if (known({"calibrate.base_diameter"}) && c.base_diameter < 10 * largest())
      report("calibrate.base_diameter", "= {} (a pile needs at least 10 of the largest grains, {}, across) widen it",
             length(c.base_diameter), length(10 * largest()));
    if (known({"calibrate.plate_length"}) && c.plate_length <= 3 * largest())
      report("calibrate.plate_length",
             "= {} (must be above 3 largest grains, {}, or a grain meets its own periodic image) lengthen it",
             length(c.plate_length), length(3 * largest()));
  }

  void material() const {
    Material const& metal = c_.material;
    if (!known({"material.solidus", "material.liquidus", "material.boiling_point"}) || metal.liquidus == 0) return;
    auto const kelvin = [](double T) { return format_quantity(T, Dimension::temperature); };
    if (metal.solidus > metal.liquidus) {
      report("material.solidus", "= {} (must not be above the liquidus, {})", kelvin(metal.solidus),
             kelvin(metal.liquidus));
    }
    if (metal.liquidus >= metal.boiling_point) {
      report("material.liquidus", "= {} (must be below the boiling point, {})", kelvin(metal.liquidus),
             kelvin(metal.boiling_point));
    }
    if (known({"heat.ambient_temperature"}) && c_.heat.ambient_temperature >= metal.solidus) {
      report("heat.ambient_temperature",
             "= {} (must be below the solidus, {}, or all is molten before the laser comes)",
             kelvin(c_.heat.ambient_temperature), kelvin(metal.solidus));
    }
  }

  void isotherm() const {
    std::string const& told = c_.heat.pool_isotherm;
    if (!known({"heat.pool_isotherm", "heat.ambient_temperature", "material.boiling_point"})) return;
    if (told == "liquidus" || told == "solidus") return;
    double T = 0;
    try {
      T = c_.heat.isotherm(c_.material);
    } catch (InputError const& error) {
      report("heat.pool_isotherm", "= \"{}\" (must be \"liquidus\", \"solidus\" or a temperature: {})", told,
             error.what());
      return;
    }
    if (T <= c_.heat.ambient_temperature || T > c_.material.boiling_point)
      report("heat.pool_isotherm", "= \"{}\" (must lie between heat.ambient_temperature and the boiling point)", told);
  }

  void scan() const {
    ScanSettings const& scan = c_.scan;
    if (known({"scan.kind", "scan.path"}) && (scan.kind == ScanKind::file) == scan.path.empty())
      report("scan.path", "= \"{}\" (a file is needed for scan.kind = \"file\", and only then)", scan.path);
    if (!known({"scan.kind", "scan.tracks", "scan.hatch_spacing"})) return;
    if (scan.kind == ScanKind::track && scan.tracks != 1) {
      report("scan.tracks", "= {} (scan.kind \"track\" is one track) set scan.kind = \"hatch\"", scan.tracks);
    }
    if (scan.kind == ScanKind::hatch && scan.tracks > 1 && scan.hatch_spacing == 0) {
      report("scan.hatch_spacing", "= 0 (must be above 0 with {} tracks)", scan.tracks);
    }
    if (!known({"scan.track_index"}) || scan.track_index.empty()) return;
    std::vector<double> sorted = scan.track_index, numbers(static_cast<std::size_t>(scan.tracks));
    std::ranges::sort(sorted);
    std::iota(numbers.begin(), numbers.end(), 1.0);
    if (sorted != numbers)
      report("scan.track_index", "= [{}] (must hold every number from 1 to scan.tracks = {} once)",
             fmt::join(scan.track_index, ", "), scan.tracks);
  }

  /// What the verb melt heats, unless it is the deposition zone of a machine.
  void plate() const {
    if (c_.has_machine()) return;
    scan();
    optics();
    if (!known({"laser.spot_diameter", "laser.spot_definition"})) return;
    double const radius = c_.laser.spot_radius() + c_.laser.ring_half_width();
    if (known({"heat.cell_size"}) && c_.heat.cell_size > radius)
      report("heat.cell_size", "= {} (must resolve the beam: at most its 1/e2 radius, {})", length(c_.heat.cell_size),
             length(radius));
    if (!known({"heat.size"}) || c_.heat.size.empty()) return;
    if (c_.heat.size.size() != 3)
      report("heat.size", "has {} values (three are needed: [x, y, z])", c_.heat.size.size());
  }

  /// The patch is centred on the deposition zone.
  void beam() const {
    ScanSettings const& scan = c_.scan;
    if (!known({"laser.spot_diameter", "laser.spot_definition"})) return;
    double const spot = 2 * (c_.laser.spot_radius() + c_.laser.ring_half_width());
    if (known({"heat.cell_size"}) && c_.heat.cell_size > 0.5 * spot) {
      report("heat.cell_size", "= {} (must resolve the beam: at most its 1/e2 radius, {})", length(c_.heat.cell_size),
             length(0.5 * spot));
    }
    if (scan.kind == ScanKind::file ||
        !known({"scan.track_length", "scan.tracks", "scan.hatch_spacing", "scan.rotation", "scan.direction"}))
      return;
    std::int64_t const turns = scan.rotation == 0 ? 1 : std::min<std::int64_t>(c_.run.layers, 360);
    for (std::int64_t layer = 1; layer <= turns; ++layer) {
      if (!beam_stays_on(layer, spot)) return;
    }
  }

  /// Whether the hatch of a layer and the spot lie in the deposition zone; reports by how much they do not.
  bool beam_stays_on(std::int64_t layer, double spot) const {
    ScanSettings const& scan = c_.scan;
    double const along = scan.track_length, across = static_cast<double>(scan.tracks - 1) * scan.hatch_spacing,
                 c = std::abs(std::cos(scan.angle(layer))), s = std::abs(std::sin(scan.angle(layer)));
    double const x = along * c + across * s + spot, y = along * s + across * c + spot;
    std::string const turned =
        s > 1e-9 ? fmt::format(" at {} in layer {}", format_quantity(scan.angle(layer), Dimension::angle), layer) : "";
    double const excess_x = x - c_.machine.deposition_length, excess_y = y - c_.machine.width;
    bool stays = true;
    if (known({"machine.deposition_length"}) && excess_x > 1e-12) {
      stays = false;
      report("scan.track_length",
             "= {} (beam off the bed: track and spot need {}{}, the deposition zone has {}) shorten the track by {}",
             length(scan.track_length), length(x), turned, length(c_.machine.deposition_length), length(excess_x));
    }
    if (known({"machine.width"}) && excess_y > 1e-12) {
      stays = false;
      bool const hatch = scan.tracks > 1;
      report(hatch ? "scan.hatch_spacing" : "laser.spot_diameter",
             "= {} (beam off the bed: {} tracks and the spot need {}{}, machine.width is {}) narrow them by {}",
             length(hatch ? scan.hatch_spacing : c_.laser.spot_diameter), scan.tracks, length(y), turned,
             length(c_.machine.width), length(excess_y));
    }
    return stays;
  }

  /// The lattice that holds the part and the heat grid: periodic in y, from end to end of the deposition zone in x.
  void cells() const {
    MachineSettings const& m = c_.machine;
    double const cell = c_.heat.cell_size;
    if (!known({"heat.cell_size"})) return;
    if (known({"machine.width"}) && !divides(cell, m.width)) {
      report("heat.cell_size", "= {} (must divide machine.width = {})", length(cell), length(m.width));
    }
    if (!known({"machine.deposition_length"})) return;
    if (!divides(cell, m.deposition_length)) {
      report("heat.cell_size", "= {} (must divide machine.deposition_length = {})", length(cell),
             length(m.deposition_length));
    }
    if (!known({"machine.width", "machine.layer_thickness", "heat.substrate_depth", "run.layers"})) return;
    double const height = c_.heat.substrate_depth + static_cast<double>(c_.run.layers) * m.layer_thickness;
    double const cells = m.deposition_length * m.width * height / std::pow(cell, 3);
    if (cells > 2e9) {
      report("heat.cell_size",
             "= {} (plate and layers would have {:.2g} cells, at most 2e9 can be numbered) coarsen it", length(cell),
             cells);
    }
  }

  void optics() const {
    if (known({"optics.position_spacing", "laser.spot_diameter"}) &&
        c_.optics.position_spacing > c_.laser.spot_diameter) {
      report("optics.position_spacing",
             "= {} (must be at most laser.spot_diameter, {}, or parts of the track are not hit)",
             length(c_.optics.position_spacing), length(c_.laser.spot_diameter));
    }
    if (known({"optics.floor"}) && c_.optics.floor == "none")
      report("optics.floor", "= \"none\" (the plate below the powder has to be there to be melted) name a metal");
    if (c_.laser.absorptivity && known({"laser.profile", "laser.incidence_angle", "laser.ellipticity"}) &&
        (c_.laser.profile != SpotProfile::gaussian || c_.laser.incidence_angle != 0 || c_.laser.ellipticity != 1))
      report("laser.absorptivity",
             "= {:g} (only a round Gaussian beam from above can do without the tracer) leave it out",
             *c_.laser.absorptivity);
  }

  void light() const {
    LaserSettings const& laser = c_.laser;
    if (known({"laser.profile", "laser.profile_file"}) &&
        (laser.profile == SpotProfile::file) == laser.profile_file.empty())
      report("laser.profile_file", "= \"{}\" (a table is needed for laser.profile = \"file\", and only then)",
             laser.profile_file);
    if (known({"laser.profile", "laser.ring_width"}) && (laser.profile == SpotProfile::ring) != (laser.ring_width > 0))
      report("laser.ring_width", "= {} (must be above 0 for laser.profile = \"ring\", and only then)",
             length(laser.ring_width));
    if (known({"laser.focus_offset", "laser.rayleigh_length"}) && laser.focus_offset != 0 && !laser.rayleigh_length)
      report("laser.focus_offset", "= {} (how fast the beam widens is not known) give laser.rayleigh_length",
             length(laser.focus_offset));
    if (known({"laser.profile"}) && laser.profile == SpotProfile::file && c_.effect_strength("spot_drift") > 0)
      report("effects.spot_drift.enabled", "= true (the table of laser.profile_file has a fixed size) name a profile");
    if (c_.has_laser() && c_.effect_strength("plume_attenuation") > 0 && c_.effect_strength("evaporation") == 0)
      report("effects.plume_attenuation.enabled", "= true (nothing evaporates) enable effects.evaporation as well");
    if (c_.process == Process::melting && c_.effect_strength("heat_accumulation") > 0 && c_.scan.hatch_spacing == 0)
      report("effects.heat_accumulation.enabled",
             "= true (how much of the part a track stands for is not known) give scan.hatch_spacing");
    refractive_index();
    optical_effects();
  }

  void refractive_index() const {
    if (c_.laser.absorptivity || c_.optics.grey_reflectance ||
        !known({"material.refractive_index", "optics.refractive_index", "laser.wavelength"}))
      return;
    if (c_.material.refractive_index.real() <= 0)
      report(c_.optics.refractive_index ? "optics.refractive_index" : "material.refractive_index",
             "has n = {:g} (must be above 0; [material.{}] gives neither refractive_index nor optical_data)",
             c_.material.refractive_index.real(), c_.material.name);
    for (Material const& metal : c_.admixtures)
      if (metal.refractive_index.real() <= 0)
        report("powder.mixture", "has {}, which has no refractive index (light falls on it) give its optical_data",
               metal.name);
  }

  void optical_effects() const {
    OpticsSettings const& optics = c_.optics;
    double const share = optics.diffuse_share * c_.effect_strength("diffuse_scattering");
    if (known({"optics.oxide_index"}) && optics.oxide_index && optics.oxide_index->at(0) <= 0)
      report("optics.oxide_index", "has n = {:g} (must be above 0)", optics.oxide_index->at(0));
    if (known({"optics.diffuse_share", "effects.diffuse_scattering.strength"}) && share > 1)
      report("optics.diffuse_share", "= {:g} (more than all of the light would be scattered)", share);
    bool const has_film = optics.oxide_thickness > 0 && c_.effect_strength("surface_oxide") > 0;
    if (known({"optics.grey_reflectance", "optics.oxide_thickness"}) && optics.grey_reflectance && has_film)
      report("optics.oxide_thickness",
             "= {} (a grey surface has no film: optics.grey_reflectance is given) leave one out",
             length(optics.oxide_thickness));
  }

  Case const& c_;
  CaseOrigin const& origin_;
};

}  // namespace

void check_case(Case const& c, CaseOrigin const& origin) { CaseChecks(c, origin).run(); }

}  // namespace layerloop
