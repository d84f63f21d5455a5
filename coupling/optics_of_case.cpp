#include "coupling/optics_of_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/error.hpp"
#include "core/optical_constants.hpp"
#include "raytrace/radial_profile.hpp"

namespace layerloop::coupling {
namespace {

constexpr double room_temperature = 300;  // of the optical constants [K]

/// Resistivity over that at room temperature: T / conductivity, by Wiedemann and Franz.
double resistivity_ratio(Case const& checked, Material const& metal) {
  double const T = checked.optics.temperature, strength = checked.effect_strength("optical_temperature");
  if (T == room_temperature || strength == 0) return 1;
  if (metal.conductivity.value.empty())
    throw InputError(
        fmt::format("optics.temperature = {:g} K needs the conductivity of {} (its resistivity follows "
                    "from it) give material.{}.conductivity",
                    T, metal.name, metal.name));
  double const ratio = T / metal.conductivity(T) * metal.conductivity(room_temperature) / room_temperature;
  return 1 + strength * (ratio - 1);
}

std::complex<double> index_of(Case const& checked, Material const& metal) {
  double const ratio = resistivity_ratio(checked, metal);
  if (ratio == 1) return metal.refractive_index;
  FreeElectrons const* const electrons = free_electrons(metal.optical_data);
  if (!electrons)
    throw InputError(
        fmt::format("optics.temperature = {:g} K: how the index of {} changes is not known (its optical "
                    "constants, \"{}\", have no conduction electrons) give the index of the hot metal",
                    checked.optics.temperature, metal.name, metal.optical_data));
  return heated_index(metal.refractive_index, *electrons, checked.laser.wavelength, ratio);
}

raytrace::Surface surface_of(Case const& checked, Material const& metal) {
  OpticsSettings const& optics = checked.optics;
  raytrace::Surface surface;
  if (optics.grey_reflectance) {
    surface.grey_reflectance = optics.grey_reflectance;
    return surface;
  }
  surface.refractive_index = index_of(checked, metal);
  surface.film_thickness = optics.oxide_thickness * checked.effect_strength("surface_oxide");
  if (surface.film_thickness == 0) return surface;
  std::string_view const oxide = oxide_data_name(metal.optical_data);
  if (optics.oxide_index) {
    surface.film_index = {optics.oxide_index->at(0), optics.oxide_index->at(1)};
  } else if (oxide.empty()) {
    throw InputError(
        fmt::format("optics.oxide_thickness: no oxide of {} is known (optical constants \"{}\") give "
                    "optics.oxide_index",
                    metal.name, metal.optical_data));
  } else {
    surface.film_index = optical_data(oxide)(checked.laser.wavelength);
  }
  return surface;
}

raytrace::Beam directed_beam(LaserSettings const& laser, Vec3 const& centre, double power) {
  raytrace::Beam beam{.centre = centre, .power = power};
  beam.incidence_angle = laser.incidence_angle;
  beam.incidence_azimuth = laser.incidence_azimuth;
  beam.polarisation = static_cast<raytrace::BeamPolarisation>(laser.polarisation);
  return beam;
}

/// Metal below the powder that is not among the grains'.
bool has_own_floor(Case const& checked) {
  if (checked.optics.floor == "black") return true;
  std::vector<Material> const metals = checked.materials();
  return checked.floor_material &&
         std::ranges::find(metals, checked.floor_material->name, &Material::name) == metals.end();
}

void choose_index(Material& metal, double wavelength) {
  if (metal.optical_data.empty())
    throw InputError(
        fmt::format("the index of {} was given by hand for one wavelength (another is asked for) name its "
                    "optical_data instead",
                    metal.name));
  metal.refractive_index = optical_data(metal.optical_data)(wavelength);
}

}  // namespace

raytrace::Beam spot_beam(LaserSettings const& laser, Vec3 const& centre, double power) {
  using raytrace::BeamProfile;
  raytrace::Beam beam = directed_beam(laser, centre, power);
  beam.radius = laser.spot_radius();
  beam.ellipticity = laser.ellipticity;
  if (laser.rayleigh_length)
    beam.front_curvature = raytrace::defocus(laser.focus_offset, *laser.rayleigh_length).front_curvature;
  if (laser.profile == SpotProfile::top_hat) beam.profile = BeamProfile::top_hat;
  if (laser.profile == SpotProfile::ring || laser.profile == SpotProfile::file) {
    beam.profile = BeamProfile::tabulated;
    beam.table = std::make_shared<raytrace::RadialProfile>(
        laser.profile == SpotProfile::ring ? raytrace::ring_profile(laser.spot_radius(), laser.ring_half_width())
                                           : raytrace::read_radial_profile(laser.profile_file));
  }
  return beam;
}

raytrace::Beam even_beam(Case const& checked, Vec3 const& centre, double size_x, double size_y, double power) {
  raytrace::Beam beam = directed_beam(checked.laser, centre, power);
  beam.profile = raytrace::BeamProfile::uniform;
  beam.size_x = size_x;
  beam.size_y = size_y;
  return beam;
}

raytrace::Polarisation polarisation_of(Case const& checked) {
  bool const tracked = checked.optics.polarisation_model == PolarisationModel::tracked ||
                       checked.laser.polarisation != LaserPolarisation::unpolarised;
  return tracked ? raytrace::Polarisation::tracked : raytrace::Polarisation::averaged;
}

double diffuse_share(Case const& checked) {
  return checked.optics.diffuse_share * checked.effect_strength("diffuse_scattering");
}

raytrace::OpticalSet optical_set(Case const& checked, std::string const& name) {
  raytrace::OpticalSet set{name, {}, checked.laser.wavelength};
  for (Material const& metal : checked.materials()) set.surface.push_back(surface_of(checked, metal));
  if (!has_own_floor(checked)) return set;
  raytrace::Surface black;
  black.grey_reflectance = 0;
  set.surface.push_back(checked.floor_material ? surface_of(checked, *checked.floor_material) : black);
  return set;
}

std::int32_t floor_index(Case const& checked) {
  std::vector<Material> const metals = checked.materials();
  if (has_own_floor(checked)) return static_cast<std::int32_t>(metals.size());
  if (!checked.floor_material) return 0;
  auto const found = std::ranges::find(metals, checked.floor_material->name, &Material::name);
  return static_cast<std::int32_t>(found - metals.begin());
}

std::vector<std::string> surface_names(Case const& checked) {
  std::vector<std::string> names;
  for (Material const& metal : checked.materials()) names.push_back(metal.name);
  if (has_own_floor(checked)) names.push_back(checked.floor_material ? checked.floor_material->name : "black");
  return names;
}

std::string optical_source(Material const& metal) {
  if (metal.optical_data.empty()) return "given with the case";
  OpticalData const& data = optical_data(metal.optical_data);
  std::string const element = data.name.substr(0, data.name.find(' '));
  bool const own = metal.name == element || metal.name == data.name;
  return fmt::format("{}: {}{}", data.name, data.source,
                     own ? "" : fmt::format("; borrowed: no set of {} itself is known", metal.name));
}

Case with_wavelength(Case checked, double wavelength) {
  checked.laser.wavelength = wavelength;
  choose_index(checked.material, wavelength);
  for (Material& metal : checked.admixtures) choose_index(metal, wavelength);
  if (checked.floor_material) choose_index(*checked.floor_material, wavelength);
  return checked;
}

Case with_powder_of(Case checked, std::string const& metal) {
  auto const known = built_in_materials().find(metal);
  Material chosen;
  if (known != built_in_materials().end()) {
    chosen = known->second;
  } else {
    chosen.name = chosen.optical_data = optical_data(metal).name;
    chosen.conductivity = {};
  }
  choose_index(chosen, checked.laser.wavelength);
  auto const replace = [&](Material& old) {
    chosen.name = old.name;  // so that surfaces keep their places
    old = chosen;
  };
  replace(checked.material);
  for (Material& other : checked.admixtures) replace(other);
  return checked;
}

}  // namespace layerloop::coupling
