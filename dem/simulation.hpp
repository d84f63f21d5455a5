#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/powder_bed.hpp"
#include "dem/contact_law.hpp"
#include "dem/decomposition.hpp"
#include "dem/energy_ledger.hpp"
#include "dem/grains.hpp"
#include "dem/motion.hpp"
#include "dem/moving_walls.hpp"
#include "dem/neighbours.hpp"
#include "dem/pair_contacts.hpp"
#include "dem/phase_times.hpp"
#include "dem/thread_team.hpp"
#include "dem/wall_contacts.hpp"
#include "dem/walls.hpp"

namespace layerloop::dem {

class StepBarrier;

/// What the grains move in.
struct Rig {
  Walls walls;
  double width = 1;  ///< period along y [m]; at least two diameters of the largest grain
  double length = std::numeric_limits<double>::infinity();  ///< period along x [m]; infinite: open
  std::array<double, 2> x_range{-1, 1}, z_range{-1, 1};     ///< a centre beyond them is a lost grain [m]
  /// Grains whose centre passes these are taken out: overflow [m]
  double sink_x = std::numeric_limits<double>::infinity(), sink_z = std::numeric_limits<double>::infinity();
  Vec3 gravity{0, 0, -standard_gravity};  ///< [m/s^2]
};

inline constexpr double fastest_grain = 1000;  ///< [m/s]: nothing in a recoater moves like that

/// Discrete elements: scatter a bed, advance, gather it back.
///
/// Velocity Verlet (kick, drift, kick) with the second kick of a step and the first of the next made in one, so the
/// velocities in a bed are those half a step before its positions; forces see that velocity. A gathered bed holds the
/// whole state: going on from it gives the same bits as not stopping.
///
/// The same bits for any number of ranks and threads: every rank computes all contacts of its own grains, each with the
/// lower id first, and adds up forces as whole numbers, whose sum does not depend on the order (ActionUnit).
///
/// Cost: grains lie in memory in the order in which they lie in the bed, as records that turn into vectors with few
/// shuffles. Of the pairs within the skin only those that can touch in the next few steps are computed (NearPairs), and
/// a chunk of rows moves on as soon as its last pair is done, while it is still in the cache.
///
/// A rigid moving blade nips grains against the edges of the platforms, alone or in a chain (friction holds them in the
/// wedge). In a machine the blade yields or a grain is cut; here, while a wall moves, a grain that is overlapped by
/// more than 2 % of its diameter is taken out (the smaller of a pair). What it would store in so soft a contact shoots
/// it away at a metre a second. An unstable motion reaches the guard below before a look.
///
/// Guards (PhysicsError, on all ranks): a grain outside the rig, a value that is not finite, an overlap beyond 5 % of
/// the diameter, a step longer than a tenth of the smallest radius, a contact that lasts fewer than 8 steps at the
/// speeds present.
class Simulation {
 public:
  Simulation(Motion motion, Rig rig, Communicator const& communicator);

  /// Takes over grains and springs; the clock starts at 0. Collective. \throws InputError width too small for the
  /// grains
  void scatter(PowderBed const& bed);
  /// Collective. \throws PhysicsError a guard; StoppedBySignal
  void advance(std::int64_t steps);
  /// The bed, on every rank, ascending by id. Collective.
  PowderBed gather();

  double time() const { return static_cast<double>(steps_) * motion_.time_step; }
  double time_step() const { return motion_.time_step; }
  std::int64_t steps() const { return steps_; }
  std::int64_t grains() const { return grain_count_; }         ///< overflow left out
  double largest_overlap() const { return largest_overlap_; }  ///< over the diameter, since scatter
  /// Forces on walls that move since scatter, at every look.
  std::vector<ForceSample> const& wall_forces() const { return moving_walls_.history(); }
  std::int64_t nipped() const {
    return nipped_;
  }  ///< grains taken out because a moving wall crushed them, since scatter
  std::int64_t rebuilds() const { return rebuilds_; }
  std::int64_t touching_pairs() const;                  ///< Collective.
  PhaseTimes const& phases() const { return phases_; }  ///< of this rank, since scatter
  std::int64_t sleeping() const;                        ///< Collective.
  double coordination() const;                          ///< mean number of touching grains of a grain. Collective.
  /// \pre no ledger of energy is kept, and no grain sleeps \throws std::logic_error otherwise
  void set_gravity(Vec3 const& gravity);
  /// What became of the energy since scatter. Collective. \pre Motion::keeps_energy_ledger; gravity along no period
  EnergyLedger energy() const;
  /// Grains faster than `speed` [m/s]. Collective.
  std::int64_t count_faster_than(double speed) const;

 private:
  /// Largest values over all grains since the last look; what does not compare (NaN) shows in `broken`.
  struct Watch {
    double step_squared = 0, displacement_squared = 0, overlap = 0, broken = 0;
  };

  /// Something that must not be, seen on this rank; no text: nothing.
  struct Fault {
    double severity = -std::numeric_limits<double>::infinity();
    std::string text;
  };

