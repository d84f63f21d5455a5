#pragma once
#include <Random123/philox.h>

#include <array>
#include <cstdint>

namespace layerloop {

/// What a random number is for: keeps the streams of the stages apart.
enum class RandomStream : std::uint32_t {
  grain_size = 1,
  grain_position = 2,
  ray_shift = 3,
  plate_heights = 4,
  plate_grains = 5,
  grain_material = 6,
  ray_scatter = 7,
  denudation = 8,
  null_draws = 9,
  blind_design = 10,
  blind_truth = 11,
  bootstrap = 12,
  design = 13,
  acquisition = 14
};

/// Four independent uniform numbers in (0, 1), a pure function of its arguments (Philox 4x32-10, Salmon et al. 2011):
/// the same for any number of ranks and threads, and after a restart.
inline std::array<double, 4> uniform4(std::uint64_t seed, RandomStream stream, std::uint64_t id,
                                      std::uint32_t draw = 0) {
  using Generator = r123::Philox4x32;
  Generator::ctr_type const counter{
      {static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32), draw, static_cast<std::uint32_t>(stream)}};
  Generator::key_type const key{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  Generator::ctr_type const bits = Generator{}(counter, key);
  std::array<double, 4> u;
  for (std::size_t c = 0; c < 4; ++c) u[c] = (bits[c] + 0.5) * 0x1p-32;
  return u;
}

}  // namespace layerloop
