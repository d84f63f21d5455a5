#include "coupling/melt_plate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/optics_of_case.hpp"
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

PoolEstimate estimate_pool(Case const& checked) {
  PoolEstimate estimate;
  estimate.absorptivity = flat_absorptivity(checked);
  if (checked.melt.bed != MeltedBed::plate && !checked.laser.absorptivity)
    estimate.absorptivity = std::max(estimate.absorptivity, absorptivity_of_powder);
  thermal::MovingBeam const beam{.absorbed_power = estimate.absorptivity * checked.laser.power,
                                 .speed = checked.scan.scan_speed,
                                 .spot_radius = checked.laser.spot_radius() + checked.laser.ring_half_width(),
                                 .ambient_temperature = checked.heat.ambient_temperature};
  estimate.pool =
      thermal::eagar_tsai_pool(beam, thermal::constant_metal_of(checked.material, checked.heat.ambient_temperature));
  if (checked.effect_strength("keyhole") > 0)
    estimate.pool.depth = std::max(estimate.pool.depth, keyhole_depth(checked, absorptivity_of_keyhole));
  return estimate;
}

Case with_plate(Case checked, PoolEstimate const& estimate) {
  double const spot = 2 * (checked.laser.spot_radius() + checked.laser.ring_half_width());
  double const width = std::max(estimate.pool.width, spot), depth = std::max(estimate.pool.depth, 0.25 * spot);
  if (checked.heat.cell_size == 0) {
    double const wanted = std::min(spot / 12, estimate.pool.depth > 0 ? estimate.pool.depth / 6 : spot);
    constexpr double step = 5e-8;  // a number that people can read
    checked.heat.cell_size = std::max(step, std::floor(std::max(wanted, spot / 40) / step + 1e-6) * step);
  }
  if (checked.heat.size.empty()) {
    double const across = static_cast<double>(checked.scan.tracks - 1) * checked.scan.hatch_spacing;
    checked.heat.size = {checked.scan.track_length + 2.5 * width, across + 3 * width, std::max(4 * depth, width)};
  }
  return with_cells(checked, checked.heat.cell_size);
}

Case with_cells(Case checked, double cell) {
  checked.heat.cell_size = cell;
  std::vector<double> const size = checked.heat.size;
  double const across = static_cast<double>(checked.scan.tracks - 1) * checked.scan.hatch_spacing;
  checked.machine.accumulation_length = checked.machine.gap_length = 0;
  checked.machine.deposition_length = rounded_up(size[0], cell);
  checked.machine.width = rounded_up(size[1], cell);
  checked.heat.substrate_depth = rounded_up(size[2], cell);
  checked.heat.margin = 0.5 * (size[1] - across);
  return checked;
}

double normalised_enthalpy(Case const& checked, double absorptivity) {
  Material const& metal = checked.material;
  thermal::ConstantMetal const constant = thermal::constant_metal_of(metal, checked.heat.ambient_temperature);
  double const rise = metal.liquidus - checked.heat.ambient_temperature;
  double const to_melt = constant.heat_capacity * rise - metal.density * metal.latent_heat;
  double const a = metal.conductivity(metal.solidus) / (to_melt / rise), w = checked.laser.spot_radius();
  return absorptivity * checked.laser.power /
         (to_melt * std::sqrt(std::numbers::pi * a * checked.scan.scan_speed * w * w * w));
}

}  // namespace layerloop::coupling