  /// Lists grains, ghosts, neighbours and walls anew; grains marked as leaving are dropped. Collective.
  void rebuild();
  /// Drops the owned grains whose flag is set. Collective. \return how many on all ranks
  std::int64_t take_out(std::vector<char> const& leaves);
  void take_out_nipped();
  void check_first_overlaps();
  /// visit(row, other row, overlap over the smaller diameter, null or name of the wall) for every listed pair and wall.
  template <class Visit>
  void for_each_overlap(Visit const& visit) const;
  /// What one thread does: its rows, the pairs whose lower row is one of them, and what they do to any row.
  struct Share {
    NearPairs near;
    std::vector<GrainAction> actions;  ///< by slot, see NearPairs
    std::vector<GrainAction> held;     ///< of the first rows, which must wait for earlier shares
    WallBatch batch;
    EnergyBooks books;  ///< only where a ledger is kept
    Watch watch;
    double fastest_squared = 0;  ///< of the last step
  };

  /// Where what was done to a row is added up.
  struct ActionSlots {
    GrainAction* first;
    std::size_t first_row, mask;
    GrainAction& of(std::size_t row) const { return first[(row - first_row) & mask]; }
  };
  static ActionSlots in_ring(Share& share);
  static ActionSlots held_by(Share& share);

  void run_steps(std::int64_t count);
  /// One step of share `number`. \param so_far  steps since scatter
  void step(std::size_t number, std::int64_t so_far, StepBarrier& barrier, PhaseClock& clock, PhaseTimes& times);
  /// First row of a share that needs not wait for the pairs of the shares before it.
  std::size_t first_free_row(std::size_t number) const;
  /// Computes the pairs of a share, and moves its rows from `free` on as soon as theirs are done. \return largest speed
  /// squared
  double step_free_rows(std::size_t number, std::size_t free, PhaseClock& clock, PhaseTimes& times);
  /// Moves the other rows, when all shares have computed their pairs. \return largest speed squared
  double step_held_rows(std::size_t number, std::size_t free);
  /// Gives the owned rows to this many shares, equal in pairs, and chooses their near pairs.
  void share_out(int shares);
  void choose_near_pairs(Share& share, double half_gap);
  double suitable_half_gap(double fastest_squared) const;
  void evaluate(Share& share, std::size_t chunk, PhaseClock& clock, PhaseTimes& times);
  /// Takes what was done to rows [from, to) out of the ring, for later.
  void hold(Share& share, std::size_t from, std::size_t to);
  /// Adds what waits behind the rings of shares [0, number] for rows [from, to) to their slots.
  void add_far_actions(std::size_t number, std::size_t from, std::size_t to, ActionSlots const& slots);
  /// Moves rows [from, to) on by one step, and empties their slots. \return largest speed squared
  double move(Share& share, std::size_t from, std::size_t to, ActionSlots const& slots);
  double fastest_ghost_squared() const;
  std::vector<std::int64_t> loads() const;  ///< of the owned grains, in pairs
  void append_all_springs(std::vector<LocalSpring>& springs) const;
  void open_energy_ledger();
  /// Changes the grains outside the steps, and gives the energy that is lost by it to an account. Collective.
  template <class Change>
  void give_to(HeldEnergy& account, Change const& change);
  HeldEnergy held_energy() const;  ///< of all ranks, where the velocities lie. Collective.
  HeldEnergy held_by_grains(Grains const& grains) const;
  HeldEnergy held_by_pairs(Grains const& grains) const;
  HeldEnergy held_at_walls(Grains const& grains, MovingWalls const& walls) const;
  std::int64_t look();
  void check_sleep();
  Watch shared_watch();
  /// Throws the worst fault of all ranks, on all of them. Collective.
  [[noreturn]] void fail(Fault const& own);
  Fault find_lost_grain() const;
  /// \param seen  largest overlap over diameter since the last look
  Fault find_overlap(double seen) const;
  Fault find_fastest() const;
  bool is_inside(std::size_t row) const;
  WallScene scene() const { return {rig_.walls, moving_walls_, rig_.width, laws_.form, wall_reach_}; }

  Motion motion_;
  Rig rig_;
  Communicator communicator_;
  Decomposition decomposition_;
  MovingWalls moving_walls_;
  MeshGrids mesh_grids_;
  Grains grains_;
  Period period_;
  LawTable laws_;
  std::vector<ContactLaw> wall_laws_;  ///< by material; one: of all
  ActionUnit unit_;
  EnergyUnit energy_unit_;
  HeldEnergy held_at_start_, carried_out_, lost_to_sleep_;  ///< of all ranks
  BookedWork booked_;                                       ///< of this rank
  Neighbours neighbours_;
  std::vector<Share> shares_;  ///< one a thread
  double half_gap_ = 0, way_since_choice_ = 0, ghosts_fastest_squared_ = 0, reach_ = 0,
         wall_reach_ = 0;  ///< near pairs hold while no grain has gone farther than half_gap_ [m]
  WallContacts wall_contacts_;
  std::vector<std::int32_t> wall_entry_;      ///< of each owned grain in wall_contacts_; -1: none
  std::vector<ContactSpring> first_springs_;  ///< of the scattered bed, until the first rebuild
  std::vector<double> x_built_, y_built_, z_built_;
  Watch watch_;
  double skin_ = 0, smallest_radius_ = 0, largest_radius_ = 0;
  double largest_overlap_ = 0;
  std::int64_t steps_ = 0, grain_count_ = 0, rebuilds_ = 0, nipped_ = 0, next_sink_check_ = 0, next_sleep_check_ = 0;
  PhaseTimes phases_;
  ThreadTeam team_;
};

}  // namespace layerloop::dem
