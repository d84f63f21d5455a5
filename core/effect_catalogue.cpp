#include "core/effect_catalogue.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "core/case_rows.hpp"
#include "core/user_effect.hpp"

namespace layerloop {

EffectParameter Effect::strength() const {
  return {"strength", D::none, {0, largest_strength}, "1", prior_scale, "Factor on the effect; 0: as if off.", 0.0};
}

// One entry an effect; sentence, source and file last.
// clang-format off
namespace {

using enum EffectStage;
using enum EffectClass;

std::vector<Effect> grain_effects() {
  return {
      {"cohesion", dem, physics, "true", 10, 0.5,
       "Cohesion of [contact]; the strength scales its energy.",
       "thesis eq. 6; Johnson, Kendall & Roberts 1971; Derjaguin, Muller & Toporov 1975", "dem/contact_law.cpp"},
      {"rolling_resistance", dem, physics, "true", 10, 0.5,
       "Rolling friction of [contact]; the strength scales it.",
       "Ai et al., Powder Technol. 206 (2011) 269", "dem/contact_law.cpp"},
      {"wall_friction", dem, physics, "true", 10, 0.5,
       "Friction at walls of its own, contact.wall_friction; strength 0: walls rub as grains do.",
       "Coulomb", "dem/wall_contacts.cpp"},
      {"wall_cohesion", dem, physics, "true", 10, 0.5,
       "Cohesion between grains and walls; the strength scales its energy.",
       "thesis eq. 6", "dem/wall_contacts.cpp"},
      {"capillary_bridge", dem, physics, "false", 10, 1,
       "Liquid bridges between grains that have touched; the strength scales their volume.",
       "Willett et al., Langmuir 16 (2000) 9396", "dem/contact_effects.cpp",
       {{"liquid_volume", D::none, {1e-9, 0.05}, "1e-5", 1e-5,
         "Volume of a bridge over the cube of twice the reduced radius."},
        {"surface_tension", D::surface_energy, {0.01, 2}, "\"0.072 N/m\"", 0.01, "Surface tension of the liquid."},
        {"contact_angle", D::angle, {0, 1.5}, "\"0 deg\"", 0.5, "Contact angle of the liquid on the metal."}}},
      {"electrostatic_charge", dem, physics, "false", 10, 1,
       "Like charge on all grains: they repel one another and are held by their images in walls (the air breaks down at "
       "2.65e-5 C/m2).",
       "method of images", "dem/contact_effects.cpp",
       {{"charge_density", D::charge_density, {0, 2.65e-5}, "\"2.65e-6 C/m2\"", 2.65e-6,
         "Charge on the surface of a grain.", 0.0}}},
      {"gas_drag", dem, physics, "false", 10, 1,
       "Stokes drag of gas at rest on every grain; felt by grains below about 8 um.",
       "Stokes 1851", "dem/contact_effects.cpp",
       {{"viscosity", D::viscosity, {1e-6, 1e-3}, "\"2.2e-5 Pa s\"", 2e-6,
         "Viscosity of the gas (argon at 300 K: 2.2e-5 Pa s)."}}},
      {"blade_vibration", dem, physics, "false", 10, 1,
       "The recoater shakes along z; felt once amplitude (2 pi frequency)^2 exceeds about g.",
       "Nasato et al., Addit. Manuf. 2021, 102248", "dem/machine_rig.cpp",
       {{"amplitude", D::length, {0, 1e-4}, "\"2 um\"", 2e-6, "Amplitude of the recoater's vibration.", 0.0},
        {"frequency", D::frequency, {1, 1e5}, "\"500 Hz\"", 300, "Frequency of the recoater's vibration."}}},
      {"blade_compliance", dem, physics, "false", 100, 1,
       "The recoater yields along z as machine.blade_stiffness, blade_mass and blade_damping say; the strength divides "
       "the stiffness.",
       "Penny et al., arXiv 2209.04320", "dem/machine_rig.cpp"},
      {"fines", dem, instrument, "false", 10, 1,
       "Grains finer than the size distribution, mixed in by mass (sieving and laser sizing cut them off).",
       "mass balance", "core/grain_size.cpp",
       {{"mass_fraction", D::none, {0, 0.5}, "0.02", 0.02, "Share of the powder's mass that is fines.", 0.0},
        {"diameter", D::length, {1e-6, 5e-5}, "\"8 um\"", 4e-6, "Diameter of the fines."}}},
  };
}

std::vector<Effect> light_effects() {
  return {
      {"surface_oxide", laser, physics, "true", 100, 1,
       "Oxide film of optics.oxide_thickness on all metal, as interfering layers; the strength scales its thickness.",
       "Born & Wolf, Principles of Optics, 1.6.4", "raytrace/surface.cpp"},
      {"diffuse_scattering", laser, physics, "true", 1, 0.5,
       "Share optics.diffuse_share of the reflected light is scattered by Lambert's law; the strength scales it.",
       "Lambert 1760", "raytrace/ray_loop.cpp"},
      {"optical_temperature", laser, physics, "true", 10, 0.5,
       "Refractive index at optics.temperature: the damping of the conduction electrons grows with the resistivity, "
       "that follows from material.conductivity by Wiedemann and Franz; the strength scales the change from 300 K.",
       "Drude 1900; Wiedemann & Franz 1853", "core/optical_constants.cpp"},
      {"plume_attenuation", laser, physics, "false", 10, 1,
       "Share of the beam lost in the vapour above the pool, by Beer-Lambert with what evaporates at the time; does "
       "nothing without the effect evaporation.",
       "Shcheglov et al., Laser Phys. Lett. 8 (2011) 475", "coupling/effects/plume_attenuation.cpp",
       {{"rate_of_unit_depth", D::mass_rate, {1e-9, 1}, "\"36 mg/s\"", 2e-5,
         "Mass rate of evaporation at which the plume's optical depth is 1."},
        {"relaxation_time", D::time, {0, 1}, "\"50 us\"", 5e-5,
         "Time over which the rate of evaporation is averaged: that in which a plume rises out of the beam."},
        {"flow_direction", D::angle, {-2 * std::numbers::pi, 2 * std::numbers::pi}, "\"0 deg\"", 1,
         "Direction in which the shielding gas flows over the bed, from x towards y.", {}, EffectSign::either},
        {"flow_asymmetry", D::none, {-1, 1}, "0", 0.5,
         "Relative gain of the optical depth when scanning with the gas flow, and its loss against it; negative: the "
         "other way round.", 0.0, EffectSign::either}}},
      {"spot_drift", laser, instrument, "false", 10, 1,
       "Focus that moves up as the optics warm, so that the spot grows over the beam-on time of a build.",
       "Siegman, Lasers (1986), 17.1", "coupling/effects/spot_drift.cpp",
       {{"rate", D::speed, {0, 1}, "\"0.2 mm/s\"", 2e-4, "Rise of the focus over the time that the beam is on.", 0.0},
        {"largest_shift", D::length, {0, 0.1}, "\"1 mm\"", 1e-3, "Rise at which it ends.", 0.0},
        {"beam_quality", D::none, {1, 50}, "1.1", 0.2,
         "M2 of the beam, for its Rayleigh length where laser.rayleigh_length is not given."}}},
  };
}

std::vector<Effect> heat_effects() {
  return {
      {"marangoni", heat, physics, "false", 1, 0.5,
       "Flow of the melt, driven by surface tension, as a conductivity of the liquid that is larger along x and y; the "
       "strength scales what is added.",
       "Lampa et al., Int. J. Heat Mass Transf. 40 (1997) 1239", "thermal/effects/marangoni.hpp",
       {{"lateral_factor", D::none, {1, 10}, "3", 1, "Conductivity of the liquid along x and y over that of its table.", 1.0},
        {"vertical_factor", D::none, {1, 10}, "1", 1, "The same along z.", 1.0}}},
      {"latent_heat", heat, physics, "true", 2, 0.1,
       "Latent heat of fusion between solidus and liquidus.",
       "Voller & Cross, Int. J. Heat Mass Transf. 24 (1981) 545", "thermal/effects/latent_heat.hpp"},
      {"variable_conductivity", heat, physics, "true", 1, 0.3,
       "Conductivity over temperature; off: its value at the solidus.",
       "sources of the material's table", "thermal/effects/variable_conductivity.hpp"},
      {"evaporation", heat, physics, "false", 10, 0.5,
       "Heat carried off by metal vapour.",
       "Hertz-Knudsen; Knight, AIAA J. 17 (1979) 519", "thermal/effects/evaporation.cpp"},
      {"keyhole", heat, physics, "false", 1, 0.5,
       "Depression of the melt where the recoil of its vapour exceeds surface tension; light is traced on it anew at "
       "every cell that it can recede. The strength scales the depth that light sees.",
       "Kaplan, J. Phys. D 27 (1994) 1805; Semak & Matsunawa, J. Phys. D 30 (1997) 2541",
       "thermal/effects/keyhole.cpp"},
      {"powder_conductivity", heat, physics, "false", 1, 0.5,
       "Grains pass heat to one another and to the plate through gas around their contacts, which grows with their "
       "size, with the conductivity of heat.gas and its pressure, instead of as heat.powder_contact_conductivity says.",
       "Zehner & Schluender, Chem. Ing. Tech. 42 (1970) 933; Sih & Barlow, Part. Sci. Technol. 22 (2004) 427",
       "thermal/effects/powder_conductivity.cpp",
       {{"accommodation", D::none, {0.02, 1}, "0.85", 0.1,
         "Thermal accommodation of the gas on the metal: 0.8 to 0.95 for argon and nitrogen, 0.3 to 0.5 for helium."}}},
      {"heat_accumulation", heat, physics, "false", 10, 0.5,
       "Plate and part warm up from layer to layer, as a slab whose bottom is held at heat.ambient_temperature; a layer "
       "starts from its temperature. Between the tracks of a layer the heat grid keeps the heat itself.",
       "Carslaw & Jaeger, Conduction of Heat in Solids (1959), 14.3", "coupling/effects/heat_accumulation.cpp",
       {{"layer_time", D::time, {1e-3, 1e5}, "\"20 s\"", 10, "From the exposure of a layer to that of the next."},
        {"plate_thickness", D::length, {1e-4, 1}, "\"20 mm\"", 0.01,
         "From the top of the part down to what is held at heat.ambient_temperature."},
        {"earlier_layers", D::none, {0, 1e5}, "0", 10, "Layers that were exposed before the first of the case.", 0.0},
        {"layer_energy", D::surface_energy, {0, 1e8}, "0", 5e5,
         "Heat that each of these absorbed per area of the part.", 0.0}}},
      {"surface_losses", heat, physics, "false", 100, 1,
       "Radiation and convection from metal that faces gas.",
       "Stefan-Boltzmann; Newton", "thermal/effects/surface_losses.cpp",
       {{"convection", D::heat_transfer, {0, 1e6}, "\"20 W/(m2 K)\"", 30,
         "Heat transfer coefficient to the gas (published models: 10 to 80 W/(m2 K)); 0: radiation alone.", 0.0}}},
  };
}

std::vector<Effect> solid_effects() {
  return {
      {"shrinkage", solid, physics, "false", 2, 0.5,
       "Melt levels as a liquid and shrinks as it freezes: the surface sinks where it was deep. The strength scales "
       "the change of volume between liquidus and solidus.",
       "mass balance", "coupling/effects/shrinkage.cpp"},
      {"denudation", solid, physics, "false", 1, 0.5,
       "Grains beside a track that the gas draws away after melting; the strength is the probability on its axis.",
       "Matthews et al., Acta Mater. 114 (2016) 33; Bidare et al., Acta Mater. 142 (2018) 107",
       "coupling/effects/denudation.cpp",
       {{"width_factor", D::none, {0, 20}, "2", 0.5,
         "Distance from the track's axis over laser.spot_diameter at which none is lost any more: 1.5 to 2.5 in argon "
         "at 1 atm.", 0.0}}},
  };
}

}  // namespace
// clang-format on

namespace {

std::vector<Effect> built_in_effects() {
  std::vector<Effect> all;
  for (auto const part : {grain_effects, light_effects, heat_effects, solid_effects})
    for (Effect& effect : part()) all.push_back(std::move(effect));
  return all;
}

}  // namespace

bool is_built_in(std::string const& name) {
  std::vector<Effect> const all = built_in_effects();
  return std::ranges::find(all, name, &Effect::name) != all.end();
}

std::vector<Effect> const& effect_catalogue() {
  static std::vector<Effect> const effects = [] {
    std::vector<Effect> all = built_in_effects();
    all.insert(all.end(), user_effects().begin(), user_effects().end());
    return all;
  }();
  return effects;
}

namespace {

double default_value(EffectParameter const& parameter) {
  std::string const& text = parameter.fallback;
  return text.front() == '"' ? parse_quantity(text.substr(1, text.size() - 2), parameter.dimension) : std::stod(text);
}

}  // namespace

double effect_parameter(std::map<std::string, EffectSettings> const& effects, std::string const& effect,
                        std::string const& parameter) {
  if (auto const settings = effects.find(effect); settings != effects.end()) {
    auto const& given = settings->second.parameters;
    if (auto const value = given.find(parameter); value != given.end()) return value->second;
  }
  for (Effect const& known : effect_catalogue()) {
    if (known.name != effect) continue;
    auto const row = std::ranges::find(known.parameters, parameter, &EffectParameter::name);
    if (row != known.parameters.end()) return default_value(*row);
  }
  throw std::out_of_range("no parameter " + effect + "." + parameter);
}

}  // namespace layerloop
