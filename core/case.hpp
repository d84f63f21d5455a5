#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/material.hpp"

namespace layerloop {

// A case, checked and in SI. Every member is filled by one row of the schema table (core/case_schema.cpp), which holds
// its key, unit, range, default and sentence; a member without a row here would never be set.

enum class SizeBasis { number, volume };
enum class Cohesion { none, sjkr, sjkr2, jkr, dmt };
enum class RestitutionForm { exact, clamped };
enum class RollingModel { cdt, epsd2 };
enum class SlidingSpring { rescaled, kept };
enum class WallCohesionArea { liggghts, eq6 };
enum class CoulombOn { repulsive, total };
enum class RecoaterKind { blade, roller, compliant_blade };
enum class Dosing { feed, rain };
enum class EndWall { flush, open, high };
enum class BladeCollision { stop, report };
enum class SpotDefinition { one_over_e2, d4sigma, fwhm };
enum class SpotProfile { gaussian, top_hat, ring, file };
enum class LaserPolarisation { unpolarised, s, p, x, y, circular };
/// Whether light that is reflected keeps its polarisation or is unpolarised again at every hit.
enum class PolarisationModel { averaged, tracked };
/// Where the bed of the verb `absorb` comes from.
enum class AbsorbingBed { spread, settled, file };
/// What the verb `melt` melts; `automatic` is settled when the case is read.
enum class MeltedBed { automatic, plate, spread, file };
enum class ScanKind { track, hatch, file };
/// What becomes of a spread layer, or that there is none; the verb decides.
enum class Process { melting, spreading, calibrating, absorbing, exposing };
enum class Gas { argon, nitrogen, helium };
enum class HeatSolver { explicit_steps, implicit_steps, automatic };

struct PowderSettings {
  std::string material;
  SizeBasis basis = SizeBasis::number;
  std::vector<double> diameters;  ///< [m]
  std::vector<double> fractions;  ///< sum 1, by `basis`
  std::int64_t particles = 0;     ///< grains fed before the first layer
  std::string bed = "";           ///< file of grains that are in the machine before the first layer; empty: none
  std::map<std::string, double> mixture = {};  ///< material -> share of the mass, sum 1; empty: all of `material`
};

struct ContactSettings {
  double youngs_modulus = 0;  ///< [Pa]
  double poisson_ratio = 0;
  double restitution = 0;
  RestitutionForm restitution_form = RestitutionForm::exact;
  double sliding_friction = 0;
  SlidingSpring sliding_spring = SlidingSpring::rescaled;
  double rolling_friction = 0;
  RollingModel rolling_model = RollingModel::cdt;
  Cohesion cohesion = Cohesion::sjkr2;
  double cohesion_energy_density = 0;  ///< sjkr, sjkr2 [J/m^3]
  double surface_energy = 0;           ///< jkr, dmt: of one surface; two of them touch [J/m^2]
  double liquid_volume = 0;            ///< effect capillary_bridge: of a bridge over (2 R*)^3; 0: dry
  double surface_tension = 0.072;      ///< of that liquid [N/m]
  double contact_angle = 0;            ///< of that liquid on the metal [rad]
  double charge_density = 0;           ///< effect electrostatic_charge [C/m^2]
  double gas_viscosity = 0;            ///< effect gas_drag [Pa s]
  double wall_friction = 0;
  double wall_cohesion = 1;  ///< effect wall_cohesion: of the energy between grains
  WallCohesionArea wall_cohesion_area = WallCohesionArea::liggghts;
  CoulombOn coulomb_on = CoulombOn::repulsive;
  double time_step_fraction = 0;  ///< of the Rayleigh time of the smallest grain
};

/// What the case file calls everything that is not powder: plate, part, platforms, recoater.
inline constexpr char const* walls_name = "wall";

/// What [contact.NAME] gives of a material, or of the walls; nothing: as in [contact].
struct BodySettings {
  std::optional<double> youngs_modulus;  ///< [Pa]; walls may be rigid: infinite
  std::optional<double> poisson_ratio;
};

/// What [contact.A.B] gives of two materials, or of a material and the walls; nothing: as in [contact].
struct PairSettings {
  std::optional<double> restitution, sliding_friction, rolling_friction;
  std::optional<double> cohesion_energy_density, surface_energy;  ///< [J/m^3], [J/m^2]
};

/// x = 0 is where the accumulation zone begins and z = 0 the level of the platforms.
struct MachineSettings {
  double layer_thickness = 0;
  double recoating_speed = 0;
  Dosing dosing = Dosing::rain;
  double dose_factor = 0;  ///< of layer 2, 3, ...; see `dosing`
  double accumulation_length = 0, accumulation_depth = 0, gap_length = 0, deposition_length = 0;
  double width = 0;  ///< periodic, across the blade
  RecoaterKind recoater = RecoaterKind::blade;
  double blade_width = 0, edge_radius = 0, edge_exponent = 2, blade_clearance = 0;
  std::optional<double> blade_friction;  ///< of any recoater; else that of the walls
  double blade_stiffness = 0;            ///< for each metre of width [N/m^2]
  double blade_mass = 0;                 ///< for each metre of width [kg/m]
  double blade_damping = 0;              ///< share of critical damping
  double roller_diameter = 0;
  double roller_spin = 0;               ///< surface speed over recoating speed; positive: counter-rotating
  double platform_edge_radius = 20e-6;  ///< of the platforms' edges [m]
  EndWall end_wall = EndWall::flush;
  BladeCollision blade_collision = BladeCollision::stop;
  std::string
      substrate;  ///< STL or PLY of metal on the plate before layer 1 (m; z = 0 on the plate); empty: bare plate
  double plate_roughness = 0, plate_correlation_length = 0;  ///< rms height and length over which it persists [m]
  double plate_grains = 0;                                   ///< share of the plate that half-sunk grains cover
  std::optional<std::array<double, 2>>
      frozen_zone;  ///< x from, to: freeze and mesh this part of the bed instead of the laser

