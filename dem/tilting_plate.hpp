#pragma once
#include <cstdint>
#include <vector>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "dem/simulation.hpp"

namespace layerloop::dem {

/// The layer at one moment.
struct TiltSample {
  double time;          ///< since the plate began to tilt [s]
  double tilt;          ///< of the plate [rad]
  double speed;         ///< mean of all grains, down the plate [m/s]
  double displacement;  ///< mean of all grains since the plate began to tilt [m]
};

struct TiltingPlate {
  /// arctan of the friction that acts while the layer slips [rad]; not a number when it never does.
  double slipping_angle;
  double slipping_angle_u;      ///< half the 95 % interval over parts of the slip [rad]
  double tilt_at_one_diameter;  ///< tilt at which the mean displacement is one mean grain diameter [rad], or NaN
  double largest_tilt;          ///< reached [rad]
  double layer_in_grains;       ///< solid thickness of the layer over the mean-volume grain's diameter
  std::vector<TiltSample> record;
};

/// Slipping angle: a thin layer comes to rest on a plate that is periodic in x and y, then the plate is tilted at a
/// steady rate (gravity turns) until the layer slips at 20 mm/s.
///
/// Criterion: between the moments when the mean speed is 5 and 20 mm/s the momentum balance of the layer,
/// dv/dt = g (sin a - tan(f) cos a), is integrated for the one friction angle f that satisfies it: the tilt at which
/// the layer as a whole would begin to slide. Surface grains roll from about 10 degrees less: that creep stays below 5
/// mm/s. What an eye would call slipping is `tilt_at_one_diameter`; it depends on the rate. Collective.
/// \throws PhysicsError a guard; StoppedBySignal
TiltingPlate tilting_plate(Case const& checked, Motion const& motion, Communicator const& communicator,
                           bool show_progress);

/// The criterion alone. \param gravity  [m/s^2]
void find_slip(TiltingPlate& plate, double gravity, double mean_diameter);

}  // namespace layerloop::dem
