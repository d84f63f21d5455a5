#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/communicator.hpp"
#include "dem/walls.hpp"

namespace layerloop::dem {

/// Forces of grains on walls, by number of the wall: x and z in units of 1e-18 N, so that sums do not depend on their
/// order. They hold 9 N.
using WallForces = std::vector<std::array<std::int64_t, 2>>;
inline constexpr double wall_force_unit = 1e-18;  ///< [N]

/// Force of the grains on a wall that moves: the mean over the steps since the sample before.
struct ForceSample {
  std::size_t wall = 0;
  double time = 0;      ///< end of the interval [s]
  double x = 0, z = 0;  ///< [N]
};

/// Where the walls are, step by step, and what the grains do to those that move. Every rank and thread sees the same
/// bits.
class MovingWalls {
 public:
  MovingWalls(Walls const& walls, Communicator const& communicator);

  void start();  ///< clock at 0, suspensions at rest, no force yet
  bool moves(std::size_t wall) const { return moves_[wall] != 0; }

  /// Goes on to the step that ends at `time`. Collective when a wall yields.
  /// \param parts  forces of the step before, part by part (of the threads); taken over and set to zero
  void advance(double time, double dt, std::vector<WallForces*> const& parts);
  std::vector<WallPose> const& poses() const { return poses_; }
  Vec3 last_step(std::size_t wall) const;  ///< way of a wall in the step that ended last [m]
  MovingWalls half_a_step_back() const;    ///< the same walls in the middle of that step

  /// Speed of the fastest wall, shaking and yielding included [m/s].
  double fastest() const;
  void mark() { marked_ = poses_; }  ///< from here travelled() counts
  double travelled() const;          ///< of the wall that went farthest, an upper bound [m]

  /// Adds the forces since the last record to the history. Collective.
  void record(double time);
  std::vector<ForceSample> const& history() const { return history_; }

 private:
  struct Yield {
    double z = 0, speed = 0, path = 0;
  };

  Communicator communicator_;
  std::vector<WallMotion> motion_;
  std::vector<char> moves_;
  std::vector<Yield> yield_;
  std::vector<WallPose> poses_, before_, marked_;  ///< now, a step ago, at mark()
  WallForces step_force_, force_sum_;              ///< of this rank: last step, steps since the last record
  std::int64_t summed_steps_ = 0;
  std::vector<ForceSample> history_;
  bool yields_ = false;
};

}  // namespace layerloop::dem
