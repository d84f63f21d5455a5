#include "dem/moving_walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace layerloop::dem {
namespace {
constexpr double pi = std::numbers::pi;

/// Without its suspension.
WallPose pose_at(WallMotion const& m, double time) {
  double const turns = 2 * pi * m.frequency, phase = turns * time;
  double const steady = std::abs(m.velocity) + turns * m.amplitude;
  return {m.velocity * time, m.amplitude * std::sin(phase), m.velocity, m.amplitude * turns * std::cos(phase),
          steady * time};
}
}  // namespace

MovingWalls::MovingWalls(Walls const& walls, Communicator const& communicator) : communicator_(communicator) {
  for (std::size_t wall = 0; wall < walls.size(); ++wall) {
    WallMotion const& m = walls.motion(wall);
    motion_.push_back(m);
    moves_.push_back(m.velocity != 0 || m.amplitude != 0 || m.suspension);
    yields_ = yields_ || m.suspension;
  }
  start();
}

void MovingWalls::start() {
  yield_.assign(motion_.size(), {});
  poses_.clear();
  for (WallMotion const& m : motion_) poses_.push_back(pose_at(m, 0));
  before_ = poses_;
  history_.clear();
  force_sum_.assign(motion_.size(), {});
  summed_steps_ = 0;
  mark();
}

void MovingWalls::advance(double time, double dt, std::vector<WallForces*> const& parts) {
  step_force_.assign(motion_.size(), {});
  for (WallForces* part : parts) {
    for (std::size_t wall = 0; wall < part->size(); ++wall)
      for (std::size_t d = 0; d < 2; ++d) step_force_[wall][d] += std::exchange((*part)[wall][d], 0);
  }
  for (std::size_t wall = 0; wall < motion_.size(); ++wall)
    for (std::size_t d = 0; d < 2; ++d) force_sum_[wall][d] += step_force_[wall][d];
  ++summed_steps_;
  before_ = poses_;
  if (yields_ && communicator_.size() > 1)
    MPI_Allreduce(MPI_IN_PLACE, step_force_.data(), static_cast<int>(2 * step_force_.size()), MPI_INT64_T, MPI_SUM,
                  communicator_.handle());
  for (std::size_t wall = 0; wall < motion_.size(); ++wall) {
    if (!moves_[wall]) continue;
    WallPose& pose = poses_[wall];
    pose = pose_at(motion_[wall], time);
    if (auto const& s = motion_[wall].suspension) {
      Yield& y = yield_[wall];
      double const push = static_cast<double>(step_force_[wall][1]) * wall_force_unit;
      // damping at the mean of the speeds before and after: exact to second order, stable for any damping
      double const drag = 0.5 * dt * s->damping / s->mass;
      y.speed = (y.speed * (1 - drag) + dt * (push - s->stiffness * y.z) / s->mass) / (1 + drag);
      y.z += y.speed * dt;
      y.path += std::abs(y.speed) * dt;
      pose.dz += y.z;
      pose.vz += y.speed;
      pose.path += y.path;
    }
  }
}

Vec3 MovingWalls::last_step(std::size_t wall) const {
  return {poses_[wall].dx - before_[wall].dx, 0, poses_[wall].dz - before_[wall].dz};
}

MovingWalls MovingWalls::half_a_step_back() const {
  MovingWalls back = *this;
  for (std::size_t wall = 0; wall < poses_.size(); ++wall) {
    back.poses_[wall].dx -= 0.5 * last_step(wall).x();
    back.poses_[wall].dz -= 0.5 * last_step(wall).z();
  }
  return back;
}

double MovingWalls::fastest() const {
  double speed = 0;
  for (std::size_t wall = 0; wall < motion_.size(); ++wall) {
    WallMotion const& m = motion_[wall];
    double const up = 2 * pi * m.frequency * m.amplitude + std::abs(yield_[wall].speed);
    speed = std::max(speed, std::hypot(m.velocity, up));
  }
  return speed;
}

double MovingWalls::travelled() const {
  double path = 0;
  for (std::size_t wall = 0; wall < poses_.size(); ++wall)
    path = std::max(path, poses_[wall].path - marked_[wall].path);
  return path;
}

void MovingWalls::record(double time) {
  if (summed_steps_ == 0) return;
  double const unit = wall_force_unit / static_cast<double>(summed_steps_);
  for (std::size_t wall = 0; wall < motion_.size(); ++wall) {
    if (!moves_[wall]) continue;
    auto const total = [&](std::size_t d) { return static_cast<double>(communicator_.sum(force_sum_[wall][d])); };
    history_.push_back({wall, time, unit * total(0), unit * total(1)});
  }
  force_sum_.assign(motion_.size(), {});
  summed_steps_ = 0;
}

}  // namespace layerloop::dem
