// What a simulation looks at every few steps: is everything still physical, must the neighbours be listed anew?
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "dem/simulation.hpp"
#include "dem/sleep.hpp"

namespace layerloop::dem {
namespace {
constexpr double overlap_limit = 0.05;  // of the smaller diameter
constexpr double nip_limit = 0.02;      // of the smaller diameter, while a wall moves
constexpr double step_limit = 0.1;      // of the smallest radius
constexpr double least_steps_a_contact = 8;
constexpr double least_speed = 0.02;  // [m/s], of grains and blades that are called slow
constexpr std::int64_t steps_between_looks = 20;
constexpr std::int64_t steps_between_sink_checks = 500;

std::string place(Grains const& g, std::size_t i) {
  return fmt::format("x = {:.1f}, y = {:.1f}, z = {:.1f} um", g[i].x * 1e6, g[i].y * 1e6, g[i].z * 1e6);
}
}  // namespace

template <class Change>
void Simulation::give_to(HeldEnergy& account, Change const& change) {
  if (!motion_.keeps_energy_ledger) return change();
  account += held_energy();
  change();
  account -= held_energy();
}

bool Simulation::is_inside(std::size_t i) const {
  GrainState const& g = grains_[i];
  return g.x > rig_.x_range[0] && g.x < rig_.x_range[1] && g.z > rig_.z_range[0] && g.z < rig_.z_range[1];
}

Simulation::Watch Simulation::shared_watch() {
  for (std::size_t i = 0; i < grains_.owned; ++i) {
    double const dx = wrapped(grains_[i].x - x_built_[i], period_.x),
                 dy = wrapped(grains_[i].y - y_built_[i], period_.y), dz = grains_[i].z - z_built_[i];
    watch_.displacement_squared = std::max(watch_.displacement_squared, dx * dx + dy * dy + dz * dz);
    if (!is_inside(i)) watch_.broken = 1;
  }
  std::array<double, 5> values{watch_.step_squared, watch_.displacement_squared, watch_.overlap, watch_.broken,
                               stop_requested() ? 1.0 : 0.0};
  MPI_Allreduce(MPI_IN_PLACE, values.data(), 5, MPI_DOUBLE, MPI_MAX, communicator_.handle());
  if (values[4] > 0)
    throw StoppedBySignal(
        "stopped by a signal while grains were moving (this layer is lost, earlier ones are on disk) go on with "
        "--resume");
  watch_ = {};
  return {values[0], values[1], values[2], values[3]};
}

/// \return number of steps that may be made before the next look
std::int64_t Simulation::look() {
  bool const sink_is_due = steps_ >= next_sink_check_;
  if (sink_is_due) {
    next_sink_check_ = steps_ + steps_between_sink_checks;
    std::vector<char> beyond(grains_.owned);
    for (std::size_t i = 0; i < beyond.size(); ++i)
      beyond[i] = grains_[i].x > rig_.sink_x || grains_[i].z > rig_.sink_z;
    take_out(beyond);
  }
  Watch const seen = shared_watch();
  if (seen.broken > 0) fail(find_lost_grain());
  largest_overlap_ = std::max(largest_overlap_, seen.overlap);
  if (seen.overlap > overlap_limit) fail(find_overlap(seen.overlap));
  if (seen.overlap > nip_limit && moving_walls_.fastest() > 0) take_out_nipped();

  double const dt = motion_.time_step, step = std::sqrt(seen.step_squared),
               speed = std::max(step / dt, moving_walls_.fastest());
  double const moved = std::max(std::sqrt(seen.displacement_squared), moving_walls_.travelled());
  // a bed at rest does not stay so: an unstable step is told before anything moves
  bool const contact_too_short =
      shortest_contact_time(motion_, smallest_radius_, std::max(speed, least_speed)) < least_steps_a_contact * dt;
  if (step > step_limit * smallest_radius_ || contact_too_short || moved > 0.5 * skin_) fail(find_fastest());

  moving_walls_.record(time());

  double const expected = 1.5 * speed * dt + 1e-30;  // speeds may grow until the next look
  auto const steps_left = [&](double way) {
    return static_cast<std::int64_t>(std::min(way / expected, static_cast<double>(steps_between_looks)));
  };
  std::int64_t steps = steps_left(0.5 * skin_ - moved);
  if (motion_.grains_sleep) check_sleep();
  if (steps < steps_between_looks) {
    rebuild();
    steps = std::max<std::int64_t>(1, steps_left(0.5 * skin_));
  }
  return steps;
}

void Simulation::check_sleep() {
  if (steps_ < next_sleep_check_) return;
  next_sleep_check_ = steps_ + steps_between_checks;
  std::vector<char> near_moving_wall(grains_.owned, 0);
  for (std::size_t w = 0; w < wall_contacts_.grain.size(); ++w) {
    auto const row = static_cast<std::size_t>(wall_contacts_.grain[w]);
    near_moving_wall[row] = is_near_moving_wall(wall_contacts_, w, moving_walls_);
  }
  double const interval = static_cast<double>(steps_between_checks + steps_between_looks) * motion_.time_step;
  bool changed = false;
  give_to(lost_to_sleep_, [&] {
    changed = communicator_.any(update_sleep(grains_, neighbours_, near_moving_wall, period_, interval));
    if (!changed) return;
    decomposition_.update_ghosts(grains_);  // those that fell asleep were stopped
    decomposition_.update_ghost_sleep(grains_);
  });
  if (changed) share_out(team_.threads());
}

std::int64_t Simulation::take_out(std::vector<char> const& leaves) {
  std::int64_t gone = 0;
  for (std::size_t i = 0; i < grains_.owned; ++i) {
    grains_.leaves[i] = leaves[i];
    gone += leaves[i];
  }
  gone = communicator_.sum(gone);
  if (gone == 0) return 0;
  grain_count_ -= gone;
  if (grain_count_ == 0)
    throw PhysicsError("every grain left over the sink (nothing is left to spread) check machine and powder");
  give_to(carried_out_, [&] { rebuild(); });
  return gone;
}

template <class Visit>
void Simulation::for_each_overlap(Visit const& visit) const {
  Grains const& g = grains_;
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    auto const i = static_cast<std::size_t>(neighbours_.first[k]), j = static_cast<std::size_t>(neighbours_.second[k]);
    double const dx = wrapped(g[i].x - g[j].x, period_.x), dy = wrapped(g[i].y - g[j].y, period_.y),
                 dz = g[i].z - g[j].z;
    double const overlap = g[i].radius + g[j].radius - std::sqrt(dx * dx + dy * dy + dz * dz);
    visit(i, j, 0.5 * overlap / std::min(g[i].radius, g[j].radius), nullptr);
  }
  for (std::size_t w = 0; w < wall_contacts_.grain.size(); ++w) {
    auto const i = static_cast<std::size_t>(wall_contacts_.grain[w]);
    for (std::int32_t c = wall_contacts_.begin[w]; c < wall_contacts_.begin[w + 1]; ++c) {
      WallCandidate const& candidate = wall_contacts_.candidates[static_cast<std::size_t>(c)];
      double const distance = distance_to(candidate, scene(), {g[i].x, g[i].y, g[i].z});
      visit(i, i, (g[i].radius - distance) / (2 * g[i].radius),
            &rig_.walls.name(static_cast<std::size_t>(candidate.wall)));
    }
  }
}

