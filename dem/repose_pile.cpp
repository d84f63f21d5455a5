#include "dem/repose_pile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/grain_size.hpp"
#include "core/progress.hpp"
#include "core/statistics.hpp"
#include "dem/loose_cloud.hpp"

namespace layerloop::dem {
namespace {
using std::numbers::pi;
constexpr double first_point = 0.1, last_point = 0.85;  // of the base's radius
constexpr int lines = 4;                                // through the axis
constexpr double disc_in_diameters = 1.1;               // of the grain of mean volume
constexpr double pile_rest_speed = 1e-3;                // [m/s]
constexpr std::int64_t steps_between_sweeps = 5000;     // of what fell off the base

/// Height of the uppermost grain surface over a point; 0 where the base is bare.
double top_over(PowderBed const& bed, double x, double y) {
  double top = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    double const dx = bed.x[i] - x, dy = bed.y[i] - y, squared = bed.radius[i] * bed.radius[i] - dx * dx - dy * dy;
    if (squared > 0) top = std::max(top, bed.z[i] + std::sqrt(squared));
  }
  return top;
}

/// Mean of top_over on a square lattice of a tenth of the diameter within a disc.
double mean_top(PowderBed const& bed, double x, double y, double disc_radius) {
  double sum = 0;
  int count = 0;
  for (int i = -5; i <= 5; ++i) {
    for (int j = -5; j <= 5; ++j) {
      if (i * i + j * j > 25) continue;
      sum += top_over(bed, x + 0.2 * i * disc_radius, y + 0.2 * j * disc_radius);
      ++count;
    }
  }
  return sum / count;
}

/// Downward slope of the least-squares line.
double fitted_slope(PileProfile const& p) {
  double r_mean = 0, h_mean = 0, rr = 0, rh = 0;
  for (std::size_t k = 0; k < 5; ++k) r_mean += p.radius[k] / 5, h_mean += p.height[k] / 5;
  for (std::size_t k = 0; k < 5; ++k) {
    rr += (p.radius[k] - r_mean) * (p.radius[k] - r_mean);
    rh += (p.radius[k] - r_mean) * (p.height[k] - h_mean);
  }
  return std::atan(-rh / rr);
}

Rig pile_rig(Case const& checked) {
  double const d = checked.calibrate.base_diameter, room = 2 * d;
  Rig rig;
  rig.width = room;  // the base stands free: what falls past it is taken out before it meets itself
  rig.walls.tables = {{.name = "the base",
                       .x = 0,
                       .y = room / 2,
                       .z_top = 0,
                       .radius = d / 2,
                       .edge_radius = 2e-6,
                       .thickness = 40e-6}};
  rig.x_range = {-0.1, 0.1};
  rig.z_range = {-0.1, 0.1};
  return rig;
}

/// Grains below the base, and those that fly beside it: they will not come back.
void take_out_fallen(PowderBed& bed, Rig const& rig) {
  RoundTable const& base = rig.walls.tables.front();
  double const depth = base.thickness + 2 * *std::ranges::max_element(bed.radius);
  std::vector<char> keep(bed.size());
  for (std::size_t i = 0; i < bed.size(); ++i)
    keep[i] = bed.z[i] > -depth && std::hypot(bed.x[i] - base.x, bed.y[i] - base.y) < 1.8 * base.radius;
  bed.retain(keep);
}

double top_of(PowderBed const& bed) {
  double top = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) top = std::max(top, bed.z[i] + bed.radius[i]);
  return top;
}

/// Space of the next cloud: above the pile that is there.
CloudSpace cloud_above(PowderBed const& bed, Case const& checked, std::int64_t count) {
  CalibrateSettings const& c = checked.calibrate;
  double const radius = 0.5 * c.cloud_width * c.base_diameter, middle = c.base_diameter, low = top_of(bed);
  double const volume = static_cast<double>(count) * mean_grain_volume(checked.powder);
  double const height = volume / (c.cloud_density * pi * radius * radius);
  return {.low = {-radius, middle - radius, low}, .high = {radius, middle + radius, low + height}, .radius = radius};
}

/// Advances until at most one grain in a hundred moves, or the time is over; what falls off the base is gone.
/// \return whether it came to rest
bool settle_pile(PowderBed& bed, double& time, Motion const& motion, Rig const& rig, double longest,
                 Communicator const& communicator, Progress& progress) {
  double const begin = time;
  while (time - begin < longest) {
    Simulation simulation(motion, rig, communicator);
    simulation.scatter(bed);
    simulation.advance(steps_between_sweeps);
    time += simulation.time();
    progress.update(time);
    bed = simulation.gather();
    bool const rests = 100 * simulation.count_faster_than(pile_rest_speed) <= simulation.grains();
    take_out_fallen(bed, rig);
    if (bed.size() == 0)
      throw PhysicsError("no grain stays on the base (the pile is empty) use a larger calibrate.base_diameter");
    if (rests) return true;
  }
  return false;
}
}  // namespace

ReposePile measure_pile(PowderBed bed, double base_diameter, double x, double y, double disc_radius) {
  ReposePile pile{};
  std::vector<double> slopes;
  for (int half = 0; half < 2 * lines; ++half) {
    PileProfile& p = pile.profiles.emplace_back();
    p.direction = pi / lines * half;
    for (std::size_t k = 0; k < 5; ++k) {
      p.radius[k] = base_diameter / 2 * (first_point + (last_point - first_point) * static_cast<double>(k) / 4);
      p.height[k] =
          mean_top(bed, x + p.radius[k] * std::cos(p.direction), y + p.radius[k] * std::sin(p.direction), disc_radius);
    }
    p.slope = fitted_slope(p);
    slopes.push_back(p.slope);
  }
  Sample const sample = sample_of(slopes);
  pile.angle_of_repose = sample.mean;
  pile.angle_of_repose_u = sample.half_width;
  pile.angle_from_height = std::atan(mean_top(bed, x, y, disc_radius) / (base_diameter / 2));
  pile.grains_on_base = static_cast<std::int64_t>(bed.size());
  pile.bed = std::move(bed);
  return pile;
}

ReposePile repose_pile(Case const& checked, Motion const& motion, Communicator const& communicator,
                       bool show_progress) {
  CalibrateSettings const& c = checked.calibrate;
  Rig const rig = pile_rig(checked);
  Motion awake = motion;
  awake.grains_sleep = false;  // a slope comes to rest by slow creep, which sleeping grains do not do
  PowderBed bed;
  double time = 0;
  bool at_rest = false;
  Progress progress("pile", c.settling_time * static_cast<double>(c.batches), show_progress && communicator.is_root());
  for (std::int64_t batch = 0; batch < c.batches; ++batch) {
    std::int64_t const from = c.pile_particles * batch / c.batches, to = c.pile_particles * (batch + 1) / c.batches;
    add_loose_cloud(bed, checked, cloud_above(bed, checked, to - from), to - from, from, c.fall_speed);
    at_rest = settle_pile(bed, time, awake, rig, c.settling_time, communicator, progress);
  }
  double const disc = disc_in_diameters * std::cbrt(6 / pi * mean_grain_volume(checked.powder));
  ReposePile pile = measure_pile(std::move(bed), c.base_diameter, 0, rig.width / 2, disc);
  pile.grains_fed = c.pile_particles;
  pile.settling_time = time;
  pile.at_rest = at_rest;
  return pile;
}

}  // namespace layerloop::dem