  /// The piston of the accumulation zone lifts this much before each layer, with Dosing::feed [m].
  double feed_rise() const { return dose_factor * layer_thickness * deposition_length / accumulation_length; }
  bool has_textured_plate() const { return plate_roughness > 0 || plate_grains > 0; }
  double deposition_begin() const { return accumulation_length + gap_length; }
  double deposition_end() const { return deposition_begin() + deposition_length; }
};

struct LaserSettings {
  double power = 0;          ///< [W]
  double wavelength = 0;     ///< [m]
  double spot_diameter = 0;  ///< at the focus [m], by `spot_definition`
  SpotDefinition spot_definition = SpotDefinition::one_over_e2;
  SpotProfile profile = SpotProfile::gaussian;
  std::string profile_file = "";          ///< intensity over radius
  double ring_width = 0;                  ///< across the crest of a ring, by `spot_definition` [m]
  double ellipticity = 1;                 ///< extent along y over extent along x, at the same area
  double focus_offset = 0;                ///< height of the focus above the bed [m]
  std::optional<double> rayleigh_length;  ///< [m]; parallel light without
  double incidence_angle = 0;             ///< from straight down [rad]
  double incidence_azimuth = 0;           ///< direction of travel from x towards y [rad]
  LaserPolarisation polarisation = LaserPolarisation::unpolarised;
  std::optional<double> absorptivity;  ///< replaces the tracer

