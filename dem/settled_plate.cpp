#include "dem/settled_plate.hpp"

#include <cmath>

#include "core/grain_size.hpp"
#include "dem/dosing.hpp"
#include "dem/loose_cloud.hpp"

namespace layerloop::dem {
namespace {

/// Of a cloud of the case's density [m].
double cloud_height(Case const& checked, double period, std::int64_t grains) {
  double const volume = static_cast<double>(grains) * mean_grain_volume(checked.powder);
  return volume / (checked.calibrate.cloud_density * period * period);
}

}  // namespace

Rig plate_rig(double period) {
  Rig rig;
  rig.length = rig.width = period;
  rig.walls.blocks = {{"the plate", -0.1, 0.1, -0.1, 0, 0, 0}};
  rig.x_range = {-period, 2 * period};
  rig.z_range = {-period, 0.1};
  rig.gravity = standard_gravity * Vec3(0, 0, -1);
  return rig;
}

PowderBed cloud_over_plate(Case const& checked, double period, std::int64_t grains) {
  PowderBed bed;
  add_loose_cloud(bed, checked,
                  {.low = Vec3::Zero(),
                   .high = {period, period, cloud_height(checked, period, grains)},
                   .period_x = period,
                   .period_y = period},
                  grains, 0, checked.calibrate.fall_speed);
  return bed;
}

PowderBed settled_plate(Case const& checked, Communicator const& communicator, bool show_progress) {
  double const period = checked.absorb.plate_length;
  std::int64_t const grains = checked.powder.particles;
  Simulation simulation(motion_of(checked), plate_rig(period), communicator);
  simulation.scatter(cloud_over_plate(checked, period, grains));
  double const fall = std::sqrt(2 * cloud_height(checked, period, grains) / standard_gravity);
  settle(simulation, fall + checked.calibrate.settling_time, "settle", show_progress && communicator.is_root());
  return simulation.gather();
}

}  // namespace layerloop::dem
