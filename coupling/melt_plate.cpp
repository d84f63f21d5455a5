#include "coupling/melt_plate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "coupling/optics_of_case.hpp"
#include "coupling/scan_path.hpp"
#include "raytrace/surface.hpp"
#include "thermal/eagar_tsai.hpp"

namespace layerloop::coupling {
namespace {

constexpr double absorptivity_of_powder = 0.65;
constexpr double absorptivity_of_keyhole = 0.8;

double flat_absorptivity(Case const& checked) {
  if (checked.laser.absorptivity) return *checked.laser.absorptivity;
  return 1 - raytrace::reflectance(optical_set(checked).surface[0], checked.laser.wavelength, 1);
}

double speed_of(Track const& track) { return (track.end - track.begin).norm() / (track.end_time - track.begin_time); }

/// The tracks about the middle of a plate that is yet to be chosen.
std::vector<Track> tracks_about_origin(Case checked) {
  checked.machine.accumulation_length = checked.machine.gap_length = 0;
  checked.machine.deposition_length = checked.machine.width = 0;
  return scan_path(checked, 1);
}

/// How far the tracks reach from the middle of the plate [m].
Vec3 reach_of(std::vector<Track> const& tracks) {
  PathBox const box = box_of(tracks);
  return box.upper.cwiseMax(-box.lower);
}

double rounded_up(double length, double cell) { return std::ceil(length / cell - 1e-6) * cell; }

/// Depth of the vapour depression by Gan et al. [m].
double keyhole_depth(Case const& checked, double absorptivity) {
  thermal::ConstantMetal const metal = thermal::constant_metal_of(checked.material, checked.heat.ambient_temperature);
  double const w = checked.laser.spot_radius(), a = metal.conductivity / metal.heat_capacity;
  double const rise = metal.melting_point - checked.heat.ambient_temperature;
  double const number =
      absorptivity * checked.laser.power /
      (rise * std::numbers::pi * metal.heat_capacity * std::sqrt(a * checked.scan.scan_speed * w * w * w));
  return std::max(0.0, 0.4 * (number - 1.4)) * w;
}

}  // namespace

Track strongest_track(Case const& checked) { return std::ranges::max(tracks_about_origin(checked), {}, &Track::power); }

PoolEstimate estimate_pool(Case const& checked) {
  PoolEstimate estimate;
  estimate.absorptivity = flat_absorptivity(checked);
  if (checked.melt.bed != MeltedBed::plate && !checked.laser.absorptivity)
    estimate.absorptivity = std::max(estimate.absorptivity, absorptivity_of_powder);
  Track const track = strongest_track(checked);
  thermal::MovingBeam const beam{.absorbed_power = estimate.absorptivity * track.power,
                                 .speed = speed_of(track),
                                 .spot_radius = checked.laser.spot_radius() + checked.laser.ring_half_width(),
                                 .ambient_temperature = checked.heat.ambient_temperature};
  estimate.pool =
      thermal::eagar_tsai_pool(beam, thermal::constant_metal_of(checked.material, checked.heat.ambient_temperature));
  if (checked.effect_strength("keyhole") > 0)
    estimate.pool.depth = std::max(estimate.pool.depth, keyhole_depth(checked, absorptivity_of_keyhole));
  return estimate;
}

Case with_plate(Case checked, PoolEstimate const& estimate) {
  if (checked.has_machine()) return checked;
  double const spot = 2 * (checked.laser.spot_radius() + checked.laser.ring_half_width());
  double const width = std::max(estimate.pool.width, spot), depth = std::max(estimate.pool.depth, 0.25 * spot);
  if (checked.heat.cell_size == 0) {
    double const wanted = std::min(spot / 12, estimate.pool.depth > 0 ? estimate.pool.depth / 6 : spot);
    constexpr double step = 5e-8;  // a number that people can read
    checked.heat.cell_size = std::max(step, std::floor(std::max(wanted, spot / 40) / step + 1e-6) * step);
  }
  Vec3 const reach = reach_of(tracks_about_origin(checked));
  if (checked.heat.size.empty())
    checked.heat.size = {2 * reach.x() + 3 * width, 2 * reach.y() + 3 * width, std::max(4 * depth, width)};
  for (Eigen::Index axis : {0, 1}) {
    double const needed = 2 * reach[axis] + spot, given = checked.heat.size[static_cast<std::size_t>(axis)];
    if (given < needed)
      throw InputError(
          fmt::format("heat.size has {:.4g} um along {} (beam off the plate: tracks and spot need {:.4g} "
                      "um) enlarge it, or leave it out",
                      1e6 * given, axis == 0 ? "x" : "y", 1e6 * needed));
  }
  return with_cells(checked, checked.heat.cell_size);
}

Case with_cells(Case checked, double cell) {
  std::vector<double> const size = checked.heat.size;
  Vec3 const reach = reach_of(tracks_about_origin(checked));
  checked.heat.cell_size = cell;
  checked.heat.margin = std::min(0.5 * size[0] - reach.x(), 0.5 * size[1] - reach.y());
  checked.heat.substrate_depth = rounded_up(size[2], cell);
  checked.machine.accumulation_length = checked.machine.gap_length = 0;
  checked.machine.deposition_length = rounded_up(size[0], cell);
  checked.machine.width = rounded_up(size[1], cell);
  return checked;
}

double normalised_enthalpy(Case const& checked, double absorptivity) {
  Material const& metal = checked.material;
  thermal::ConstantMetal const constant = thermal::constant_metal_of(metal, checked.heat.ambient_temperature);
  double const rise = metal.liquidus - checked.heat.ambient_temperature;
  double const to_melt = constant.heat_capacity * rise - metal.density * metal.latent_heat;
  double const a = metal.conductivity(metal.solidus) / (to_melt / rise), w = checked.laser.spot_radius();
  Track const track = strongest_track(checked);
  return absorptivity * track.power / (to_melt * std::sqrt(std::numbers::pi * a * speed_of(track) * w * w * w));
}

}  // namespace layerloop::coupling
