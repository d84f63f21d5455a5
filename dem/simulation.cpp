#include "dem/simulation.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "core/grain_size.hpp"
#include "core/rayleigh_time.hpp"
#include "dem/step_barrier.hpp"

namespace layerloop::dem {
namespace {
constexpr double skin_over_smallest_radius = 0.35;
constexpr std::size_t grains_a_thread = 400;  // fewer are not worth a barrier
constexpr double steps_a_choice = 60;         // aimed at, between choices of near pairs
constexpr double least_half_gap = 5e-5;       // of the smallest radius

struct Range {
  std::size_t from, to;
};

Range share(std::size_t n, int part, int parts) {
  auto const p = static_cast<std::size_t>(part), all = static_cast<std::size_t>(parts);
  return {n * p / all, n * (p + 1) / all};
}

double squared(double x, double y, double z) { return x * x + y * y + z * z; }

double farthest_reach(std::vector<ContactLaw> const& laws, double radius) {
  double reach = 0;
  for (ContactLaw const& law : laws) reach = std::max(reach, reach_gap(law, radius));
  return reach;
}

double stiffest(std::vector<ContactLaw> const& laws) {
  return std::ranges::max(laws, {}, &ContactLaw::normal_stiffness).normal_stiffness;
}
}  // namespace

Motion motion_of(Case const& checked) {
  double const smallest = std::ranges::min(fed_powder(checked).diameters) / 2;
  std::string const& name = checked.material.name;
  return {.between_grains = grain_law(checked, name, name),
          .at_walls = wall_law(checked, name),
          .contact = contact_between(checked, name, name),
          .density = checked.material.density,
          .time_step = checked.contact.time_step_fraction * shortest_rayleigh_time(checked, smallest),
          .grains_sleep = checked.run.grains_sleep,
          .keeps_energy_ledger = checked.run.energy_ledger,
          .mixture = mixture_of(checked)};
}

double shortest_contact_time(Motion const& motion, double radius, double speed) {
  if (motion.mixture.density.empty()) return hertz_contact_time(radius, motion.density, speed, motion.contact);
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < motion.mixture.materials(); ++m)
    shortest =
        std::min(shortest, hertz_contact_time(radius, motion.mixture.density[m], speed, motion.mixture.contact[m]));
  return shortest;
}

Simulation::Simulation(Motion motion, Rig rig, Communicator const& communicator)
    : motion_(motion),
      rig_(std::move(rig)),
      communicator_(communicator),
      decomposition_(communicator, rig_.length),
      moving_walls_(rig_.walls, communicator),
      period_{rig_.length, rig_.width},
      laws_{law_form(motion_.contact), 1, {motion_.between_grains}},
      wall_laws_{motion_.at_walls} {
  if (motion_.mixture.density.empty()) return;
  laws_.materials = static_cast<std::int32_t>(motion_.mixture.materials());
  laws_.laws = motion_.mixture.between_grains;
  wall_laws_ = motion_.mixture.at_walls;
}

void Simulation::scatter(PowderBed const& bed) {
  grains_.clear();
  first_springs_ = bed.contacts;
  steps_ = next_sink_check_ = next_sleep_check_ = rebuilds_ = nipped_ = 0;
  largest_overlap_ = 0;
  moving_walls_.start();
  phases_ = {};
  watch_ = {};
  if (bed.size() == 0) throw InputError("there is no grain to move (the bed is empty) raise powder.particles");
  auto const [first, last] = std::ranges::minmax(bed.material);
  if (laws_.materials > 1 && (first < 0 || last >= laws_.materials))
    throw InputError(fmt::format("the bed has a grain of material {} (there are materials 0 to {}) give it one of them",
                                 first < 0 ? first : last, laws_.materials - 1));
  auto const [smallest, largest] = std::ranges::minmax(bed.radius);
  smallest_radius_ = smallest;
  largest_radius_ = largest;
  skin_ = skin_over_smallest_radius * smallest;
  wall_reach_ = farthest_reach(wall_laws_, largest);
  reach_ = std::max(farthest_reach(laws_.laws, largest), wall_reach_);
  if (rig_.width < 4 * largest + 2 * (skin_ + reach_)) {
    throw InputError(
        fmt::format("the bed is {:.3g} um wide (a grain of {:.3g} um would meet itself around the period) "
                    "make machine.width at least {:.3g} um",
                    rig_.width * 1e6, 2e6 * largest, 4.2e6 * largest + 2e6 * (skin_ + reach_)));
  }
  if (rig_.length < 4 * largest + 2 * (skin_ + reach_))
    throw InputError("the period along x is shorter than two grains (a grain would meet itself) use a longer one");
  unit_ = ActionUnit(std::max(stiffest(laws_.laws), stiffest(wall_laws_)), largest);
  mesh_grids_ = grids_of(rig_.walls, 2 * largest);
  Range const own = share(bed.size(), communicator_.rank(), communicator_.size());
  for (std::size_t i = own.from; i < own.to; ++i) {
    grains_.push_back(record_of(bed, i, motion_.density_of(bed.material[i])));
  }
  grains_.owned = grains_.size();
  grain_count_ = static_cast<std::int64_t>(bed.size());
  neighbours_ = {};
  shares_.clear();
  wall_contacts_ = {};
  if (Fault const lost = find_lost_grain(); communicator_.any(!lost.text.empty())) fail(lost);
  rebuild();
  check_first_overlaps();
  open_energy_ledger();
}

