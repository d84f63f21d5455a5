#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "core/powder_bed.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem {

/// Free surface of a pile along one line from the axis of its base outwards.
struct PileProfile {
  double direction;                      ///< of the line, from x towards y [rad]
  std::array<double, 5> radius, height;  ///< of the five points [m]; height above the base
  double slope;                          ///< of the line through them, downwards [rad]
};

struct ReposePile {
  double angle_of_repose;    ///< mean slope of the profiles [rad]
  double angle_of_repose_u;  ///< half the 95 % interval of that mean: surface roughness, not bed to bed [rad]
  double angle_from_height;  ///< arctan(h / (d / 2)) with the height over the axis [rad], thesis eq. 13
  std::vector<PileProfile> profiles;
  std::int64_t grains_fed, grains_on_base;
  double settling_time;  ///< until rest, or until the time was over [s]
  bool at_rest;
  PowderBed bed;
};

/// Angle of repose by the cloud method: a loose cloud falls on a round base with a free edge, what rolls over the edge
/// is gone, and the pile that stays comes to rest. With `[calibrate] batches` above 1 the powder comes in that many
/// clouds, each above the pile that the earlier ones have left: pouring.
///
/// The slope is fitted to five equally spaced points of the surface from 0.1 to 0.85 of the base's radius, along four
/// lines through the axis, both halves of each; a point is the mean height of the uppermost grain surfaces over a disc
/// whose radius is 1.1 diameters of the grain of mean volume. Collective. \throws PhysicsError a guard; StoppedBySignal
ReposePile repose_pile(Case const& checked, Motion const& motion, Communicator const& communicator, bool show_progress);

/// The measurement alone: grains on a base of this diameter whose axis stands at (x, y).
ReposePile measure_pile(PowderBed bed, double base_diameter, double x, double y, double disc_radius);

}  // namespace layerloop::dem