  /// On the bed [m]: 1/e2 radius w of a Gaussian, I = 2P/(pi w^2) exp(-2 r^2/w^2); edge of a top hat; crest of a ring.
  double spot_radius() const;
  double ring_half_width() const;  ///< 1/e2, on the bed [m]
  double widening() const;         ///< of the beam from its focus to the bed
};

struct OpticsSettings {
  std::optional<std::array<double, 2>> refractive_index;  ///< [n, k], replaces the material's
  std::optional<double> grey_reflectance;                 ///< at any angle; replaces every index
  std::string floor = "";      ///< material below the powder, "black" or "none"; empty: the powder's
  bool uniform_beam = false;   ///< verb absorb: light evenly over the bed, not the spot
  double oxide_thickness = 0;  ///< film on all metal [m]
  std::optional<std::array<double, 2>> oxide_index;  ///< [n, k] of it; without: that of the metal's own oxide
  double diffuse_share = 0;                          ///< of the reflected light
  double temperature = 300;                          ///< of the metal that reflects [K]
  PolarisationModel polarisation_model = PolarisationModel::averaged;
  std::int64_t rays = 0;        ///< per beam position
  double position_spacing = 0;  ///< between the beam positions that are traced [m]
  bool retrace = true;          ///< at every position on the surface that has melted by then
};

struct ScanSettings {
  ScanKind kind = ScanKind::hatch;
  double scan_speed = 0;
  double track_length = 0;
  std::int64_t tracks = 0;
  double hatch_spacing = 0;
  double rotation = 0;                   ///< of the tracks from layer to layer [rad]
  double dwell = 0;                      ///< laser off between tracks [s]
  double direction = 0;                  ///< of the tracks of layer 1, from x towards y [rad]
  std::string path = "";                 ///< file of the beam's way
  std::vector<double> track_index = {};  ///< numbers of the tracks in the order they are scanned; empty: ascending

  /// Of the tracks of a layer, from x towards y [rad].
  double angle(std::int64_t layer) const { return direction + rotation * static_cast<double>(layer - 1); }
};

struct HeatSettings {
  double cell_size = 0;           ///< [m]; verb melt: 0, chosen by itself
  std::vector<double> size = {};  ///< verb melt: of the heated plate along x, y, z [m]; empty: chosen
  double substrate_depth = 0;     ///< of the plate that the grid holds [m]
  double margin = 0;              ///< of the grid around the scanned patch [m]
  double ambient_temperature = 0;
  HeatSolver solver = HeatSolver::automatic;
  double powder_contact_conductivity = 0;  ///< across faces between different grains [W/(m K)]: gas and point contacts
  Gas gas = Gas::argon;
  double gas_pressure = 101325;            ///< [Pa]
  std::string pool_isotherm = "liquidus";  ///< "liquidus", "solidus" or a temperature as one would write it

