#include "coupling/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/statistics.hpp"

namespace layerloop::coupling {
namespace {

/// What one bed gives, as it goes from rank to rank.
struct OneBed {
  double repose = 0, repose_u = 0, from_height = 0;
  double slip = 0, slip_u = 0, at_one_diameter = 0, largest_tilt = 0;
  double grains_on_base = 0, settling_time = 0;
  static constexpr std::size_t count = 9;
};

dem::Motion motion_with(Case checked, ContactParameters const& p) {
  ContactSettings& contact = checked.contact;
  contact.sliding_friction = p.sliding_friction;
  contact.rolling_friction = p.rolling_friction;
  contact.wall_friction = p.wall_friction;
  contact.cohesion_energy_density = p.wall_cohesion;
  dem::ContactLaw const at_walls = dem::motion_of(checked).at_walls;
  contact.cohesion_energy_density = p.cohesion_energy_density;
  dem::Motion motion = dem::motion_of(checked);
  motion.at_walls = at_walls;
  return motion;
}

struct Trial {
  ContactParameters parameters;
  std::uint64_t seed;
};

enum class Test { pile, plate };

/// One test of one trial, on this rank alone.
void run_test(OneBed& bed, Trial const& trial, Test test, Case const& checked, FirstBed* keep) {
  Communicator const alone(MPI_COMM_SELF);
  Case seeded = checked;
  seeded.seed = trial.seed;
  dem::Motion const motion = motion_with(seeded, trial.parameters);
  if (test == Test::pile) {
    dem::ReposePile const pile = dem::repose_pile(seeded, motion, alone, false);
    bed.repose = pile.angle_of_repose;
    bed.repose_u = pile.angle_of_repose_u;
    bed.from_height = pile.angle_from_height;
    bed.grains_on_base = static_cast<double>(pile.grains_on_base);
    bed.settling_time = pile.settling_time;
    if (keep) keep->profiles = pile.profiles;
  } else {
    dem::TiltingPlate const plate = dem::tilting_plate(seeded, motion, alone, false);
    bed.slip = plate.slipping_angle;
    bed.slip_u = plate.slipping_angle_u;
    bed.at_one_diameter = plate.tilt_at_one_diameter;
    bed.largest_tilt = plate.largest_tilt;
    if (keep) keep->record = plate.record;
  }
}

/// Adds what every rank found; each entry is filled by one rank and 0 on the others.
void share(std::vector<OneBed>& beds, Communicator const& comm) {
  static_assert(sizeof(OneBed) == OneBed::count * sizeof(double));
  std::vector<OneBed> const all = comm.all_gather(beds);
  for (std::size_t k = 0; k < beds.size(); ++k) {
    std::span<double> const sum(&beds[k].repose, OneBed::count);
    std::ranges::fill(sum, 0.0);
    for (std::size_t r = 0; r < all.size() / beds.size(); ++r) {
      double const* const other = &all[r * beds.size() + k].repose;
      for (std::size_t c = 0; c < OneBed::count; ++c) sum[c] += other[c];
    }
  }
}

/// Ends all ranks alike when a test ended badly on one.
void agree_on(std::string const& fault, bool stopped, Communicator const& comm) {
  if (comm.any(stopped))
    throw StoppedBySignal("stopped by a signal during calibration (no figure is left) start it again");
  std::string const line = fault.empty() ? fault : fault + '\n';
  std::vector<char> const all = comm.all_gather(std::vector<char>(line.begin(), line.end()));
  std::string const text(all.begin(), all.end());
  if (!text.empty()) throw PhysicsError(text.substr(0, text.find('\n')));
}

std::vector<OneBed> run_trials(std::vector<Trial> const& trials, Case const& checked, Communicator const& comm,
                               bool show_progress, FirstBed* first) {
  std::vector<OneBed> beds(trials.size());
  std::string fault;
  bool stopped = false;
  Progress progress("calibrate", static_cast<double>(2 * trials.size()), show_progress && comm.is_root());
  for (std::size_t job = static_cast<std::size_t>(comm.rank()); job < 2 * trials.size() && fault.empty() && !stopped;
       job += static_cast<std::size_t>(comm.size())) {
    try {
      run_test(beds[job / 2], trials[job / 2], job % 2 == 0 ? Test::pile : Test::plate, checked,
               job < 2 ? first : nullptr);
    } catch (StoppedBySignal const&) {
      stopped = true;
    } catch (Error const& error) {
      fault = error.what();
    }
    progress.update(static_cast<double>(job + 1));
  }
  agree_on(fault, stopped, comm);
  share(beds, comm);
  if (first) {
    comm.broadcast(first->profiles, 0);
    comm.broadcast(first->record, 1 % comm.size());
  }
  return beds;
}

MeasuredAngle over_replicates(std::span<OneBed const> beds, double OneBed::*value, double OneBed::*u = nullptr) {
  std::vector<double> values;
  double squares = 0;
  for (OneBed const& bed : beds) {
    values.push_back(bed.*value);
    if (u && std::isfinite(bed.*u)) squares += bed.*u * (bed.*u);
  }
  Sample const sample = sample_of(values);
  return {.value = sample.mean,
          .u_num = sample.n > 0 ? std::sqrt(squares) / static_cast<double>(sample.n) : 0.0,
          .u_bed = sample.n > 1 ? sample.half_width : 0.0,
          .n = sample.n};
}

CalibrationPoint point_of(ContactParameters const& parameters, std::span<OneBed const> beds) {
  CalibrationPoint point{.parameters = parameters,
                         .repose = over_replicates(beds, &OneBed::repose, &OneBed::repose_u),
                         .slip = over_replicates(beds, &OneBed::slip, &OneBed::slip_u),
                         .repose_from_height = over_replicates(beds, &OneBed::from_height),
                         .tilt_at_one_diameter = over_replicates(beds, &OneBed::at_one_diameter)};
  for (OneBed const& bed : beds) {
    point.largest_tilt = std::max(point.largest_tilt, bed.largest_tilt);
    point.settling_time = std::max(point.settling_time, bed.settling_time);
    point.grains_on_base += bed.grains_on_base / static_cast<double>(beds.size());
  }
  return point;
}
}  // namespace

std::array<std::string, ContactParameters::count> const& ContactParameters::names() {
  static std::array<std::string, count> const all{"sliding_friction", "rolling_friction", "cohesion_energy_density",
                                                  "wall_friction", "wall_cohesion"};
  return all;
}

std::array<double, ContactParameters::count> ContactParameters::values() const {
  return {sliding_friction, rolling_friction, cohesion_energy_density, wall_friction, wall_cohesion};
}

ContactParameters ContactParameters::of(std::array<double, count> const& v) { return {v[0], v[1], v[2], v[3], v[4]}; }

ContactParameters parameters_of(Case const& checked) {
  ContactSettings const& c = checked.contact;
  double const cohesion = c.cohesion == Cohesion::none ? 0.0 : c.cohesion_energy_density;
  return {c.sliding_friction, c.rolling_friction, cohesion, c.wall_friction, cohesion};
}

ContactParameters at_friction_and_cohesion(Case const& checked, double friction, double cohesion) {
  ContactParameters p = parameters_of(checked);
  p.wall_friction = p.sliding_friction > 0 ? p.wall_friction * friction / p.sliding_friction : friction;
  p.sliding_friction = friction;
  p.wall_cohesion = p.cohesion_energy_density = cohesion;
  return p;
}

double MeasuredAngle::u() const { return std::max(u_num, u_bed); }

bool CalibrationPoint::slipped() const { return std::isfinite(slip.value); }

std::array<double, 2> CalibrationPoint::errors(CalibrateSettings const& targets) const {
  return {repose.value / targets.target_repose - 1, (slipped() ? slip.value : largest_tilt) / targets.target_slip - 1};
}

std::vector<CalibrationPoint> run_tests(std::vector<ContactParameters> const& sets, Case const& checked,
                                        Communicator const& comm, bool show_progress, FirstBed* first) {
  auto const replicates = static_cast<std::size_t>(checked.run.replicates);
  std::vector<Trial> trials;
  for (ContactParameters const& set : sets)
    for (std::size_t r = 0; r < replicates; ++r) trials.push_back({set, checked.seed + r});
  std::vector<OneBed> const beds = run_trials(trials, checked, comm, show_progress, first);
  std::vector<CalibrationPoint> points;
  for (std::size_t k = 0; k < sets.size(); ++k)
    points.push_back(point_of(sets[k], std::span(beds).subspan(k * replicates, replicates)));
  return points;
}

}  // namespace layerloop::coupling