void Simulation::append_all_springs(std::vector<LocalSpring>& springs) const {
  for (Share const& share : shares_) append_springs(share.near, neighbours_, grains_, springs);
  append_springs(wall_contacts_, grains_, springs);
}

std::vector<std::int64_t> Simulation::loads() const {
  std::vector<std::int64_t> load(grains_.owned, 1);
  if (neighbours_.begin.size() != grains_.owned + 1) return load;  // before the first list
  for (std::size_t i = 0; i < grains_.owned; ++i) {
    if (!is_asleep(grains_.quiet[i])) load[i] += 2 + neighbours_.begin[i + 1] - neighbours_.begin[i];
  }
  return load;
}

void Simulation::rebuild() {
  PhaseClock clock;
  std::vector<LocalSpring> local;
  append_all_springs(local);
  std::vector<GrainRecord> records(grains_.owned);
  for (std::size_t i = 0; i < records.size(); ++i) records[i] = grains_.record(i);
  bool const first = rebuilds_++ == 0;  // springs come from the bed then, and every rank has them all
  std::vector<ContactSpring> springs;
  decomposition_.redistribute(records, loads(), local, springs);
  if (first) springs = std::move(first_springs_);
  std::erase_if(records, [](GrainRecord const& r) { return r.leaves != 0; });

  double const cell = 2 * largest_radius_;  // neighbours in space are neighbours in memory
  auto const place = [&](GrainRecord const& r) {
    return std::tuple(std::floor(r.state.y / (8 * cell)), std::floor(r.state.x / cell), std::floor(r.state.z / cell),
                      r.state.y, r.id);
  };
  std::ranges::sort(records, {}, place);
  grains_.clear();
  for (GrainRecord const& record : records) grains_.push_back(record);
  records = {};  // many bytes a grain: given back before the neighbours need them
  grains_.owned = grains_.size();
  decomposition_.add_ghosts(grains_, 2 * largest_radius_ + skin_ + reach_);
  grains_.close();

  build_neighbours(neighbours_, grains_, skin_ + reach_, period_, springs);
  build_wall_contacts(wall_contacts_, grains_, scene(), mesh_grids_, skin_ + reach_, springs);
  wall_entry_.assign(grains_.owned, -1);
  for (std::size_t w = 0; w < wall_contacts_.grain.size(); ++w)
    wall_entry_[static_cast<std::size_t>(wall_contacts_.grain[w])] = static_cast<std::int32_t>(w);
  x_built_.resize(grains_.owned);
  y_built_.resize(grains_.owned);
  z_built_.resize(grains_.owned);
  for (std::size_t i = 0; i < grains_.owned; ++i) {
    x_built_[i] = grains_[i].x;
    y_built_[i] = grains_[i].y;
    z_built_[i] = grains_[i].z;
  }
  moving_walls_.mark();

  int const cores = std::max(1, omp_get_num_procs() / decomposition_.ranks_on_node());
  team_.allow(std::clamp(static_cast<int>(grains_.owned / grains_a_thread), 1, std::min(omp_get_max_threads(), cores)));
  shares_.clear();
  share_out(team_.threads());
  clock.add_to(phases_.neighbours);
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
    auto const [first, last] = dem::share(neighbours_.size() + grains_.owned, part, shares);
    // a row costs about as much as a pair
    auto const cut = [&](std::size_t load) {
      auto const rows = std::views::iota(std::size_t{0}, grains_.owned);
      auto const is_before = [&](std::size_t row) {
        return static_cast<std::size_t>(neighbours_.begin[row]) + row < load;
      };
      return static_cast<std::size_t>(std::ranges::partition_point(rows, is_before) - rows.begin());
    };
    share.near.from = part == 0 ? 0 : cut(first);
    share.near.to = part + 1 == shares ? grains_.owned : cut(last);
    share.near.dormant = neighbours_.dormant;
    share.books = EnergyBooks(EnergyUnit(unit_));
  }
  way_since_choice_ = 0;
  half_gap_ = suitable_half_gap(fastest);
  for (Share& share : shares_) choose_near_pairs(share, half_gap_);
}

