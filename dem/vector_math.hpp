#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace layerloop::dem {

/// Eight numbers at once, as the compiler's own vectors: the same source runs on any instruction set.
using Numbers [[gnu::vector_size(64)]] = double;
using Flags [[gnu::vector_size(64)]] = std::int64_t;
inline constexpr std::size_t lanes_at_once = 8;

inline double magnitude(double x) { return std::abs(x); }
inline double inverse(double x) { return 1 / x; }
inline double inverse_root(double x) { return 1 / std::sqrt(x); }
inline double root(double x) { return std::sqrt(x); }

inline Numbers magnitude(Numbers const& x) {
  return reinterpret_cast<Numbers>(reinterpret_cast<Flags>(x) & std::numeric_limits<std::int64_t>::max());
}

/// 1/x to about one unit in the last place, for x > 0: two steps of Newton's from the processor's estimate are four
/// times as fast as its division.
inline Numbers inverse(Numbers const& x) {
#if defined(__AVX512F__)
  Numbers y = _mm512_maskz_rcp14_pd(0xFF, x);
  for (int i = 0; i < 2; ++i) y += y * (1.0 - x * y);
  return y;
#else
  return 1.0 / x;
#endif
}

/// 1/x to four digits, for x > 0.
inline Numbers roughly_inverse(Numbers const& x) {
#if defined(__AVX512F__)
  return _mm512_maskz_rcp14_pd(0xFF, x);
#else
  return 1.0 / x;
#endif
}

/// 1/sqrt(x) to about one unit in the last place, for x > 1e-290.
inline Numbers inverse_root(Numbers const& x) {
#if defined(__AVX512F__)
  Numbers y = _mm512_maskz_rsqrt14_pd(0xFF, x);
  for (int i = 0; i < 2; ++i) y += y * (0.5 - 0.5 * x * y * y);
  return y;
#else
  Numbers y = x;
  for (int l = 0; l < 8; ++l) y[l] = 1 / std::sqrt(x[l]);
  return y;
#endif
}

/// sqrt(x) for x >= 0.
inline Numbers root(Numbers const& x) { return x * inverse_root(x + 1e-280); }

/// Numbers that are filled with one.
template <class V>
V filled(double value) {
  return V{} + value;
}

}  // namespace layerloop::dem
