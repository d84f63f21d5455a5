#include "dem/dosing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/grain_size.hpp"
#include "core/progress.hpp"
#include "core/random.hpp"
#include "dem/machine_rig.hpp"
#include "dem/mixture.hpp"
#include "dem/recoater.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem {
namespace {
constexpr double cloud_fraction = 0.32;  // solid fraction aimed at; random sequential addition jams at about 0.38
constexpr double fall_speed = 0.15;      // [m/s] downwards at the start: shortens the free fall
constexpr std::uint32_t draws_a_height = 200;
constexpr double longest_settling = 10e-3;  // [s]

double sphere_volume(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

/// Grains in the accumulation zone by cells, for the question whether a sphere has room.
class FreeSpace {
 public:
  FreeSpace(MachineSettings const& machine, double largest_radius)
      : period_(machine.width),
        cell_(2 * largest_radius),
        nx_(static_cast<std::size_t>(machine.accumulation_length / cell_) + 1) {}

  void add(Vec3 const& centre, double radius) {
    std::size_t const layer = row(centre.z());
    if (columns_.size() < (layer + 1) * nx_) columns_.resize((layer + 1) * nx_);
    columns_[column(centre.x()) + nx_ * layer].push_back({centre, radius});
  }

  bool has_room(Vec3 const& centre, double radius) const {
    std::size_t const i = column(centre.x()), k = row(centre.z());
    for (std::size_t ck = k > 0 ? k - 1 : 0; ck <= k + 1; ++ck) {
      for (std::size_t ci = i > 0 ? i - 1 : 0; ci <= std::min(i + 1, nx_ - 1); ++ci) {
        if (ci + nx_ * ck >= columns_.size()) continue;
        for (Sphere const& other : columns_[ci + nx_ * ck]) {
          Vec3 apart = other.centre - centre;
          apart.y() = std::remainder(apart.y(), period_);
          if (apart.squaredNorm() < (radius + other.radius) * (radius + other.radius)) return false;
        }
      }
    }
    return true;
  }

 private:
  struct Sphere {
    Vec3 centre;
    double radius;
  };
  static constexpr double floor_ = -0.021;  // below every accumulation zone [m]

  std::size_t column(double x) const { return std::min(static_cast<std::size_t>(std::max(x, 0.0) / cell_), nx_ - 1); }
  std::size_t row(double z) const { return static_cast<std::size_t>(std::max(z - floor_, 0.0) / cell_); }

  double period_, cell_;
  std::size_t nx_;
  std::vector<std::vector<Sphere>> columns_;
};

/// Top of a loose cloud of this volume that takes the free part of the zone.
double cloud_top(MachineSettings const& machine, double volume) {
  return -machine.accumulation_depth + volume / (cloud_fraction * machine.accumulation_length * machine.width);
}
}  // namespace

double draw_radius(Case const& checked, std::int64_t id) {
  PowderSettings const powder = fed_powder(checked);
  std::vector<double> number = powder.fractions;
  if (powder.basis == SizeBasis::volume) {
    for (std::size_t k = 0; k < number.size(); ++k) number[k] /= std::pow(powder.diameters[k], 3);
  }
  double total = 0;
  for (double const share : number) total += share;
  double left = total * uniform4(checked.seed, RandomStream::grain_size, static_cast<std::uint64_t>(id))[0];
  for (std::size_t k = 0; k < number.size(); ++k) {
    left -= number[k];
    if (left < 0) return powder.diameters[k] / 2;
  }
  return powder.diameters.back() / 2;
}

void add_cloud(PowderBed& bed, Case const& checked, std::int64_t count, std::int64_t next_id) {
  MachineSettings const& m = checked.machine;
  double const largest = std::ranges::max(fed_powder(checked).diameters) / 2;
  FreeSpace space(m, largest);
  double volume = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (bed.x[i] > m.accumulation_length + 2 * largest) continue;
    space.add(bed.position(i), bed.radius[i]);
    volume += bed.volume(i) * cloud_fraction / 0.55;  // lies densely already
  }
  for (std::int64_t id = next_id; id < next_id + count; ++id) volume += sphere_volume(draw_radius(checked, id));

  double top = cloud_top(m, volume);
  for (std::int64_t id = next_id; id < next_id + count; ++id) {
    double const radius = draw_radius(checked, id), bottom = radius - m.accumulation_depth;
    for (std::uint32_t draw = 0;; ++draw) {
      if (draw % draws_a_height == draws_a_height - 1) top += 0.5 * largest;
      auto const u = uniform4(checked.seed, RandomStream::grain_position, static_cast<std::uint64_t>(id), draw);
      Vec3 const centre(radius + u[0] * (m.accumulation_length - 2 * radius), u[1] * m.width,
                        bottom + u[2] * (std::max(top, bottom + radius) - bottom));
      if (!space.has_room(centre, radius)) continue;
      space.add(centre, radius);
      bed.add(id, centre, radius, draw_material(checked, id));
      bed.vz.back() = -fall_speed;
      break;
    }
  }
}

void settle(Simulation& simulation, double longest, char const* stage, bool show_progress) {
  constexpr std::int64_t steps_between_checks = 1000;
  double const begin = simulation.time();
  Progress progress(stage, longest, show_progress);
  while (simulation.time() - begin < longest) {
    simulation.advance(steps_between_checks);
    progress.update(simulation.time() - begin);
    if (20 * simulation.count_faster_than(rest_speed) <= simulation.grains()) return;
  }
}

std::int64_t dose(PowderBed& bed, Case const& checked, TriangleSurface const& substrate, std::int64_t count,
                  std::int64_t next_id, Communicator const& communicator, bool show_progress, EnergyLedger* energy) {
  bool const lifts = count == 0 && checked.machine.dosing == Dosing::feed;
  if (lifts) raise_feed(bed, checked);
  Rig const rig = machine_rig(checked, substrate, bed, lifts ? Tools::parked : Tools::parked_and_gate);
  add_cloud(bed, checked, count, next_id);
  Simulation simulation(motion_of(checked), rig, communicator);
  std::size_t const fed = bed.size();
  simulation.scatter(bed);
  settle(simulation, longest_settling, "dose", show_progress && communicator.is_root());
  if (energy && checked.run.energy_ledger) *energy += simulation.energy();
  bed = simulation.gather();
  if (bed.size() != fed)
    throw PhysicsError(
        fmt::format("{} grains ran off the machine while it was fed (the feed stands too high) lower powder.particles "
                    "or machine.dose_factor, or lengthen machine.accumulation_length",
                    fed - bed.size()));
  return next_id + count;
}

}  // namespace layerloop::dem
