#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>
#include <utility>

#include "dem/simulation.hpp"
#include "dem/step_barrier.hpp"

// The steps of a Simulation: who computes which pairs, and in what order rows move.
namespace layerloop::dem {
namespace {
constexpr double steps_a_choice = 60;    // aimed at, between choices of near pairs
constexpr double least_half_gap = 5e-5;  // of the smallest radius

double squared(double x, double y, double z) { return x * x + y * y + z * z; }

}  // namespace

void Simulation::advance(std::int64_t steps) {
  std::int64_t const end = steps_ + steps;
  while (steps_ < end) {
    std::int64_t const safe = look();
    std::int64_t const count = std::min(safe, end - steps_);
    team_.time(count, [&] { run_steps(count); });
  }
}

void Simulation::share_out(int shares) {
  if (!shares_.empty()) {
    std::vector<NearPairs const*> near;
    for (Share const& share : shares_) near.push_back(&share.near);
    make_dormant(neighbours_, near);
  }
  double fastest = fastest_ghost_squared();
  for (std::size_t i = 0; i < grains_.owned; ++i)
    fastest = std::max(fastest, squared(grains_[i].vx, grains_[i].vy, grains_[i].vz));
  shares_.resize(static_cast<std::size_t>(shares));
  for (int part = 0; part < shares; ++part) {
    Share& share = shares_[static_cast<std::size_t>(part)];
    std::size_t const load = neighbours_.size() + grains_.owned;  // a row costs about as much as a pair
    auto const cut = [&](int before) {
      std::size_t const share_of_load = load * static_cast<std::size_t>(before) / static_cast<std::size_t>(shares);
      auto const rows = std::views::iota(std::size_t{0}, grains_.owned);
      auto const is_before = [&](std::size_t row) {
        return static_cast<std::size_t>(neighbours_.begin[row]) + row < share_of_load;
      };
      return static_cast<std::size_t>(std::ranges::partition_point(rows, is_before) - rows.begin());
    };
    share.near.from = part == 0 ? 0 : cut(part);
    share.near.to = part + 1 == shares ? grains_.owned : cut(part + 1);
    share.near.dormant = neighbours_.dormant;
    share.books = EnergyBooks(EnergyUnit(unit_));
  }
  way_since_choice_ = 0;
  half_gap_ = suitable_half_gap(fastest);
  for (Share& share : shares_) choose_near_pairs(share, half_gap_);
}

double Simulation::suitable_half_gap(double fastest_squared) const {
  double const way = steps_a_choice * std::sqrt(fastest_squared) * motion_.time_step;
  return std::clamp(way, least_half_gap * smallest_radius_, 0.5 * skin_);
}

void Simulation::choose_near_pairs(Share& share, double half_gap) {
  if (motion_.keeps_energy_ledger) share.books.finish(grains_, moving_walls_, motion_.time_step);
  share.near = choose_near(share.near, neighbours_, grains_, period_, 2 * half_gap + reach_,
                           laws_.form.rolling == RollingModel::epsd2);
  share.actions.assign(share.near.slots(), {});
}

void Simulation::evaluate(Share& share, std::size_t chunk, PhaseClock& clock, PhaseTimes& times) {
  std::size_t const from = share.near.from + chunk * NearPairs::rows_a_chunk,
                    to = std::min(from + NearPairs::rows_a_chunk, share.near.to);
  double const dt = motion_.time_step;
  bool const keeps_books = motion_.keeps_energy_ledger;
  if (keeps_books) share.books.book_pairs(share.near, chunk, grains_, laws_, period_, moving_walls_, dt);
  double const overlap = evaluate_pairs(share.near, chunk, grains_, laws_, period_, dt, unit_, share.actions.data());
  clock.add_to(times.pairs);
  auto const& near_walls = wall_contacts_.grain;
  auto const entry = [&](std::size_t row) {
    return static_cast<std::size_t>(std::ranges::lower_bound(near_walls, static_cast<std::int32_t>(row)) -
                                    near_walls.begin());
  };
  std::size_t const first = entry(from), last = entry(to);
  list_wall_contacts(wall_contacts_, share.batch, grains_, scene(), wall_laws_, first, last);
  if (keeps_books)
    share.books.book_walls(chunk, wall_contacts_, share.batch, grains_, scene(), wall_laws_[0], dt, first, last);
  double const wall_overlap = act_on_walls(wall_contacts_, share.batch, grains_, scene(), wall_laws_, dt, first, last);
  share.watch.overlap = std::max({share.watch.overlap, overlap, wall_overlap});
  clock.add_to(times.walls);
}

std::size_t Simulation::first_free_row(std::size_t number) const {
  NearPairs const& own = shares_[number].near;
  std::size_t row = own.from;
  for (std::size_t k = 0; k < number; ++k) row = std::clamp(shares_[k].near.reach(), row, own.to);
  return row;
}

double Simulation::step_free_rows(std::size_t number, std::size_t free, PhaseClock& clock, PhaseTimes& times) {
  Share& own = shares_[number];
  own.held.resize(free - own.near.from);
  double fastest = 0;
  for (std::size_t chunk = 0; chunk < own.near.chunks(); ++chunk) {
    evaluate(own, chunk, clock, times);
    std::size_t const from = own.near.from + chunk * NearPairs::rows_a_chunk,
                      to = std::min(from + NearPairs::rows_a_chunk, own.near.to), held = std::clamp(free, from, to);
    hold(own, from, held);
    ActionSlots const slots = in_ring(own);
    add_far_actions(number, held, to, slots);
    fastest = std::max(fastest, move(own, held, to, slots));
    clock.add_to(times.motion);
  }
  return fastest;
}

double Simulation::step_held_rows(std::size_t number, std::size_t free) {
  Share& own = shares_[number];
  add_far_actions(number, own.near.from, free, held_by(own));
  return move(own, own.near.from, free, held_by(own));
}

void Simulation::step(std::size_t number, std::int64_t so_far, StepBarrier& barrier, PhaseClock& clock,
                      PhaseTimes& times) {
  int const threads = static_cast<int>(shares_.size());
  std::size_t const free = first_free_row(number);
  double const fastest = step_free_rows(number, free, clock, times);
  barrier.wait(threads);
  clock.add_to(times.communication);
  if (number == 0) {
    std::vector<WallForces*> forces;
    for (Share& share : shares_) forces.push_back(&share.batch.force);
    moving_walls_.advance(static_cast<double>(so_far + 1) * motion_.time_step, motion_.time_step, forces);
  }
  shares_[number].fastest_squared = std::max(fastest, step_held_rows(number, free));
  clock.add_to(times.motion);
  barrier.wait(threads);
  if (decomposition_.size() > 1) {
    if (number == 0) {
      decomposition_.update_ghosts(grains_);
      ghosts_fastest_squared_ = fastest_ghost_squared();
    }
    barrier.wait(threads);
  }
  clock.add_to(times.communication);
}

void Simulation::run_steps(std::int64_t count) {
  if (static_cast<int>(shares_.size()) != team_.threads()) share_out(team_.threads());
  StepBarrier barrier;
#pragma omp parallel num_threads(team_.threads())
  {
    auto const number = static_cast<std::size_t>(omp_get_thread_num());
    Share& own = shares_[number];
    own.watch = {};
    PhaseTimes times;
    PhaseClock clock;
    double way = way_since_choice_, half_gap = half_gap_;  // the same on all threads
    for (std::int64_t s = 0; s < count; ++s) {
      step(number, steps_ + s, barrier, clock, times);
      double fastest = ghosts_fastest_squared_;
      for (Share const& share : shares_) fastest = std::max(fastest, share.fastest_squared);
      way += std::sqrt(fastest) * motion_.time_step;
      if (way > half_gap) {
        half_gap = suitable_half_gap(fastest);
        way = 0;
        choose_near_pairs(own, half_gap);
        barrier.wait(static_cast<int>(shares_.size()));
        clock.add_to(times.neighbours);
      }
    }
    if (motion_.keeps_energy_ledger) own.books.finish(grains_, moving_walls_, motion_.time_step);
    if (number == 0) {
      way_since_choice_ = way;
      half_gap_ = half_gap;
      phases_ += times;
    }
  }
  steps_ += count;
  for (Share& share : shares_) {
    booked_ += share.books.take();
    watch_.overlap = std::max(watch_.overlap, share.watch.overlap);
    watch_.step_squared = std::max(watch_.step_squared, share.watch.step_squared);
    watch_.broken = std::max(watch_.broken, share.watch.broken);
  }
}

double Simulation::fastest_ghost_squared() const {
  double fastest = 0;
  for (std::size_t i = grains_.owned; i < grains_.size(); ++i)
    fastest = std::max(fastest, squared(grains_[i].vx, grains_[i].vy, grains_[i].vz));
  return fastest;
}

Simulation::ActionSlots Simulation::in_ring(Share& share) { return {share.actions.data(), 0, NearPairs::ring - 1}; }

Simulation::ActionSlots Simulation::held_by(Share& share) {
  return {share.held.data(), share.near.from, ~std::size_t{0}};
}

void Simulation::hold(Share& share, std::size_t from, std::size_t to) {
  for (std::size_t row = from; row < to; ++row)
    held_by(share).of(row) = std::exchange(in_ring(share).of(row), GrainAction{});
}

void Simulation::add_far_actions(std::size_t number, std::size_t from, std::size_t to, ActionSlots const& slots) {
  for (std::size_t k = 0; k <= number; ++k) {
    auto const& rows = shares_[k].near.far_rows;
    auto at = std::ranges::lower_bound(rows, static_cast<std::int32_t>(from)) - rows.begin();
    for (; at < std::ssize(rows) && static_cast<std::size_t>(rows[static_cast<std::size_t>(at)]) < to; ++at) {
      GrainAction& waiting = shares_[k].actions[static_cast<std::size_t>(NearPairs::far_slot + at)];
      GrainAction& sum = slots.of(static_cast<std::size_t>(rows[static_cast<std::size_t>(at)]));
      for (std::size_t c = 0; c < 3; ++c) sum.force[c] += waiting.force[c];
      for (std::size_t c = 0; c < 3; ++c) sum.torque[c] += waiting.torque[c];
      waiting = {};
    }
  }
}

namespace {
using Quad [[gnu::vector_size(32)]] = double;
using WholeQuad [[gnu::vector_size(32)]] = std::int64_t;

Quad& quad(double& first) { return reinterpret_cast<Quad&>(first); }

Quad in_units(std::array<std::uint64_t, 4> const& whole, double unit) {
  return __builtin_convertvector(reinterpret_cast<WholeQuad const&>(whole), Quad) * unit;
}
}  // namespace

double Simulation::move(Share& own, std::size_t from, std::size_t to, ActionSlots const& slots) {
  double const dt = motion_.time_step, far = std::numeric_limits<double>::infinity();
  // the fourth of each quad is no component: radius, 1/m and 1/I stay what they are
  Quad const step{dt, dt, dt, 0}, gravity{rig_.gravity.x() * dt, rig_.gravity.y() * dt, rig_.gravity.z() * dt, 0};
  Quad const low{std::isfinite(period_.x) ? 0.0 : -far, 0, -far, -far}, high{period_.x, period_.y, far, far};
  double const drag = 6 * std::numbers::pi * motion_.contact.gas_viscosity * dt;  // Stokes, of gas at rest
  bool const books_drag = motion_.keeps_energy_ledger && drag > 0;
  if (books_drag) own.books.before_move(grains_, from, to);
  double fastest = 0, broken = 0;
  for (std::size_t i = from; i < to; ++i) {
    GrainAction& action = slots.of(i);
    Quad force = in_units(action.force, unit_.force), torque = in_units(action.torque, unit_.torque);
    action = {};
    if (is_asleep(grains_.quiet[i])) continue;
    std::int32_t const entry = wall_entry_[i];
    auto const w = static_cast<std::size_t>(entry);
    if (entry >= 0) {
      force += reinterpret_cast<Quad const&>(wall_contacts_.force[w]);
      torque += reinterpret_cast<Quad const&>(wall_contacts_.torque[w]);
    }
    GrainState& g = grains_[i];
    Quad v = quad(g.vx) + (force * (dt * g.inverse_mass) + gravity);
    if (drag > 0) {
      double const slower = 1 / (1 + drag * g.radius * g.inverse_mass);
      v *= Quad{slower, slower, slower, 1};
    }
    quad(g.wx) += torque * (dt * g.inverse_inertia);
    Quad const r = quad(g.x) + v * step, up = r + high, down = r - high;
    quad(g.x) = r < low ? up : (r >= high ? down : r);
    quad(g.vx) = v;
    double const speed_squared = squared(v[0], v[1], v[2]);
    fastest = std::max(fastest, speed_squared);
    if (!(speed_squared < fastest_grain * fastest_grain)) broken = 1;  // NaN too
    if (entry >= 0) wall_contacts_.path[w] += std::sqrt(speed_squared) * dt;
  }
  if (books_drag) own.books.after_move(grains_, from, to, drag / dt, dt);
  own.watch.step_squared = std::max(own.watch.step_squared, fastest * dt * dt);
  own.watch.broken = std::max(own.watch.broken, broken);
  return fastest;
}

}  // namespace layerloop::dem
