#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace layerloop::raytrace {

/// Eight numbers at once, as the compiler's own vectors: the same source runs on any instruction set.
using Numbers [[gnu::vector_size(64)]] = double;
using Flags [[gnu::vector_size(64)]] = std::int64_t;
inline constexpr std::size_t lanes_at_once = 8;

inline Numbers root(Numbers const& value) {
#if defined(__AVX512F__)
  return _mm512_maskz_sqrt_pd(0xFF, value);
#else
  Numbers result;
  for (int l = 0; l < 8; ++l) result[l] = std::sqrt(value[l]);
  return result;
#endif
}

/// Bit l for lane l.
inline unsigned bits(Flags const& flags) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(flags), reinterpret_cast<__m512i>(flags));
#else
  unsigned found = 0;
  for (int l = 0; l < 8; ++l) found |= static_cast<unsigned>(flags[l] != 0) << l;
  return found;
#endif
}

inline double least(Numbers const& values) {
  auto const smaller = [](Numbers const& a, Numbers const& b) { return a < b ? a : b; };
  Numbers result = smaller(values, __builtin_shuffle(values, Flags{4, 5, 6, 7, 0, 1, 2, 3}));
  result = smaller(result, __builtin_shuffle(result, Flags{2, 3, 0, 1, 6, 7, 4, 5}));
  return std::min(result[0], result[1]);
}

}  // namespace layerloop::raytrace
