#pragma once
#include <chrono>
#include <map>
#include <string>

namespace layerloop::dem {

/// Where the time of the steps goes, on the first thread of a rank [s]. Waiting for other threads and ranks counts as
/// communication.
struct PhaseTimes {
  double pairs = 0, walls = 0, motion = 0, neighbours = 0, communication = 0;

  double work() const { return pairs + walls + motion + neighbours; }
  PhaseTimes& operator+=(PhaseTimes const& more) {
    pairs += more.pairs;
    walls += more.walls;
    motion += more.motion;
    neighbours += more.neighbours;
    communication += more.communication;
    return *this;
  }
  std::map<std::string, double> by_name() const {
    return {{"pairs", pairs},
            {"walls", walls},
            {"motion", motion},
            {"neighbours", neighbours},
            {"communication", communication}};
  }
};

/// Gives the time since the last call to a phase.
class PhaseClock {
 public:
  void add_to(double& phase) {
    auto const now = std::chrono::steady_clock::now();
    phase += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace layerloop::dem
