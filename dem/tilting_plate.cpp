#include "dem/tilting_plate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/grain_size.hpp"
#include "core/progress.hpp"
#include "core/statistics.hpp"
#include "dem/dosing.hpp"
#include "dem/settled_plate.hpp"

namespace layerloop::dem {
namespace {
using std::numbers::pi;
constexpr double slow = 5e-3, fast = 20e-3;         // bounds of the slip that is evaluated [m/s]
constexpr std::size_t parts = 4;                    // of the slip, for its uncertainty
constexpr std::int64_t steps_between_turns = 1000;  // of gravity: 0.05 degrees at 1.4 degrees a millisecond
constexpr std::int64_t turns_a_sample = 4;
constexpr double quick = 15;  // times calibrate.tilt_rate, below calibrate.tilt_from

/// Tilt of the plate so long after it began to tilt.
double tilt_at(double time, CalibrateSettings const& c) {
  double const early = c.tilt_from / (quick * c.tilt_rate);
  return time < early ? quick * c.tilt_rate * time : c.tilt_from + c.tilt_rate * (time - early);
}

Vec3 gravity_at(double tilt) { return standard_gravity * Vec3(std::sin(tilt), 0, -std::cos(tilt)); }

/// Mean speed and mean way along x from one bed to the next.
void sample(TiltingPlate& plate, double time, double tilt, PowderBed const& before, PowderBed const& now,
            double period) {
  double speed = 0, way = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    speed += now.vx[i];
    way += std::remainder(now.x[i] - before.x[i], period);
  }
  auto const n = static_cast<double>(now.size());
  double const gone = plate.record.empty() ? 0.0 : plate.record.back().displacement;
  plate.record.push_back({time, tilt, speed / n, gone + way / n});
}

/// tan of the friction angle that satisfies the momentum balance between two samples.
double friction_between(std::vector<TiltSample> const& record, std::size_t from, std::size_t to, double gravity) {
  double driven = 0, pressed = 0;
  for (std::size_t k = from; k < to; ++k) {
    double const dt = record[k + 1].time - record[k].time;
    driven += gravity * dt * 0.5 * (std::sin(record[k].tilt) + std::sin(record[k + 1].tilt));
    pressed += gravity * dt * 0.5 * (std::cos(record[k].tilt) + std::cos(record[k + 1].tilt));
  }
  return (driven - (record[to].speed - record[from].speed)) / pressed;
}

/// First sample from which on the speed stays at or above `speed`; the number of samples when there is none.
std::size_t first_above(std::vector<TiltSample> const& record, double speed) {
  std::size_t k = record.size();
  while (k > 0 && record[k - 1].speed >= speed) --k;
  return k;
}
}  // namespace

void find_slip(TiltingPlate& plate, double gravity, double mean_diameter) {
  auto const& record = plate.record;
  plate.slipping_angle = plate.slipping_angle_u = plate.tilt_at_one_diameter = std::numeric_limits<double>::quiet_NaN();
  for (TiltSample const& s : record) {
    if (s.displacement < mean_diameter) continue;
    plate.tilt_at_one_diameter = s.tilt;
    break;
  }
  std::size_t const from = first_above(record, slow), to = std::min(first_above(record, fast), record.size() - 1);
  if (record.empty() || from + parts > to || record[to].speed < 2 * slow) return;
  plate.slipping_angle = std::atan(friction_between(record, from, to, gravity));
  std::array<double, parts> angles;
  for (std::size_t p = 0; p < parts; ++p) {
    angles[p] = std::atan(
        friction_between(record, from + (to - from) * p / parts, from + (to - from) * (p + 1) / parts, gravity));
  }
  plate.slipping_angle_u = sample_of(angles).half_width;
}

TiltingPlate tilting_plate(Case const& checked, Motion const& motion, Communicator const& communicator,
                           bool show_progress) {
  CalibrateSettings const& c = checked.calibrate;
  Motion awake = motion;
  awake.grains_sleep = false;  // gravity turns under grains that lie still
  awake.keeps_energy_ledger = false;
  Simulation simulation(awake, plate_rig(c.plate_length), communicator);
  simulation.scatter(cloud_over_plate(checked, c.plate_length, c.plate_particles));
  bool const shown = show_progress && communicator.is_root();
  settle(simulation, c.settling_time, "layer", shown);

  TiltingPlate plate{};
  PowderBed bed = simulation.gather();
  sample(plate, 0, 0, bed, bed, c.plate_length);
  double const begin = simulation.time(), mean_volume = mean_grain_volume(checked.powder);
  double const diameter = std::cbrt(6 / pi * mean_volume);
  double tilt = 0;
  Progress progress("tilt", c.tilt_to, shown);
  for (std::int64_t turn = 1; tilt < c.tilt_to; ++turn) {
    simulation.set_gravity(gravity_at(tilt));
    simulation.advance(steps_between_turns);
    tilt = tilt_at(simulation.time() - begin, c);
    if (turn % turns_a_sample != 0) continue;
    PowderBed now = simulation.gather();
    sample(plate, simulation.time() - begin, tilt, bed, now, c.plate_length);
    bed = std::move(now);
    progress.update(tilt);
    if (plate.record.back().speed > 1.2 * fast && plate.record.back().displacement > diameter) break;
  }
  plate.largest_tilt = tilt;
  plate.layer_in_grains =
      static_cast<double>(c.plate_particles) * mean_volume / (c.plate_length * c.plate_length * diameter);
  find_slip(plate, standard_gravity, diameter);
  return plate;
}

}  // namespace layerloop::dem
