#pragma once
#include <vector>

#include "dem/grains.hpp"
#include "dem/neighbours.hpp"

namespace layerloop::dem {

/// Grains that lie still are left alone: their pairs with one another are not computed, their springs keep, and they do
/// not move, until something moves near them. Deep layers of a bed then cost next to nothing.
///
/// Still: centre and surface slower than `still_speed` at checks_until_sleep checks in a row. Awake again: when a grain
/// that is awake and faster than twice that touches it, or could before the next check, or when a moving wall is near.
/// So a push travels through sleeping grains at a diameter a check, about 5 m/s, and nothing fast ever meets a grain
/// that is still asleep. What a load of less than that speed would do to them, slow creep, is lost.
inline constexpr double still_speed = 5e-4;  // [m/s]
inline constexpr std::int64_t steps_between_checks = 100;

/// Grains that fall asleep (they are stopped) and wake up, as of now. \param interval  until the next check [s]
/// \param near_moving_wall  of each owned row \pre ghosts' sleep is up to date \return whether any did either
bool update_sleep(Grains& grains, Neighbours const& neighbours, std::vector<char> const& near_moving_wall,
                  Period const& period, double interval);

}  // namespace layerloop::dem
