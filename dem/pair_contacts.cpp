#include "dem/pair_contacts.hpp"

#include <algorithm>

#include "dem/lanes.hpp"

namespace layerloop::dem {
namespace {

void clear(NearPairs& near) {
  near.first.clear();
  near.second.clear();
  near.touching.clear();
  near.dormant.clear();
  for (auto* values : {&near.spring_x, &near.spring_y, &near.spring_z, &near.turn_x, &near.turn_y, &near.turn_z})
    values->clear();
  near.chunk.assign(1, 0);
  near.far_part.clear();
  near.far_slots.clear();
  for (auto* rows : {&near.slot_first, &near.slot_second, &near.far_rows}) rows->clear();
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
  GrainLanes first, second;
  ActionLanes on_first, on_second;
  Lanes<std::int64_t> law, touching;  // as wide as the numbers: narrower ones make the vectors of the loop too long
};

struct Springs {
  double *x, *y, *z, *turn_x, *turn_y, *turn_z;
};

double square(double x) { return x * x; }
std::int64_t whole(double value, double per_unit) { return static_cast<std::int64_t>(value * per_unit); }

/// Lanes [0, count) of a block: what every pair does to its grains.
/// \return largest overlap over the smaller grain's diameter
template <Reach reach, RollingModel rolling, bool many_laws>
double act_on(PairBlock& pairs, std::size_t count, Springs const& s, ContactLaw const* laws, Period const& period,
              double dt, ActionUnit const& unit) {
  GrainLanes const &a = pairs.first, &b = pairs.second;
  ActionLanes &p = pairs.on_first, &q = pairs.on_second;
  ContactLaw const only = laws[0];
  double const half_x = 0.5 * period.x, half_y = 0.5 * period.y, period_x = period.x, period_y = period.y;
  double const per_force = unit.per_force, per_torque = unit.per_torque;
  double* __restrict ux = s.x, * __restrict uy = s.y, * __restrict uz = s.z;
  double* __restrict ox = s.turn_x, * __restrict oy = s.turn_y, * __restrict oz = s.turn_z;
  std::int64_t* __restrict touching = pairs.touching.values;
  constexpr bool has_turn = rolling == RollingModel::epsd2;
  double worst = 0;
#pragma omp simd simdlen(8) reduction(max : worst)
  for (std::size_t l = 0; l < count; ++l) {
    double dx = a.x[l] - b.x[l], dy = a.y[l] - b.y[l];
    double const dz = a.z[l] - b.z[l];
    dx = dx > half_x ? dx - period_x : (dx < -half_x ? dx + period_x : dx);
    dy = dy > half_y ? dy - period_y : (dy < -half_y ? dy + period_y : dy);
    double const distance = std::sqrt(dx * dx + dy * dy + dz * dz), inverse = 1 / distance;
    double const ra = a.radius[l], rb = b.radius[l], sum = ra + rb;
    double const overlap = sum - distance, felt = overlap > 0.0 ? overlap : 0.0;
    double const arm_a = ra - 0.5 * felt, arm_b = rb - 0.5 * felt;
    ContactLaw const law = many_laws ? laws[pairs.law[l]] : only;
    ContactState const state{overlap,
                             ra * rb / sum,
                             a.inverse_mass[l] + b.inverse_mass[l],
                             dx * inverse,
                             dy * inverse,
                             dz * inverse,
                             a.vx[l] - b.vx[l],
                             a.vy[l] - b.vy[l],
                             a.vz[l] - b.vz[l],
                             arm_a * a.wx[l] + arm_b * b.wx[l],
                             arm_a * a.wy[l] + arm_b * b.wy[l],
                             arm_a * a.wz[l] + arm_b * b.wz[l],
                             a.wx[l] - b.wx[l],
                             a.wy[l] - b.wy[l],
                             a.wz[l] - b.wz[l],
                             ux[l],
                             uy[l],
                             uz[l],
                             has_turn ? ox[l] : 0.0,
                             has_turn ? oy[l] : 0.0,
                             has_turn ? oz[l] : 0.0,
                             reach == Reach::beyond ? square(ra * rb * inverse) : 0.0,
                             reach != Reach::touch && touching[l] != 0};
    ContactAction const c = act<reach, rolling>(law, state, dt);
    ux[l] = c.spring_x;
    uy[l] = c.spring_y;
    uz[l] = c.spring_z;
    if constexpr (has_turn) ox[l] = c.turn_x, oy[l] = c.turn_y, oz[l] = c.turn_z;
    touching[l] = c.touches ? 1 : 0;
    p.fx[l] = whole(c.fx, per_force);
    p.fy[l] = whole(c.fy, per_force);
    p.fz[l] = whole(c.fz, per_force);
    q.fx[l] = -p.fx[l];
    q.fy[l] = -p.fy[l];
    q.fz[l] = -p.fz[l];
    p.tx[l] = whole(-arm_a * c.qx - c.rx, per_torque);
    p.ty[l] = whole(-arm_a * c.qy - c.ry, per_torque);
    p.tz[l] = whole(-arm_a * c.qz - c.rz, per_torque);
    q.tx[l] = whole(c.rx - arm_b * c.qx, per_torque);
    q.ty[l] = whole(c.ry - arm_b * c.qy, per_torque);
    q.tz[l] = whole(c.rz - arm_b * c.qz, per_torque);
    double const relative = felt / (ra < rb ? ra : rb);
    worst = relative > worst ? relative : worst;
  }
  return 0.5 * worst;
}

using ActOn = double (*)(PairBlock&, std::size_t, Springs const&, ContactLaw const*, Period const&, double,
                         ActionUnit const&);

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

}  // namespace

namespace {

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

void choose_near(NearPairs& near, Neighbours& neighbours, Grains const& g, Period const& period, double gap,
                 bool has_turn, NearPairs& old, std::vector<PairSpring> const& dormant) {
  clear(near);
  auto const far_away = static_cast<std::int32_t>(g.size());
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
        spring = dormant[static_cast<std::size_t>(-2 - place)];
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
    std::int32_t const *first = near.first.data() + at, *second = near.second.data() + at;
    for (std::size_t l = 0; l < count; l += lanes_at_once) {
      load_lanes(g.state.data(), first + l, pairs.first, l);
      load_lanes(g.state.data(), second + l, pairs.second, l);
    }
    for (std::size_t l = 0; many && l < count; ++l)
      pairs.law[l] = g.material[static_cast<std::size_t>(first[l])] * laws.materials +
                     g.material[static_cast<std::size_t>(second[l])];
    Springs const springs{&near.spring_x[at],
                          &near.spring_y[at],
                          &near.spring_z[at],
                          has_turn ? &near.turn_x[at] : nullptr,
                          has_turn ? &near.turn_y[at] : nullptr,
                          has_turn ? &near.turn_z[at] : nullptr};
    std::copy_n(&near.touching[at], count, pairs.touching.values);
    worst = std::max(worst, act_on_block(pairs, count, springs, laws.laws.data(), period, dt, unit));
    std::copy_n(pairs.touching.values, count, &near.touching[at]);
    constexpr auto mask = static_cast<std::int32_t>(NearPairs::ring) - 1;
    for (std::size_t l = 0; l < count; ++l) in_ring_first[l] = first[l] & mask, in_ring_second[l] = second[l] & mask;
    for (std::size_t l = 0; l < count; l += lanes_at_once) {
      add_lanes(pairs.on_first, l, slot_first ? slot_first + (at - begin) + l : in_ring_first + l, actions);
      add_lanes(pairs.on_second, l, slot_second ? slot_second + (at - begin) + l : in_ring_second + l, actions);
    }
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
