#pragma once
#include <cstdint>
#include <vector>

namespace layerloop {

/// Height of the topmost surface over a regular grid in x and y; x runs fastest. Heights [m], machine frame.
struct HeightMap {
  double x0 = 0, y0 = 0;   ///< lower corner [m]
  double spacing = 0;      ///< of the square pixels [m]
  std::int32_t nx = 0, ny = 0;
  std::vector<double> z;   ///< at pixel centres, shape (ny, nx)

  double& at(std::int32_t i, std::int32_t j) { return z[static_cast<std::size_t>(i + std::int64_t{nx} * j)]; }
  double at(std::int32_t i, std::int32_t j) const { return z[static_cast<std::size_t>(i + std::int64_t{nx} * j)]; }
};

}  // namespace layerloop
