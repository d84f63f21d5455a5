#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "dem/repose_pile.hpp"
#include "dem/tilting_plate.hpp"

namespace layerloop::coupling {

/// What the two tests are taken to depend on. Friction and cohesion at walls stand for themselves here.
struct ContactParameters {
  double sliding_friction = 0, rolling_friction = 0;
  double cohesion_energy_density = 0;  ///< between grains [J/m^3]
  double wall_friction = 0;
  double wall_cohesion = 0;  ///< energy density at walls [J/m^3]

  static constexpr std::size_t count = 5;
  static std::array<std::string, count> const& names();
  std::array<double, count> values() const;
  static ContactParameters of(std::array<double, count> const& values);
};

/// Those of the case; wall cohesion is the case's energy density (contact.wall_cohesion_area says on which area).
ContactParameters parameters_of(Case const& checked);
/// The case's with another friction and cohesion: those at walls change by the same factors.
ContactParameters at_friction_and_cohesion(Case const& checked, double friction, double cohesion);

/// An angle over replicates [rad].
struct MeasuredAngle {
  double value = 0;  ///< mean; not a number when no replicate has one
  double u_num = 0;  ///< half the 95 % interval from the scatter within one bed, combined over the replicates
  double u_bed = 0;  ///< half the t-interval over replicates; 0 with one
  std::int64_t n = 0;
  double u() const;  ///< the larger of both
};

/// Both tests at one set of parameters.
struct CalibrationPoint {
  ContactParameters parameters = {};
  MeasuredAngle repose = {}, slip = {};
  MeasuredAngle repose_from_height = {}, tilt_at_one_diameter = {};
  double largest_tilt = 0;    ///< that the plate was given [rad]
  double grains_on_base = 0;  ///< mean over replicates
  double settling_time = 0;   ///< of the pile, the longest [s]
  bool slipped() const;
  /// Relative errors of both angles; a layer that did not slip counts with the largest tilt.
  std::array<double, 2> errors(CalibrateSettings const& targets) const;
};

/// What the first bed of a run of tests left: the pile's surface and the layer's motion.
struct FirstBed {
  std::vector<dem::PileProfile> profiles;
  std::vector<dem::TiltSample> record;
};

/// Runs both tests at every set of parameters, `run.replicates` times with seeds seed, seed + 1, ...; ranks share the
/// tests out, each test runs on one rank. Collective. \throws PhysicsError a guard stopped a test; StoppedBySignal
std::vector<CalibrationPoint> run_tests(std::vector<ContactParameters> const& sets, Case const& checked,
                                        Communicator const& comm, bool show_progress, FirstBed* first = nullptr);

/// Something that the two angles do not tell, in words and as relative changes of the parameters.
struct Undetermined {
  std::string text;
  std::array<double, ContactParameters::count> change;  ///< relative, of each parameter
};

/// How both angles answer to each parameter at one point.
struct Sensitivity {
  /// d ln(angle) / d ln(parameter): rows repose, slip.
  std::array<std::array<double, ContactParameters::count>, 2> slope{}, slope_u{};
  std::array<double, 2> singular_values{};  ///< of the slopes over the relative uncertainty of their angle
  std::vector<Undetermined> undetermined;
};

/// What the verb calibrate finds.
struct Calibration {
  std::vector<CalibrationPoint> points;  ///< the case's first, then the map, then the refinements
  std::size_t best = 0;                  ///< closest to both targets
  std::size_t map_points = 0;            ///< of the map, after the first
  bool target_reached = false;
  std::string verdict;  ///< in words
  std::optional<Sensitivity> sensitivity;
  FirstBed first;
  double wall_time = 0;  ///< [s]
};

/// Collective; every rank gets the same.
Calibration calibrate(Case const& checked, Communicator const& comm, bool show_progress);

}  // namespace layerloop::coupling
