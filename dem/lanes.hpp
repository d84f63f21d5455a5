#pragma once
#include <cstddef>
#include <cstdint>

#include "dem/action_unit.hpp"
#include "dem/grains.hpp"
#include "dem/vector_math.hpp"

namespace layerloop::dem {

inline constexpr std::size_t block =
    64;  ///< contacts at a time: what load, law and store share stays in the first cache

/// One quantity of the contacts of a block.
template <class T>
struct alignas(64) Lanes {
  T values[block];
  T& operator[](std::size_t lane) { return values[lane]; }
  T const& operator[](std::size_t lane) const { return values[lane]; }
};

/// Spin and radius of the grains on one side of a block of pairs, a vector for each quantity.
struct SpinLanes {
  Lanes<double> wx, wy, wz, radius;
};

/// What the pairs of a block need of their grains. Differences, first minus second, are taken while the grains still
/// are quads: each costs one turn into vectors instead of two.
struct PairLanes {
  Lanes<double> dx, dy, dz, vx, vy, vz;
  Lanes<double> inverse_mass;  ///< sum
  SpinLanes first, second;
};

/// In whole units, see ActionUnit.
struct ForceLanes {
  Lanes<std::int64_t> x, y, z;
};
struct TorqueLanes {
  Lanes<std::int64_t> x, y, z;
};

namespace detail {

template <class T>
using Four [[gnu::vector_size(32)]] = T;
template <class T>
using Eight [[gnu::vector_size(64)]] = T;

/// The first halves of two vectors of quads of rows, [a b] and [c d]: what is at places 0, 1 of a, c, then of b, d.
template <class V>
V lower_pairs(V const& ab, V const& cd) {
  return __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13);
}
template <class V>
V upper_pairs(V const& ab, V const& cd) {
  return __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
}
template <class V>
V even(V const& a, V const& b) {
  return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
}
template <class V>
V odd(V const& a, V const& b) {
  return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
}

/// [x y z w] of rows 0 and 4, 1 and 5, 2 and 6, 3 and 7.
template <class T>
struct EightQuads {
  Eight<T> of[4];
};

/// Quads that lie `stride` numbers apart, at rows[0..8).
[[gnu::always_inline]] inline EightQuads<double> load_quads(double const* quads, std::size_t stride,
                                                            std::int32_t const* rows) {
  auto const quad = [&](int lane) {
    return *reinterpret_cast<Four<double> const*>(quads + stride * static_cast<std::size_t>(rows[lane]));
  };
  auto const two = [&](int a, int b) { return __builtin_shufflevector(quad(a), quad(b), 0, 1, 2, 3, 4, 5, 6, 7); };
  return {{two(0, 4), two(1, 5), two(2, 6), two(3, 7)}};
}

/// Vectors of x, y, z, w (w: none if null).
[[gnu::always_inline]] inline void turn_quads(EightQuads<double> const& r, double* x, double* y, double* z, double* w) {
  Eight<double> const xz01 = even(r.of[0], r.of[1]), yw01 = odd(r.of[0], r.of[1]), xz23 = even(r.of[2], r.of[3]),
                      yw23 = odd(r.of[2], r.of[3]);
  *reinterpret_cast<Eight<double>*>(x) = lower_pairs(xz01, xz23);
  *reinterpret_cast<Eight<double>*>(y) = lower_pairs(yw01, yw23);
  *reinterpret_cast<Eight<double>*>(z) = upper_pairs(xz01, xz23);
  if (w) *reinterpret_cast<Eight<double>*>(w) = upper_pairs(yw01, yw23);
}

[[gnu::always_inline]] inline EightQuads<std::int64_t> back_to_quads(Lanes<std::int64_t> const& x,
                                                                     Lanes<std::int64_t> const& y,
                                                                     Lanes<std::int64_t> const& z, std::size_t at) {
  auto const lanes = [at](Lanes<std::int64_t> const& of) {
    return *reinterpret_cast<Eight<std::int64_t> const*>(&of.values[at]);
  };
  Eight<std::int64_t> const vx = lanes(x), vy = lanes(y), vz = lanes(z), none{};
  Eight<std::int64_t> const xy_even = even(vx, vy), xy_odd = odd(vx, vy), z_even = even(vz, none),
                            z_odd = odd(vz, none);
  return {{lower_pairs(xy_even, z_even), lower_pairs(xy_odd, z_odd), upper_pairs(xy_even, z_even),
           upper_pairs(xy_odd, z_odd)}};
}

/// Adds forces and torques to the actions of slots[0..8).
[[gnu::always_inline]] inline void add_quads(EightQuads<std::int64_t> const& force,
                                             EightQuads<std::int64_t> const& torque, std::int32_t const* slots,
                                             GrainAction* actions) {
  auto const add = [&](int row, Eight<std::int64_t> const& both) {
    auto& to = *reinterpret_cast<Eight<std::uint64_t>*>(&actions[slots[row]]);
    to += reinterpret_cast<Eight<std::uint64_t> const&>(both);
  };
  for (int q = 0; q < 4; ++q) {
    add(q, __builtin_shufflevector(force.of[q], torque.of[q], 0, 1, 2, 3, 8, 9, 10, 11));
    add(q + 4, __builtin_shufflevector(force.of[q], torque.of[q], 4, 5, 6, 7, 12, 13, 14, 15));
  }
}

}  // namespace detail

/// The pairs of grains first[0..lanes_at_once) and second[...] into lanes [at, at + lanes_at_once).
inline void load_pairs(GrainState const* grains, std::int32_t const* first, std::int32_t const* second, PairLanes& into,
                       std::size_t at) {
  auto const* quads = reinterpret_cast<double const*>(grains);
  constexpr std::size_t stride = sizeof(GrainState) / sizeof(double);
  auto apart = detail::load_quads(quads, stride, first), moving = detail::load_quads(quads + 4, stride, first);
  auto const from = detail::load_quads(quads, stride, second), against = detail::load_quads(quads + 4, stride, second);
  detail::Eight<double> const fourth_adds{-1, -1, -1, 1, -1, -1, -1, 1};
  for (int q = 0; q < 4; ++q) apart.of[q] -= from.of[q], moving.of[q] += fourth_adds * against.of[q];
  detail::turn_quads(apart, &into.dx[at], &into.dy[at], &into.dz[at], nullptr);
  detail::turn_quads(moving, &into.vx[at], &into.vy[at], &into.vz[at], &into.inverse_mass[at]);
  auto const spins = [&](std::int32_t const* rows, SpinLanes& of) {
    detail::turn_quads(detail::load_quads(quads + 8, stride, rows), &of.wx[at], &of.wy[at], &of.wz[at], &of.radius[at]);
  };
  spins(first, into.first);
  spins(second, into.second);
}

/// Adds lanes [at, at + lanes_at_once) to the actions of the slots of both sides; the force on the second is the
/// opposite of that on the first.
inline void add_lanes(ForceLanes const& forces, TorqueLanes const& on_first, TorqueLanes const& on_second,
                      std::size_t at, std::int32_t const* first, std::int32_t const* second, GrainAction* actions) {
  auto force = detail::back_to_quads(forces.x, forces.y, forces.z, at);
  detail::add_quads(force, detail::back_to_quads(on_first.x, on_first.y, on_first.z, at), first, actions);
  for (auto& quads : force.of) quads = -quads;
  detail::add_quads(force, detail::back_to_quads(on_second.x, on_second.y, on_second.z, at), second, actions);
}

}  // namespace layerloop::dem
