#pragma once
#include <functional>
#include <vector>

namespace layerloop {

/// State of the metal when a stretch of the heat source begins: what the light then falls on, and through.
struct MeltState {
  /// 1: cell that has been above the liquidus so far, shape grid.size(). Gathered when asked for. \note Collective
  std::function<std::vector<char>()> melted;
  /// Height of the keyhole's wall over each column of cells [m], x fastest; infinite beside it; empty: none.
  std::vector<double> keyhole;
  double keyhole_radius = 0, keyhole_depth = 0;  ///< of its mouth, and from there to the bottom [m]
  double vapour_rate = 0;                        ///< mass that evaporates, mean over the stretch before [kg/s]
};

}  // namespace layerloop
