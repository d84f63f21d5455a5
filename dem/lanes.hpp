#pragma once
#include <cstddef>
#include <cstdint>

#include "dem/action_unit.hpp"
#include "dem/grains.hpp"

namespace layerloop::dem {

inline constexpr std::size_t lanes_at_once = 8;
inline constexpr std::size_t block =
    64;  ///< contacts at a time: what load, law and store share stays in the first cache

/// One quantity of the contacts of a block.
template <class T>
struct alignas(64) Lanes {
  T values[block];
  T& operator[](std::size_t lane) { return values[lane]; }
  T const& operator[](std::size_t lane) const { return values[lane]; }
};

/// The grains on one side of a block of contacts, a vector for each quantity.
struct GrainLanes {
  Lanes<double> x, y, z, radius, vx, vy, vz, inverse_mass, wx, wy, wz;
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

/// Vectors of eight rows' x, y, z, w (w: none if null) from quads that lie `stride` doubles apart, at rows[0..8).
[[gnu::always_inline]] inline void turn_quads(double const* quads, std::size_t stride, std::int32_t const* rows,
                                              double* x, double* y, double* z, double* w) {
  auto const quad = [&](int lane) {
    return *reinterpret_cast<Four<double> const*>(quads + stride * static_cast<std::size_t>(rows[lane]));
  };
  auto const two = [&](int a, int b) { return __builtin_shufflevector(quad(a), quad(b), 0, 1, 2, 3, 4, 5, 6, 7); };
  Eight<double> const r0 = two(0, 4), r1 = two(1, 5), r2 = two(2, 6), r3 = two(3, 7);
  Eight<double> const xz01 = even(r0, r1), yw01 = odd(r0, r1), xz23 = even(r2, r3), yw23 = odd(r2, r3);
  *reinterpret_cast<Eight<double>*>(x) = lower_pairs(xz01, xz23);
  *reinterpret_cast<Eight<double>*>(y) = lower_pairs(yw01, yw23);
  *reinterpret_cast<Eight<double>*>(z) = upper_pairs(xz01, xz23);
  if (w) *reinterpret_cast<Eight<double>*>(w) = upper_pairs(yw01, yw23);
}

struct EightQuads {
  Eight<std::int64_t> of[4];  ///< [x y z 0] of rows 0 and 4, 1 and 5, 2 and 6, 3 and 7
};

inline EightQuads back_to_quads(std::int64_t const* x, std::int64_t const* y, std::int64_t const* z) {
  auto const at = [](std::int64_t const* values) { return *reinterpret_cast<Eight<std::int64_t> const*>(values); };
  Eight<std::int64_t> const vx = at(x), vy = at(y), vz = at(z), none{};
  Eight<std::int64_t> const xy_even = even(vx, vy), xy_odd = odd(vx, vy), z_even = even(vz, none),
                            z_odd = odd(vz, none);
  return {{lower_pairs(xy_even, z_even), lower_pairs(xy_odd, z_odd), upper_pairs(xy_even, z_even),
           upper_pairs(xy_odd, z_odd)}};
}

}  // namespace detail

/// Grains rows[0..lanes_at_once) into lanes [at, at + lanes_at_once).
inline void load_lanes(GrainState const* grains, std::int32_t const* rows, GrainLanes& into, std::size_t at) {
  auto const* quads = reinterpret_cast<double const*>(grains);
  constexpr std::size_t stride = sizeof(GrainState) / sizeof(double);
  detail::turn_quads(quads, stride, rows, &into.x[at], &into.y[at], &into.z[at], &into.radius[at]);
  detail::turn_quads(quads + 4, stride, rows, &into.vx[at], &into.vy[at], &into.vz[at], &into.inverse_mass[at]);
  detail::turn_quads(quads + 8, stride, rows, &into.wx[at], &into.wy[at], &into.wz[at], nullptr);
}

enum class Side { first, second };

/// Adds lanes [at, at + lanes_at_once) to the actions of slots[0..lanes_at_once); the force on the second side is the
/// opposite of that on the first.
template <Side side>
void add_lanes(ForceLanes const& forces, TorqueLanes const& torques, std::size_t at, std::int32_t const* slots,
               GrainAction* actions) {
  detail::EightQuads force = detail::back_to_quads(&forces.x[at], &forces.y[at], &forces.z[at]);
  detail::EightQuads const torque = detail::back_to_quads(&torques.x[at], &torques.y[at], &torques.z[at]);
  auto const add = [&](int row, detail::Eight<std::int64_t> const& both) {
    auto& to = *reinterpret_cast<detail::Eight<std::uint64_t>*>(&actions[slots[row]]);
    to += reinterpret_cast<detail::Eight<std::uint64_t> const&>(both);
  };
  for (int q = 0; q < 4; ++q) {
    if constexpr (side == Side::second) force.of[q] = -force.of[q];
    add(q, __builtin_shufflevector(force.of[q], torque.of[q], 0, 1, 2, 3, 8, 9, 10, 11));
    add(q + 4, __builtin_shufflevector(force.of[q], torque.of[q], 4, 5, 6, 7, 12, 13, 14, 15));
  }
}

}  // namespace layerloop::dem