void Simulation::take_out_nipped() {
  std::vector<char> nipped(grains_.size(), 0);
  for_each_overlap([&](std::size_t i, std::size_t j, double overlap, std::string const*) {
    if (overlap <= nip_limit) return;
    nipped[grains_[i].radius <= grains_[j].radius ? i : j] = 1;  // the first has the lower id
  });
  nipped_ += take_out(nipped);
}

void Simulation::check_first_overlaps() {
  double deepest = 0;
  for_each_overlap(
      [&](std::size_t, std::size_t, double overlap, std::string const*) { deepest = std::max(deepest, overlap); });
  deepest = communicator_.max(deepest);
  if (deepest > overlap_limit) fail(find_overlap(deepest));
}

void Simulation::fail(Fault const& own) {
  double const worst = communicator_.max(own.severity);
  bool const is_mine = own.severity == worst && !own.text.empty();
  std::string const line = is_mine ? own.text + '\n' : std::string();
  std::vector<char> const all = communicator_.all_gather(std::vector<char>(line.begin(), line.end()));
  std::string const text(all.begin(), all.end());
  throw PhysicsError(text.substr(0, text.find('\n')));
}

Simulation::Fault Simulation::find_lost_grain() const {
  Grains const& g = grains_;
  for (std::size_t i = 0; i < g.owned; ++i) {
    GrainState const& at = g[i];
    double const sum = at.x + at.y + at.z + at.vx + at.vy + at.vz + at.wx + at.wy + at.wz;
    if (!std::isfinite(sum)) {
      return {3, fmt::format(
                     "grain {} has a value that is not finite at t = {:.4g} ms (the motion is unstable) use a smaller "
                     "contact.time_step_fraction",
                     g.id[i], time() * 1e3)};
    }
    if (!is_inside(i)) {
      return {
          2,
          fmt::format(
              "grain {} left the machine at {} (no wall and no sink there) use a smaller contact.time_step_fraction, "
              "or a lower machine.recoating_speed if it was thrown out by the blade",
              g.id[i], place(g, i))};
    }
    if (!(at.vx * at.vx + at.vy * at.vy + at.vz * at.vz < fastest_grain * fastest_grain)) {
      return {1, fmt::format("grain {} flies faster than 1 km/s at {} (the motion is unstable) use a smaller "
                             "contact.time_step_fraction",
                             g.id[i], place(g, i))};
    }
  }
  return {};
}