void Simulation::advance(std::int64_t steps) {
  std::int64_t const end = steps_ + steps;
  while (steps_ < end) {
    std::int64_t const safe = look();
    std::int64_t const count = std::min(safe, end - steps_);
    team_.time(count, [&] { run_steps(count); });
  }
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

void Simulation::run_steps(std::int64_t count) {
  if (static_cast<int>(shares_.size()) != team_.threads()) share_out(team_.threads());
  std::vector<WallForces*> wall_forces;
  for (Share& share : shares_) wall_forces.push_back(&share.batch.force);
  StepBarrier barrier;
#pragma omp parallel num_threads(team_.threads())
  {
    auto const number = static_cast<std::size_t>(omp_get_thread_num());
    int const threads = omp_get_num_threads();
    Share& own = shares_[number];
    own.watch = {};
    PhaseTimes times;
    PhaseClock clock;
    double way = way_since_choice_, half_gap = half_gap_;  // the same on all threads
    for (std::int64_t s = 0; s < count; ++s) {
      std::size_t waits = own.near.from;  // rows below must stay until earlier shares have computed their pairs
      for (std::size_t k = 0; k < number; ++k) waits = std::clamp(shares_[k].near.reach(), waits, own.near.to);
      own.held.resize(waits - own.near.from);
      double fastest = 0;
      for (std::size_t chunk = 0; chunk < own.near.chunks(); ++chunk) {
        evaluate(own, chunk, clock, times);
        std::size_t const from = own.near.from + chunk * NearPairs::rows_a_chunk,
                          to = std::min(from + NearPairs::rows_a_chunk, own.near.to),
                          held = std::clamp(waits, from, to);
        hold(own, from, held);
        ActionSlots const slots = in_ring(own);
        add_far_actions(number, held, to, slots);
        fastest = std::max(fastest, move(own, held, to, slots));
        clock.add_to(times.motion);
      }
      barrier.wait(threads);
      clock.add_to(times.communication);
      if (number == 0) {
        double const dt = motion_.time_step;
        moving_walls_.advance(static_cast<double>(steps_ + s + 1) * dt, dt, wall_forces);
      }
      add_far_actions(number, own.near.from, waits, held_by(own));
      fastest = std::max(fastest, move(own, own.near.from, waits, held_by(own)));
      own.fastest_squared = fastest;
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
      fastest = ghosts_fastest_squared_;
      for (Share const& share : shares_) fastest = std::max(fastest, share.fastest_squared);
      way += std::sqrt(fastest) * motion_.time_step;
      if (way > half_gap) {
        half_gap = suitable_half_gap(fastest);
        way = 0;
        choose_near_pairs(own, half_gap);
        barrier.wait(threads);
        clock.add_to(times.neighbours);
      }
    }
    if (motion_.keeps_energy_ledger) own.books.finish(grains_, moving_walls_, motion_.time_step);
#pragma omp single
    {
      way_since_choice_ = way;
      half_gap_ = half_gap;
    }
    if (number == 0) {
      phases_.pairs += times.pairs;
      phases_.walls += times.walls;
      phases_.motion += times.motion;
      phases_.neighbours += times.neighbours;
      phases_.communication += times.communication;
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

PowderBed Simulation::gather() {
  std::vector<LocalSpring> local;
  append_all_springs(local);
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
    GrainState const& g = r.state;
    bed.add(r.id, {g.x, g.y, g.z}, g.radius, r.material);
    bed.vx.back() = g.vx;
    bed.vy.back() = g.vy;
    bed.vz.back() = g.vz;
    bed.wx.back() = g.wx;
    bed.wy.back() = g.wy;
    bed.wz.back() = g.wz;
  }
  bed.contacts = communicator_.all_gather(springs);
  sort_springs(bed.contacts);
  return bed;
}

std::int64_t Simulation::count_faster_than(double speed) const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < grains_.owned; ++i)
    count += squared(grains_[i].vx, grains_[i].vy, grains_[i].vz) > speed * speed;
  return communicator_.sum(count);
}

std::int64_t Simulation::touching_pairs() const {
  std::int64_t count = 0;  // a pair across a border stands on both of its ranks: counted where its lower id is at home
  for (Share const& share : shares_) count += count_touching(share.near, neighbours_, grains_.owned);
  return communicator_.sum(count);
}

std::int64_t Simulation::sleeping() const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < grains_.owned; ++i) count += is_asleep(grains_.quiet[i]);
  return communicator_.sum(count);
}

double Simulation::coordination() const {
  return 2.0 * static_cast<double>(touching_pairs()) / static_cast<double>(grain_count_);
}

}  // namespace layerloop::dem
