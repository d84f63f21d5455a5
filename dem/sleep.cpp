#include "dem/sleep.hpp"

#include <algorithm>

namespace layerloop::dem {
namespace {

double speed(GrainState const& g) { return std::sqrt(g.vx * g.vx + g.vy * g.vy + g.vz * g.vz); }

bool is_still(GrainState const& g) {
  double const surface = g.radius * std::sqrt(g.wx * g.wx + g.wy * g.wy + g.wz * g.wz);
  return speed(g) < still_speed && surface < still_speed;
}

/// Could the waking grain reach the sleeping one before the next check?
bool disturbs(GrainState const& awake, GrainState const& asleep, Period const& period, double interval) {
  double const fast = speed(awake);
  if (fast < 2 * still_speed) return false;
  double const dx = wrapped(awake.x - asleep.x, period.x), dy = wrapped(awake.y - asleep.y, period.y),
               dz = awake.z - asleep.z, reach = awake.radius + asleep.radius + 2 * fast * interval;
  return dx * dx + dy * dy + dz * dz < reach * reach;
}

}  // namespace

bool update_sleep(Grains& g, Neighbours const& neighbours, std::vector<char> const& near_moving_wall,
                  Period const& period, double interval) {
  std::vector<char> woken(g.size(), 0);
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    auto const i = static_cast<std::size_t>(neighbours.first[k]), j = static_cast<std::size_t>(neighbours.second[k]);
    bool const i_sleeps = is_asleep(g.quiet[i]), j_sleeps = is_asleep(g.quiet[j]);
    if (i_sleeps == j_sleeps) continue;
    std::size_t const sleeper = i_sleeps ? i : j;
    if (disturbs(g[i_sleeps ? j : i], g[sleeper], period, interval)) woken[sleeper] = 1;
  }
  bool changed = false;
  for (std::size_t i = 0; i < g.owned; ++i) {
    bool const slept = is_asleep(g.quiet[i]);
    bool const stays_awake = woken[i] || near_moving_wall[i] || (!slept && !is_still(g[i]));
    g.quiet[i] = stays_awake ? 0 : std::min(g.quiet[i] + 1, checks_until_sleep);
    bool const sleeps = is_asleep(g.quiet[i]);
    changed |= sleeps != slept;
    if (sleeps) g[i].vx = g[i].vy = g[i].vz = g[i].wx = g[i].wy = g[i].wz = 0;
  }
  return changed;
}

}  // namespace layerloop::dem