Simulation::Fault Simulation::find_overlap(double seen) const {
  Grains const& g = grains_;
  double worst =
      -std::numeric_limits<double>::infinity();  // the deepest may have come apart since: the closest is named then
  std::size_t grain = 0;
  std::string other;
  for_each_overlap([&](std::size_t i, std::size_t j, double overlap, std::string const* wall) {
    if (overlap <= worst) return;
    worst = overlap;
    grain = i;
    other = wall ? *wall : fmt::format("grain {}", g.id[j]);
  });
  if (other.empty()) return {};
  return {worst,
          fmt::format("grain {} overlaps {} by {:.1f} % of its diameter at {} ({:.0f} % is the limit: contacts are too "
                      "soft, or the step is too long) use a stiffer contact.youngs_modulus, a smaller "
                      "contact.time_step_fraction or a lower machine.recoating_speed",
                      g.id[grain], other, 100 * seen, place(g, grain), 100 * overlap_limit)};
}

Simulation::Fault Simulation::find_fastest() const {
  Grains const& g = grains_;
  double fastest = -1;
  std::size_t grain = 0;
  for (std::size_t i = 0; i < g.owned; ++i) {
    double const squared = g[i].vx * g[i].vx + g[i].vy * g[i].vy + g[i].vz * g[i].vz;
    if (squared > fastest) {
      fastest = squared;
      grain = i;
    }
  }
  if (fastest < 0) return {};
  double const speed = std::max({std::sqrt(fastest), moving_walls_.fastest(), least_speed});
  double const contact_steps = shortest_contact_time(motion_, smallest_radius_, speed) / motion_.time_step;
  return {fastest,
          fmt::format(
              "grain {} moves at {:.3g} m/s at {}: {:.3g} um a step, {:.1f} steps a contact (at most a tenth of the "
              "smallest radius, at least {:.0f} steps; the motion is unstable or not resolved) use a smaller "
              "contact.time_step_fraction or a stiffer contact.youngs_modulus",
              g.id[grain], std::sqrt(fastest), place(g, grain), std::sqrt(fastest) * motion_.time_step * 1e6,
              contact_steps, least_steps_a_contact)};
}

}  // namespace layerloop::dem
