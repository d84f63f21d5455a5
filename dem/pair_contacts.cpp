#include "dem/pair_contacts.hpp"

#include <algorithm>

#include "dem/lanes.hpp"
#include "dem/law_lanes.hpp"

namespace layerloop::dem {
namespace {

/// Room for all listed pairs: memory that is not touched costs nothing, arrays that grow hold twice what they need.
void reserve(NearPairs& near, std::size_t pairs, bool has_turn) {
  std::size_t const most = pairs + 2 * lanes_at_once * ((near.to - near.from) / NearPairs::rows_a_chunk + 1);
  near.first.reserve(most);
  near.second.reserve(most);
  near.touching.reserve(most);
  for (auto* values : {&near.spring_x, &near.spring_y, &near.spring_z}) values->reserve(most);
  for (auto* values : {&near.turn_x, &near.turn_y, &near.turn_z})
    if (has_turn) values->reserve(most);
}

void append(NearPairs& near, std::int32_t first, std::int32_t second, PairSpring const& spring, bool touching,
            bool has_turn) {
  near.first.push_back(first);
  near.second.push_back(second);
  near.spring_x.push_back(spring.x);
  near.spring_y.push_back(spring.y);
  near.spring_z.push_back(spring.z);
  if (has_turn) {
    near.turn_x.push_back(spring.turn_x);
    near.turn_y.push_back(spring.turn_y);
    near.turn_z.push_back(spring.turn_z);
  }
  near.touching.push_back(touching);
}

PairSpring spring_at(NearPairs const& near, std::size_t n) {
  PairSpring spring{near.spring_x[n], near.spring_y[n], near.spring_z[n], 0, 0, 0};
  if (!near.turn_x.empty())
    spring.turn_x = near.turn_x[n], spring.turn_y = near.turn_y[n], spring.turn_z = near.turn_z[n];
  return spring;
}

/// Surfaces closer than `gap`, and not both asleep?
bool is_near(Grains const& g, std::size_t i, std::size_t j, Period const& period, double gap) {
  GrainState const &a = g[i], &b = g[j];
  double const dx = wrapped(a.x - b.x, period.x), dy = wrapped(a.y - b.y, period.y), dz = a.z - b.z;
  double const reach = a.radius + b.radius + gap;
  return dx * dx + dy * dy + dz * dz < reach * reach && !(is_asleep(g.quiet[i]) && is_asleep(g.quiet[j]));
}

/// A block of pairs while it is worked on.
struct PairBlock {
  PairLanes grains;
  ForceLanes force;  // on the first grain; the second gets its opposite
  TorqueLanes on_first, on_second;
  Lanes<std::int64_t> law, touching;
  // what the first half of a contact leaves for the second
  Lanes<double> nx, ny, nz, arm_first, arm_second, radius, contact_radius, elastic, attraction, viscous;
};

struct Springs {
  double *x, *y, *z, *turn_x, *turn_y, *turn_z;
};

/// Eight lanes of a quantity.
Numbers& eight(double* lanes) { return *reinterpret_cast<Numbers*>(lanes); }
Numbers const& eight(double const* lanes) { return *reinterpret_cast<Numbers const*>(lanes); }

void store(Lanes<std::int64_t>& to, std::size_t at, Numbers const& value, double per_unit) {
  *reinterpret_cast<Flags*>(&to[at]) = __builtin_convertvector(value * per_unit, Flags);
}

Numbers difference(Lanes<double> const& a, Lanes<double> const& b, std::size_t l) {
  return eight(&a[l]) - eight(&b[l]);
}

/// First half of the contacts [0, count) of a block. In two halves, because a processor that looks ahead sees more of
/// them at a time when each is short. \return largest overlap over the smaller grain's radius
template <Reach reach, bool many_laws>
double press(PairBlock& pairs, std::size_t count, ContactLaw const* laws, Period const& period) {
  PairLanes const& g = pairs.grains;
  BasicContactLaw<Numbers> law = filled_law(laws[0]);
  double const half_x = 0.5 * period.x, half_y = 0.5 * period.y;
  Numbers const none{};
  Numbers worst{};
  for (std::size_t l = 0; l < count; l += lanes_at_once) {
    Numbers dx = eight(&g.dx[l]), dy = eight(&g.dy[l]);
    Numbers const dz = eight(&g.dz[l]), x_up = dx + period.x, x_down = dx - period.x, y_up = dy + period.y,
                  y_down = dy - period.y;
    dx = dx > half_x ? x_down : dx;
    dx = dx < -half_x ? x_up : dx;
    dy = dy > half_y ? y_down : dy;
    dy = dy < -half_y ? y_up : dy;
    Numbers const squared = dx * dx + dy * dy + dz * dz, near = inverse_root(squared);
    Numbers const ra = eight(&g.first.radius[l]), rb = eight(&g.second.radius[l]), sum = ra + rb,
                  overlap = sum - squared * near;
    Numbers const felt = overlap > 0.0 ? overlap : none;
    BasicContactState<Numbers> state;
    state.overlap = overlap;
    state.radius = ra * rb * inverse(sum);
    state.inverse_mass = eight(&g.inverse_mass[l]);
    if constexpr (reach == Reach::beyond) {
      Numbers const close = ra * rb * near;
      state.closeness = close * close;
    }
    if constexpr (reach != Reach::touch) state.was_touching = *reinterpret_cast<Flags*>(&pairs.touching[l]) != 0;
    if constexpr (many_laws) law = gathered_law(laws, &pairs.law[l]);
    NormalForce<Numbers> const force = normal_force<reach>(law, state);
    eight(&pairs.nx[l]) = dx * near, eight(&pairs.ny[l]) = dy * near, eight(&pairs.nz[l]) = dz * near;
    eight(&pairs.arm_first[l]) = ra - 0.5 * felt, eight(&pairs.arm_second[l]) = rb - 0.5 * felt;
    eight(&pairs.radius[l]) = state.radius;
    eight(&pairs.contact_radius[l]) = force.contact_radius;
    eight(&pairs.elastic[l]) = force.elastic;
    eight(&pairs.attraction[l]) = force.attraction;
    eight(&pairs.viscous[l]) = force.viscous;
    *reinterpret_cast<Flags*>(&pairs.touching[l]) = force.touches;
    Numbers const relative = felt * roughly_inverse(ra < rb ? ra : rb);
    worst = relative > worst ? relative : worst;
  }
  double most = 0;
  for (int l = 0; l < 8; ++l) most = std::max(most, worst[l]);
  return most;
}

/// Between the halves: what loaded libraries add to the attraction of the pairs that touch.
void attract(PairBlock& pairs, std::size_t count, std::vector<UserAttraction> const& user) {
  double overlap[block], radius[block], speed[block], added[block] = {};
  std::size_t lane[block], touching = 0;
  PairLanes const& g = pairs.grains;
  for (std::size_t l = 0; l < count; ++l) {
    double const felt = 2 * (g.first.radius[l] - pairs.arm_first[l]);
    if (!(felt > 0)) continue;
    overlap[touching] = felt;
    radius[touching] = pairs.radius[l];
    speed[touching] = g.vx[l] * pairs.nx[l] + g.vy[l] * pairs.ny[l] + g.vz[l] * pairs.nz[l];
    lane[touching++] = l;
  }
  if (touching == 0) return;
  for (UserAttraction const& one : user) one.effect->add({touching, overlap, radius, speed}, one.values, added);
  for (std::size_t t = 0; t < touching; ++t) pairs.attraction[lane[t]] += added[t];
}

/// Second half.
template <RollingModel rolling, bool many_laws>
void rub(PairBlock& pairs, std::size_t count, Springs const& s, ContactLaw const* laws, double dt,
         ActionUnit const& unit) {
  PairLanes const& g = pairs.grains;
  SpinLanes const &a = g.first, &b = g.second;
  ForceLanes& f = pairs.force;
  TorqueLanes &p = pairs.on_first, &q = pairs.on_second;
  BasicContactLaw<Numbers> law = filled_law(laws[0]);
  constexpr bool has_turn = rolling == RollingModel::epsd2;
  for (std::size_t l = 0; l < count; l += lanes_at_once) {
    Numbers const arm_a = eight(&pairs.arm_first[l]), arm_b = eight(&pairs.arm_second[l]);
    auto const surface = [&](Lanes<double> const& of_a, Lanes<double> const& of_b) {
      return arm_a * eight(&of_a[l]) + arm_b * eight(&of_b[l]);
    };
    NormalForce<Numbers> force;
    force.contact_radius = eight(&pairs.contact_radius[l]);
    force.elastic = eight(&pairs.elastic[l]);
    force.attraction = eight(&pairs.attraction[l]);
    force.viscous = eight(&pairs.viscous[l]);
    BasicContactState<Numbers> state;
    state.radius = eight(&pairs.radius[l]);
    state.inverse_mass = eight(&g.inverse_mass[l]);
    state.nx = eight(&pairs.nx[l]), state.ny = eight(&pairs.ny[l]), state.nz = eight(&pairs.nz[l]);
    state.vx = eight(&g.vx[l]), state.vy = eight(&g.vy[l]), state.vz = eight(&g.vz[l]);
    state.sx = surface(a.wx, b.wx), state.sy = surface(a.wy, b.wy), state.sz = surface(a.wz, b.wz);
    state.wx = difference(a.wx, b.wx, l), state.wy = difference(a.wy, b.wy, l), state.wz = difference(a.wz, b.wz, l);
    state.spring_x = eight(s.x + l), state.spring_y = eight(s.y + l), state.spring_z = eight(s.z + l);
    if constexpr (has_turn)
      state.turn_x = eight(s.turn_x + l), state.turn_y = eight(s.turn_y + l), state.turn_z = eight(s.turn_z + l);
    if constexpr (many_laws) law = gathered_law(laws, &pairs.law[l]);
    BasicContactAction<Numbers> const c = act<rolling>(law, force, state, dt);
    eight(s.x + l) = c.spring_x, eight(s.y + l) = c.spring_y, eight(s.z + l) = c.spring_z;
    if constexpr (has_turn)
      eight(s.turn_x + l) = c.turn_x, eight(s.turn_y + l) = c.turn_y, eight(s.turn_z + l) = c.turn_z;
    store(f.x, l, c.fx, unit.per_force);
    store(f.y, l, c.fy, unit.per_force);
    store(f.z, l, c.fz, unit.per_force);
    store(p.x, l, -arm_a * c.qx - c.rx, unit.per_torque), store(q.x, l, c.rx - arm_b * c.qx, unit.per_torque);
    store(p.y, l, -arm_a * c.qy - c.ry, unit.per_torque), store(q.y, l, c.ry - arm_b * c.qy, unit.per_torque);
    store(p.z, l, -arm_a * c.qz - c.rz, unit.per_torque), store(q.z, l, c.rz - arm_b * c.qz, unit.per_torque);
  }
}

/// What every pair [0, count) of a block does to its grains.
/// \return largest overlap over the smaller grain's diameter
template <Reach reach, RollingModel rolling, bool many_laws>
double act_on(PairBlock& pairs, std::size_t count, Springs const& s, ContactLaw const* laws, Period const& period,
              double dt, ActionUnit const& unit, std::vector<UserAttraction> const& user) {
  double const worst = press<reach, many_laws>(pairs, count, laws, period);
  if (!user.empty()) attract(pairs, count, user);
  rub<rolling, many_laws>(pairs, count, s, laws, dt, unit);
  return 0.5 * worst;
}

using ActOn = double (*)(PairBlock&, std::size_t, Springs const&, ContactLaw const*, Period const&, double,
                         ActionUnit const&, std::vector<UserAttraction> const&);

template <Reach reach, bool many_laws>
ActOn kernel(RollingModel rolling) {
  return rolling == RollingModel::cdt ? act_on<reach, RollingModel::cdt, many_laws>
                                      : act_on<reach, RollingModel::epsd2, many_laws>;
}

template <bool many_laws>
ActOn kernel(LawForm const& form) {
  switch (form.reach) {
    case Reach::touch:
      return kernel<Reach::touch, many_laws>(form.rolling);
    case Reach::tear_off:
      return kernel<Reach::tear_off, many_laws>(form.rolling);
    case Reach::beyond:
      break;
  }
  return kernel<Reach::beyond, many_laws>(form.rolling);
}

/// A pair on its way into the second part of a chunk.
struct FarPair {
  std::size_t pair;
  std::int32_t first, second;
  PairSpring spring;
  bool touching;
};

void fill_up(NearPairs& near, std::int32_t far_away, bool has_turn) {
  while (near.first.size() % lanes_at_once != 0)
    append(near, far_away, static_cast<std::int32_t>(near.from), {}, false, has_turn);
}

/// Ends a chunk with its far pairs; their slots hold rows until all are known.
void end_chunk(NearPairs& near, Neighbours& neighbours, std::vector<FarPair>& far, std::int32_t far_away,
               bool has_turn) {
  fill_up(near, far_away, has_turn);
  near.far_part.push_back(near.first.size());
  near.far_slots.push_back(near.slot_first.size());
  for (FarPair const& pair : far) {
    neighbours.spring[pair.pair] = static_cast<std::int32_t>(near.first.size());
    append(near, pair.first, pair.second, pair.spring, pair.touching, has_turn);
  }
  fill_up(near, far_away, has_turn);
  near.slot_first.insert(near.slot_first.end(), near.first.begin() + static_cast<std::ptrdiff_t>(near.far_part.back()),
                         near.first.end());
  near.slot_second.insert(near.slot_second.end(),
                          near.second.begin() + static_cast<std::ptrdiff_t>(near.far_part.back()), near.second.end());
  near.chunk.push_back(near.first.size());
  far.clear();
}

/// Turns the rows of far pairs into slots.
void give_slots(NearPairs& near, std::size_t owned) {
  auto const last = static_cast<std::int32_t>(owned);
  for (std::size_t k = 0; k < near.slot_first.size(); ++k) {
    std::int32_t const higher = std::max(near.slot_first[k], near.slot_second[k]);
    if (higher < last) near.far_rows.push_back(higher);
  }
  std::ranges::sort(near.far_rows);
  auto const doubles = std::ranges::unique(near.far_rows);
  near.far_rows.erase(doubles.begin(), doubles.end());
  auto const in_ring = [](std::int32_t row) { return row % static_cast<std::int32_t>(NearPairs::ring); };
  for (std::size_t k = 0; k < near.slot_first.size(); ++k) {
    std::int32_t &first = near.slot_first[k], &second = near.slot_second[k];
    std::int32_t &higher = first > second ? first : second, &lower = first > second ? second : first;
    lower = in_ring(lower);
    auto const place = std::ranges::lower_bound(near.far_rows, higher) - near.far_rows.begin();
    higher = higher < last ? NearPairs::far_slot + static_cast<std::int32_t>(place) : NearPairs::nowhere;
  }
}

}  // namespace

NearPairs choose_near(NearPairs const& old, Neighbours& neighbours, Grains const& g, Period const& period, double gap,
                      bool has_turn) {
  NearPairs near;
  near.from = old.from;
  near.to = old.to;
  near.chunk = {0};
  auto const far_away = static_cast<std::int32_t>(g.size());
  reserve(near, static_cast<std::size_t>(neighbours.begin[near.to] - neighbours.begin[near.from]), has_turn);
  std::vector<FarPair> far;
  std::size_t chunk_begin = near.from;
  for (std::size_t row = near.from; row < near.to; ++row) {
    for (std::int32_t at = neighbours.begin[row]; at < neighbours.begin[row + 1]; ++at) {
      auto const k = static_cast<std::size_t>(at);
      std::int32_t const first = neighbours.first[k], second = neighbours.second[k], place = neighbours.spring[k];
      PairSpring spring{};
      bool touching = false;
      if (place >= 0 && old.touching[static_cast<std::size_t>(place)]) {
        spring = spring_at(old, static_cast<std::size_t>(place));
        touching = true;
      } else if (place <= -2) {
        spring = old.dormant[static_cast<std::size_t>(-2 - place)];
        touching = true;
      }
      if (is_near(g, static_cast<std::size_t>(first), static_cast<std::size_t>(second), period, gap)) {
        auto const higher = static_cast<std::size_t>(std::max(first, second));
        if (higher < std::min(near.to, chunk_begin + NearPairs::ring)) {
          neighbours.spring[k] = static_cast<std::int32_t>(near.first.size());
          append(near, first, second, spring, touching, has_turn);
        } else {
          far.push_back({k, first, second, spring, touching});
        }
      } else if (touching) {
        neighbours.spring[k] = dormant_spring(near.dormant.size());
        near.dormant.push_back(spring);
      } else {
        neighbours.spring[k] = no_spring;
      }
    }
    if ((row + 1 - near.from) % NearPairs::rows_a_chunk == 0 || row + 1 == near.to) {
      end_chunk(near, neighbours, far, far_away, has_turn);
      chunk_begin = row + 1;
    }
  }
  give_slots(near, g.owned);
  return near;
}

namespace {
/// Calls visit(pair, spring) for every touching pair of the rows of `near`.
template <class Visit>
void for_each_spring(NearPairs const& near, Neighbours const& neighbours, Visit const& visit) {
  auto const begin = static_cast<std::size_t>(neighbours.begin[near.from]),
             end = static_cast<std::size_t>(neighbours.begin[near.to]);
  for (std::size_t k = begin; k < end; ++k) {
    std::int32_t const place = neighbours.spring[k];
    if (place >= 0 && near.touching[static_cast<std::size_t>(place)])
      visit(k, spring_at(near, static_cast<std::size_t>(place)));
    else if (place <= -2)
      visit(k, near.dormant[static_cast<std::size_t>(-2 - place)]);
  }
}
}  // namespace

void make_dormant(Neighbours& neighbours, std::vector<NearPairs const*> const& shares) {
  std::vector<PairSpring> dormant;
  std::vector<std::int32_t> place(neighbours.size(), no_spring);
  for (NearPairs const* near : shares) {
    for_each_spring(*near, neighbours, [&](std::size_t k, PairSpring const& spring) {
      place[k] = dormant_spring(dormant.size());
      dormant.push_back(spring);
    });
  }
  neighbours.dormant = std::move(dormant);
  neighbours.spring = std::move(place);
}

std::int64_t count_touching(NearPairs const& near, Neighbours const& neighbours, std::size_t owned) {
  std::int64_t count = 0;
  for_each_spring(near, neighbours, [&](std::size_t k, PairSpring const&) {
    count += static_cast<std::size_t>(neighbours.first[k]) < owned;
  });
  return count;
}

void append_springs(NearPairs const& near, Neighbours const& neighbours, Grains const& g,
                    std::vector<LocalSpring>& springs) {
  for_each_spring(near, neighbours, [&](std::size_t k, PairSpring const& s) {
    std::int32_t const i = neighbours.first[k], j = neighbours.second[k];
    springs.push_back({{g.id[static_cast<std::size_t>(i)],
                        g.id[static_cast<std::size_t>(j)],
                        {s.x, s.y, s.z},
                        {s.turn_x, s.turn_y, s.turn_z}},
                       i,
                       j});
  });
}

namespace {

constexpr std::size_t rows_ahead = 1024, rows_a_block = 28, rows_in_cache = 100'000;

/// Asks for rows that will be partners soon: from a bed that does not fit in the cache they come late otherwise.
void fetch_rows(Grains const& g, std::size_t from) {
  if (g.size() < rows_in_cache || from + rows_a_block > g.size()) return;
  auto const* bytes = reinterpret_cast<char const*>(&g[from]);
  for (std::size_t at = 0; at < rows_a_block * sizeof(GrainState); at += 64) __builtin_prefetch(bytes + at, 1);
}

/// The pairs [begin, end), whose slots are given or else the rows modulo the ring.
double evaluate_part(NearPairs& near, std::size_t begin, std::size_t end, std::int32_t const* slot_first,
                     std::int32_t const* slot_second, Grains const& g, LawTable const& laws, Period const& period,
                     double dt, ActionUnit const& unit, GrainAction* actions) {
  bool const many = laws.materials > 1, has_turn = laws.form.rolling == RollingModel::epsd2;
  ActOn const act_on_block = many ? kernel<true>(laws.form) : kernel<false>(laws.form);
  PairBlock pairs;
  std::int32_t in_ring_first[block], in_ring_second[block];
  double worst = 0;
  for (std::size_t at = begin; at < end; at += block) {
    std::size_t const count = std::min(block, end - at);
    fetch_rows(g, static_cast<std::size_t>(std::min(near.first[at], near.second[at])) + rows_ahead);
    std::int32_t const *first = near.first.data() + at, *second = near.second.data() + at;
    for (std::size_t l = 0; l < count; l += lanes_at_once)
      load_pairs(g.state.data(), first + l, second + l, pairs.grains, l);
    for (std::size_t l = 0; many && l < count; ++l)
      pairs.law[l] = g.material[static_cast<std::size_t>(first[l])] * laws.materials +
                     g.material[static_cast<std::size_t>(second[l])];
    Springs const springs{&near.spring_x[at],
                          &near.spring_y[at],
                          &near.spring_z[at],
                          has_turn ? &near.turn_x[at] : nullptr,
                          has_turn ? &near.turn_y[at] : nullptr,
                          has_turn ? &near.turn_z[at] : nullptr};
    if (laws.form.reach != Reach::touch) std::copy_n(&near.touching[at], count, pairs.touching.values);
    worst = std::max(worst, act_on_block(pairs, count, springs, laws.laws.data(), period, dt, unit, laws.user));
    std::copy_n(pairs.touching.values, count, &near.touching[at]);
    constexpr auto mask = static_cast<std::int32_t>(NearPairs::ring) - 1;
    for (std::size_t l = 0; l < count; ++l) in_ring_first[l] = first[l] & mask, in_ring_second[l] = second[l] & mask;
    std::int32_t const *to_first = slot_first ? slot_first + (at - begin) : in_ring_first,
                       *to_second = slot_second ? slot_second + (at - begin) : in_ring_second;
    for (std::size_t l = 0; l < count; l += lanes_at_once)
      add_lanes(pairs.force, pairs.on_first, pairs.on_second, l, to_first + l, to_second + l, actions);
  }
  return worst;
}

}  // namespace

double evaluate_pairs(NearPairs& near, std::size_t chunk, Grains const& g, LawTable const& laws, Period const& period,
                      double dt, ActionUnit const& unit, GrainAction* actions) {
  std::size_t const begin = near.chunk[chunk], far = near.far_part[chunk], end = near.chunk[chunk + 1];
  std::size_t const slots = near.far_slots[chunk];
  double const soon = evaluate_part(near, begin, far, nullptr, nullptr, g, laws, period, dt, unit, actions);
  return std::max(soon, evaluate_part(near, far, end, near.slot_first.data() + slots, near.slot_second.data() + slots,
                                      g, laws, period, dt, unit, actions));
}

}  // namespace layerloop::dem