  /// `pool_isotherm` [K]. \throws InputError  it is none of these
  double isotherm(Material const& metal) const;
};

struct RunSettings {
  std::int64_t layers = 0;
  std::int64_t bins = 15;       ///< slices of the deposition zone along x in which a layer is measured
  std::int64_t replicates = 1;  ///< runs with seeds seed, seed + 1, ...
  bool grains_sleep = false;
  bool energy_ledger = false;
  bool checkpoint = true;
  bool pictures = true;
  bool unsafe_time_step = false;
};

/// Angle of repose and slipping angle (dem/repose_pile.hpp, dem/tilting_plate.hpp), and the search for the friction and
/// cohesion that give both.
struct CalibrateSettings {
  double base_diameter = 0;         ///< of the round base under the pile [m]
  std::int64_t pile_particles = 0;  ///< grains that fall on it
  std::int64_t batches = 1;         ///< clouds that they come in
  double cloud_width = 0;           ///< diameter of a cloud over that of the base
  double cloud_density = 0;         ///< solid share of a cloud
  double fall_speed = 0;            ///< of the grains of a cloud at the start [m/s]
  double settling_time = 0;         ///< longest [s]
  double plate_length = 0;          ///< period along x and y of the tilting plate [m]
  std::int64_t plate_particles = 0;
  double tilt_rate = 0;                                      ///< [rad/s]
  double tilt_from = 0, tilt_to = 0;                         ///< the rate holds between them [rad]
  double target_repose = 0, target_slip = 0, tolerance = 0;  ///< [rad], [rad], relative
  bool search = false;
  std::optional<std::array<double, 2>> friction, cohesion;  ///< bounds of the search [-], [J/m^3]
  std::int64_t grid = 0, refinements = 0;
  double parameter_step = 0;  ///< relative, of the sensitivities
};

/// The verb absorb (coupling/absorption_study.hpp).
struct AbsorbSettings {
  AbsorbingBed bed = AbsorbingBed::spread;
  double plate_length = 0;           ///< period along x and y of the plate on which powder settles [m]
  double target_standard_error = 0;  ///< of the absorptivity
  std::int64_t max_rays = 0;
  std::int64_t depth_bins = 0;
  double map_spacing = 0;  ///< pixels of the map of absorbed light [m]
};

/// The verb melt (coupling/melt_study.hpp).
struct MeltSettings {
  MeltedBed bed = MeltedBed::automatic;
  bool two_grids = false;  ///< also on a coarser grid, for the discretisation error
};

/// One `[effects.NAME]` table.
struct EffectSettings {
  bool enabled = false;
  double strength = 1;
  std::map<std::string, double> parameters = {};  ///< SI
};

/// One `[modifiers.NAME]` table: an effect of the user's as a formula (core/modifier.hpp).
struct ModifierSettings {
  bool enabled = true;
  double strength = 1;
  std::string target;      ///< what it changes
  std::string expression;  ///< by what
  double prior_scale = 0.5, largest_strength = 10;
};

struct Case {
  std::string name;
  Process process = Process::melting;
  std::uint64_t seed = 0;
  std::string preset;
  PowderSettings powder;
  ContactSettings contact;
  MachineSettings machine;
  LaserSettings laser;
  OpticsSettings optics;
  ScanSettings scan;
  HeatSettings heat;
  RunSettings run;
  CalibrateSettings calibrate;
  AbsorbSettings absorb;
  MeltSettings melt;
  std::map<std::string, EffectSettings> effects;  ///< every known effect, enabled or not
  std::map<std::string, ModifierSettings> modifiers = {};
  Material material;                       ///< the powder's, overrides applied; substrate and part are the same metal
  std::vector<Material> admixtures;        ///< the others of powder.mixture
  std::optional<Material> floor_material;  ///< of optics.floor, where that is a metal
  std::map<std::string, BodySettings> bodies;                ///< by material; of the walls: "wall"
  std::map<std::array<std::string, 2>, PairSettings> pairs;  ///< by materials, or material and "wall", ascending

  bool has_laser() const {
    return process == Process::exposing || (process == Process::melting && !machine.frozen_zone);
  }
  bool has_part() const { return process == Process::melting || machine.frozen_zone; }
  /// By PowderBed::material: 0 is `material`, then the admixtures.
  std::vector<Material> materials() const {
    std::vector<Material> all{material};
    all.insert(all.end(), admixtures.begin(), admixtures.end());
    return all;
  }
  /// Of a grain of this PowderBed::material [kg/m^3].
  double density(std::int32_t index) const {
    return index == 0 || admixtures.empty() ? material.density
                                            : admixtures.at(static_cast<std::size_t>(index - 1)).density;
  }
  bool has_machine() const {
    if (process == Process::absorbing) return absorb.bed == AbsorbingBed::spread;
    if (process == Process::exposing) return melt.bed == MeltedBed::spread;
    return process != Process::calibrating;
  }
  /// Of bed and plate along y [m]; 0: they end at open sides.
  double period_y() const { return has_machine() ? machine.width : 0.0; }
  bool has_light() const { return has_laser() || process == Process::absorbing; }
  bool has_spot() const { return has_laser() || (process == Process::absorbing && !optics.uniform_beam); }
  bool effect_enabled(std::string const& effect) const { return effects.at(effect).enabled; }
  /// 0 for an effect that is off (or that a case made without a file does not know).
  double effect_strength(std::string const& effect) const {
    auto const found = effects.find(effect);
    return found != effects.end() && found->second.enabled ? found->second.strength : 0.0;
  }
};

}  // namespace layerloop
