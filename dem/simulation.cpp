#include "dem/simulation.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/error.hpp"
#include "dem/step_barrier.hpp"

namespace layerloop::dem {
namespace {
constexpr double skin_over_smallest_radius = 0.35;
constexpr std::size_t grains_a_thread = 400;  // fewer are not worth a barrier

struct Range {
  std::size_t from, to;
};

Range share(std::size_t n, int part, int parts) {
  auto const p = static_cast<std::size_t>(part), all = static_cast<std::size_t>(parts);
  return {n * p / all, n * (p + 1) / all};
}
}  // namespace

Motion motion_of(Case const& checked) {
  double const smallest = *std::ranges::min_element(checked.powder.diameters) / 2;
  return {.between_grains = grain_law(checked.contact),
          .at_walls = wall_law(checked.contact),
          .contact = checked.contact,
          .density = checked.material.density,
          .time_step =
              checked.contact.time_step_fraction * rayleigh_time(smallest, checked.material.density, checked.contact)};
}

Simulation::Simulation(Motion motion, Rig rig, Communicator const& communicator)
    : motion_(motion), rig_(std::move(rig)), communicator_(communicator), decomposition_(communicator) {
  for (RoundedBlock const& block : rig_.walls.blocks) fastest_wall_ = std::max(fastest_wall_, std::abs(block.velocity));
}

void Simulation::scatter(PowderBed const& bed) {
  grains_.clear();
  first_springs_ = bed.contacts;
  steps_ = next_sink_check_ = rebuilds_ = nipped_ = 0;
  largest_overlap_ = blade_force_ = 0;
  watch_ = {};
  if (bed.size() == 0) throw InputError("there is no grain to move (the bed is empty) raise powder.particles");
  auto const [smallest, largest] = std::ranges::minmax(bed.radius);
  smallest_radius_ = smallest;
  largest_radius_ = largest;
  skin_ = skin_over_smallest_radius * smallest;
  if (rig_.width < 4 * largest + 2 * skin_) {
    throw InputError(
        fmt::format("the bed is {:.3g} um wide (a grain of {:.3g} um would meet itself around the period) "
                    "make machine.width at least {:.3g} um",
                    rig_.width * 1e6, 2e6 * largest, 4.2e6 * largest + 2e6 * skin_));
  }
  triangle_grid_ = TriangleGrid(rig_.walls.substrate, 2 * largest);
  Range const own = share(bed.size(), communicator_.rank(), communicator_.size());
  for (std::size_t i = own.from; i < own.to; ++i) {
    grains_.push_back({bed.id[i], bed.x[i], bed.y[i], bed.z[i], bed.vx[i], bed.vy[i], bed.vz[i], bed.wx[i], bed.wy[i],
                       bed.wz[i], bed.radius[i], bed.material[i], 0},
                      motion_.density);
  }
  grains_.owned = grains_.size();
  grain_count_ = static_cast<std::int64_t>(bed.size());
  pairs_ = {};
  wall_contacts_ = {};
  if (Fault const lost = find_lost_grain(); communicator_.any(!lost.text.empty())) fail(lost);
  rebuild();
  check_first_overlaps();
}

void Simulation::rebuild() {
  std::vector<LocalSpring> local;
  append_springs(pairs_, grains_, local);
  append_springs(wall_contacts_, grains_, local);
  std::vector<GrainRecord> records(grains_.owned);
  for (std::size_t i = 0; i < records.size(); ++i) records[i] = grains_.record(i);
  bool const first = rebuilds_++ == 0;  // springs come from the bed then, and every rank has them all
  std::vector<ContactSpring> springs;
  decomposition_.redistribute(records, local, springs);
  if (first) springs = std::move(first_springs_);
  std::erase_if(records, [](GrainRecord const& r) { return r.leaves != 0; });

  double const cell = 2 * largest_radius_;  // neighbours in space are neighbours in memory
  auto const place = [&](GrainRecord const& r) {
    return std::tuple(std::floor(r.x / cell), std::floor(r.z / cell), r.y, r.id);
  };
  std::ranges::sort(records, {}, place);
  grains_.clear();
  for (GrainRecord const& record : records) grains_.push_back(record, motion_.density);
  grains_.owned = grains_.size();
  decomposition_.add_ghosts(grains_, 2 * largest_radius_ + skin_, motion_.density);

  build_pairs(pairs_, grains_, skin_, rig_.width, springs);
  build_wall_contacts(wall_contacts_, grains_, rig_.walls, triangle_grid_, skin_, time(), springs);
  wall_entry_.assign(grains_.owned, -1);
  for (std::size_t w = 0; w < wall_contacts_.grain.size(); ++w)
    wall_entry_[static_cast<std::size_t>(wall_contacts_.grain[w])] = static_cast<std::int32_t>(w);
  x_built_.assign(grains_.x.begin(), grains_.x.begin() + static_cast<std::ptrdiff_t>(grains_.owned));
  y_built_.assign(grains_.y.begin(), grains_.y.begin() + static_cast<std::ptrdiff_t>(grains_.owned));
  z_built_.assign(grains_.z.begin(), grains_.z.begin() + static_cast<std::ptrdiff_t>(grains_.owned));
  time_built_ = time();

  int const cores = std::max(1, omp_get_num_procs() / decomposition_.ranks_on_node());
  team_.allow(std::clamp(static_cast<int>(grains_.owned / grains_a_thread), 1, std::min(omp_get_max_threads(), cores)));
  batches_.resize(static_cast<std::size_t>(team_.most()));
  for (WallBatch& batch : batches_) batch.reserve(wall_contacts_.springs.size());
}

void Simulation::advance(std::int64_t steps) {
  std::int64_t const end = steps_ + steps;
  while (steps_ < end) {
    std::int64_t const safe = look();
    std::int64_t const count = std::min(safe, end - steps_);
    team_.time(count, [&] { run_steps(count); });
  }
}

void Simulation::run_steps(std::int64_t count) {
  std::int64_t pushed_back = 0;
  StepBarrier barrier;
#pragma omp parallel num_threads(team_.threads())
  {
    int const thread = omp_get_thread_num(), threads = omp_get_num_threads();
    Range const own = share(grains_.owned, thread, threads), pairs = share(pairs_.size(), thread, threads);
    auto const& near_walls = wall_contacts_.grain;
    auto const wall_entry = [&](std::size_t row) {
      return static_cast<std::size_t>(std::ranges::lower_bound(near_walls, static_cast<std::int32_t>(row)) -
                                      near_walls.begin());
    };
    Range const walls{wall_entry(own.from), wall_entry(own.to)};
    Watch watch;
    std::int64_t pushed = 0;
    double const dt = motion_.time_step;
    for (std::int64_t s = 0; s < count; ++s) {
      drift(own.from, own.to);
      barrier.wait(threads);
      if (decomposition_.size() > 1) {
        if (thread == 0) decomposition_.update_ghosts(grains_);
        barrier.wait(threads);
      }
      double const now = static_cast<double>(steps_ + s + 1) * dt;
      double const pair_overlap =
          evaluate_pairs(pairs_, grains_, motion_.between_grains, rig_.width, dt, pairs.from, pairs.to);
      WallReport const report = evaluate_walls(wall_contacts_, batches_[static_cast<std::size_t>(thread)], grains_,
                                               rig_.walls, motion_.at_walls, now, dt, walls.from, walls.to);
      watch.overlap = std::max({watch.overlap, pair_overlap, report.worst_overlap});
      pushed = report.pushed_back;
      barrier.wait(threads);
      kick(own.from, own.to, watch);
    }
#pragma omp critical
    {
      pushed_back += pushed;
      watch_.overlap = std::max(watch_.overlap, watch.overlap);
      watch_.step_squared = std::max(watch_.step_squared, watch.step_squared);
      watch_.broken = std::max(watch_.broken, watch.broken);
    }
  }
  pushed_back_ = pushed_back;
  steps_ += count;
}

void Simulation::drift(std::size_t from, std::size_t to) {
  double* __restrict x = grains_.x.data(), * __restrict y = grains_.y.data(), * __restrict z = grains_.z.data();
  double const* __restrict vx = grains_.vx.data(), * __restrict vy = grains_.vy.data(), * __restrict vz = grains_.vz.data();
  double const dt = motion_.time_step, width = rig_.width;
#pragma omp simd
  for (std::size_t i = from; i < to; ++i) {
    x[i] += vx[i] * dt;
    z[i] += vz[i] * dt;
    double moved = y[i] + vy[i] * dt;
    moved = moved < 0 ? moved + width : moved;
    y[i] = moved >= width ? moved - width : moved;
  }
}

void Simulation::kick(std::size_t from, std::size_t to, Watch& watch) {
  double const dt = motion_.time_step;
  Vec3 const gravity = rig_.gravity;
  double fastest = 0, broken = 0;
  for (std::size_t i = from; i < to; ++i) {
    alignas(32) double force[4] = {0, 0, 0, 0};
    alignas(32) double torque[4] = {0, 0, 0, 0};
    add_pair_actions(pairs_, i, force, torque);
    std::int32_t const entry = wall_entry_[i];
    auto const w = static_cast<std::size_t>(entry);
    if (entry >= 0) {
      for (std::size_t c = 0; c < 3; ++c) force[c] += wall_contacts_.force[w][c];
      for (std::size_t c = 0; c < 3; ++c) torque[c] += wall_contacts_.torque[w][c];
    }
    double const per_mass = dt / grains_.mass[i];
    double const per_inertia = per_mass / (0.4 * grains_.radius[i] * grains_.radius[i]);
    grains_.vx[i] += force[0] * per_mass + gravity.x() * dt;
    grains_.vy[i] += force[1] * per_mass + gravity.y() * dt;
    grains_.vz[i] += force[2] * per_mass + gravity.z() * dt;
    grains_.wx[i] += torque[0] * per_inertia;
    grains_.wy[i] += torque[1] * per_inertia;
    grains_.wz[i] += torque[2] * per_inertia;
    double const speed_squared =
        grains_.vx[i] * grains_.vx[i] + grains_.vy[i] * grains_.vy[i] + grains_.vz[i] * grains_.vz[i];
    fastest = std::max(fastest, speed_squared);
    if (!(speed_squared < fastest_grain * fastest_grain)) broken = 1;  // NaN too
    if (entry >= 0) wall_contacts_.path[w] += std::sqrt(speed_squared) * dt;
  }
  watch.step_squared = std::max(watch.step_squared, fastest * dt * dt);
  watch.broken = std::max(watch.broken, broken);
}

PowderBed Simulation::gather() {
  std::vector<LocalSpring> local;
  append_springs(pairs_, grains_, local);
  append_springs(wall_contacts_, grains_, local);
  std::vector<ContactSpring> springs;
  for (LocalSpring const& spring : local) {
    if (static_cast<std::size_t>(spring.row_a) < grains_.owned) springs.push_back(spring.spring);
  }
  std::vector<GrainRecord> records(grains_.owned);
  for (std::size_t i = 0; i < records.size(); ++i) records[i] = grains_.record(i);
  records = communicator_.all_gather(records);
  std::ranges::sort(records, {}, &GrainRecord::id);

  PowderBed bed;
  for (GrainRecord const& r : records) {
    bed.add(r.id, {r.x, r.y, r.z}, r.radius, r.material);
    bed.vx.back() = r.vx;
    bed.vy.back() = r.vy;
    bed.vz.back() = r.vz;
    bed.wx.back() = r.wx;
    bed.wy.back() = r.wy;
    bed.wz.back() = r.wz;
  }
  bed.contacts = communicator_.all_gather(springs);
  sort_springs(bed.contacts);
  return bed;
}

std::int64_t Simulation::count_faster_than(double speed) const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < grains_.owned; ++i) {
    double const squared =
        grains_.vx[i] * grains_.vx[i] + grains_.vy[i] * grains_.vy[i] + grains_.vz[i] * grains_.vz[i];
    count += squared > speed * speed;
  }
  return communicator_.sum(count);
}

std::int64_t Simulation::touching_pairs() const {
  std::int64_t count = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    count += pairs_.touching[k] && static_cast<std::size_t>(pairs_.first[k]) < grains_.owned;
  return communicator_.sum(count);
}

}  // namespace layerloop::dem
