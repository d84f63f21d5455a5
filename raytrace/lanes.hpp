#pragma once
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

inline bool any(Flags const& flags) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(flags), reinterpret_cast<__m512i>(flags)) != 0;
#else
  std::int64_t found = 0;
  for (int l = 0; l < 8; ++l) found |= flags[l];
  return found != 0;
#endif
}

}  // namespace layerloop::raytrace
