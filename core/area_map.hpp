#pragma once
#include <cstdint>
#include <vector>

namespace layerloop {

/// A quantity over a regular grid of square pixels seen from above; x runs fastest, machine frame.
struct AreaMap {
  double x0 = 0, y0 = 0;  ///< lower corner [m]
  double spacing = 0;     ///< edge of a pixel [m]
  std::int32_t nx = 0, ny = 0;
  std::vector<double> values;  ///< at pixel centres, shape (ny, nx)

  double& at(std::int32_t i, std::int32_t j) { return values[static_cast<std::size_t>(i + std::int64_t{nx} * j)]; }
  double at(std::int32_t i, std::int32_t j) const { return values[static_cast<std::size_t>(i + std::int64_t{nx} * j)]; }
};

/// Height of the topmost surface [m].
using HeightMap = AreaMap;

}  // namespace layerloop
