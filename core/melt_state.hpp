#pragma once
#include <functional>
#include <vector>

namespace layerloop {

/// State of the metal when a stretch of the heat source begins: what the light then falls on, and through.
struct MeltState {
  /// 1: cell that has been above the liquidus so far, shape grid.size(). Gathered when asked for. \note Collective
  std::function<std::vector<char>()> melted;
  std::vector<double> depression;  ///< of the surface below its rest, for each column of cells; empty: level [m]
  double vapour_rate = 0;          ///< mass that evaporates, mean over the stretch before [kg/s]
};

}  // namespace layerloop
