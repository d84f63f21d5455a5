#pragma once
#include <cstdint>
#include <vector>

#include "core/vec3.hpp"
#include "dem/moving_walls.hpp"
#include "dem/pair_contacts.hpp"
#include "dem/wall_contacts.hpp"

namespace layerloop::dem {

/// Where the energy of the grains came from and went to [J], over a time:
///   wall_work = kinetic + potential + elastic + dissipated_* + carried_out + residual.
/// Everything but the residual is measured on its own; the residual is what the steps of time make of the elastic
/// forces.
struct EnergyLedger {
  double kinetic = 0, potential = 0;  ///< gained
  double elastic = 0;  ///< gained in contacts: normal (cohesion counts negative), tangential and rolling springs
  double dissipated_normal = 0;
  double dissipated_tangential = 0;  ///< slip, damping, and what springs lose as the contact under them shrinks
  double dissipated_rolling = 0;
  double dissipated_gas = 0;
  double dissipated_sleep = 0;  ///< of grains that were stopped because they lay still
  double wall_work = 0;         ///< of walls that move, on the grains
  double carried_out = 0;       ///< by grains that were taken out, with their contacts
  double residual = 0;
  double work_done = 0;  ///< |by walls| + |by gravity| + kinetic energy at the start: the measure of the residual

  double dissipated() const {
    return dissipated_normal + dissipated_tangential + dissipated_rolling + dissipated_gas + dissipated_sleep;
  }
  double relative_error() const;
  EnergyLedger& operator+=(EnergyLedger const& later);
};

/// Energy that the grains hold, and their contacts: whole numbers of a unit, whose sum does not depend on their order.
struct HeldEnergy {
  std::int64_t kinetic = 0, potential = 0, normal = 0, tangential = 0, rolling = 0;

  std::int64_t sum() const { return kinetic + potential + normal + tangential + rolling; }
  HeldEnergy& operator+=(HeldEnergy const& more);
  HeldEnergy& operator-=(HeldEnergy const& less);
};

/// Work done on the grains, in the same unit.
struct BookedWork {
  std::int64_t damping = 0, tangential = 0, rolling = 0, gas = 0, walls = 0;

  BookedWork& operator+=(BookedWork const& more);
};

/// Turns energies into whole numbers: to the nearest, so that billions of roundings do not add up to a drift.
struct EnergyUnit {
  double unit = 1, per_unit = 1;  ///< [J], its inverse

  EnergyUnit() = default;
  /// 64 of the units of torque: for 42 um grains of 0.2 GPa a unit is about 1e-22 J, 2e-5 of the kinetic energy of a
  /// 13 um grain at 1 mm/s, and 2^63 of them are 1 mJ.
  explicit EnergyUnit(ActionUnit const& action) : unit(64 * action.torque), per_unit(1 / unit) {}
  std::int64_t whole(double energy) const;
};

/// What one contact's springs can give back [J] (a kept spring of a sliding contact: what it pulls with); attraction is
/// a normal spring too: -c R d^2/2 (sjkr, sjkr2), -2 pi W R d (dmt).
struct SpringEnergy {
  double normal, tangential, rolling;
};
SpringEnergy spring_energy(ContactLaw const& law, double overlap, double reduced_radius, Vec3 const& spring,
                           Vec3 const& turn);

/// Law of two grains.
ContactLaw const& law_of(LawTable const& laws, Grains const& grains, std::size_t first, std::size_t second);

/// What one thread writes down about the work of its contacts, beside the steps and without touching them.
///
/// A kick changes the kinetic energy by exactly the force times the mean of the velocities before and after it. So the
/// forces of an evaluation are kept, and their work is booked in two halves: at once, and after the kick, at the next
/// evaluation or, where the contacts are listed anew, just before.
class EnergyBooks {
 public:
  explicit EnergyBooks(EnergyUnit const& unit = {}) : unit_(unit) {}

  /// Before the pairs of a chunk are evaluated: ends the work of the chunk's last forces and begins that of the new.
  void book_pairs(NearPairs const& near, std::size_t chunk, Grains const& grains, LawTable const& laws,
                  Period const& period, MovingWalls const& walls, double dt);
  /// After book_pairs(): the same for the listed contacts of the grains [from, to) with walls.
  void book_walls(std::size_t chunk, WallContacts const& contacts, WallBatch const& batch, Grains const& grains,
                  WallScene const& scene, ContactLaw const& law, double dt, std::size_t from, std::size_t to);
  /// Before the rows [from, to) are moved, and after it: the drag of gas at rest. \param drag  6 pi viscosity [Pa s]
  void before_move(Grains const& grains, std::size_t from, std::size_t to);
  void after_move(Grains const& grains, std::size_t from, std::size_t to, double drag, double dt);
  /// Ends the work of all forces that are kept.
  void finish(Grains const& grains, MovingWalls const& walls, double dt);
  /// Everything since the last call. \pre finish()
  BookedWork take();

 private:
  /// Forces of one contact, on its first body.
  struct KeptForces {
    std::int32_t first, second;  ///< rows; second is -1 at a wall
    std::int32_t wall;           ///< its number; -1 between grains
    Vec3 force;                  ///< all of it [N]
    Vec3 damping, tangential;    ///< parts of it
    Vec3 turning;                ///< normal x tangential; the torque is -arm turning on either body
    Vec3 rolling;                ///< torque taken from the first body [N m]
    double arm_first, arm_second;
    Vec3 surface;  ///< velocity of the wall's surface as it spins [m/s]
    double spin;   ///< of the wall, about y [rad/s]
  };

  void book_half(KeptForces const& kept, Grains const& grains, MovingWalls const& walls, double dt);
  void end_chunk(std::size_t chunk, Grains const& grains, MovingWalls const& walls, double dt);

  EnergyUnit unit_;
  std::vector<std::vector<KeptForces>> kept_;  ///< of each chunk
  std::vector<Vec3> velocity_before_;
  BookedWork booked_;
};

}  // namespace layerloop::dem
