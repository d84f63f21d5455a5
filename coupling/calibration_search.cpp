// The search for friction and cohesion that give both target angles, and what the two angles leave open.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/calibration.hpp"
#include "coupling/calibration_fit.hpp"
#include "coupling/stopwatch.hpp"

namespace layerloop::coupling {
namespace {
constexpr double degree = std::numbers::pi / 180;
constexpr double nearest_new_point = 0.1;  // to a point that is known, where either range is 2
constexpr int scan = 80;                   // places along either range where the surfaces are compared with the targets

/// Distance from both targets, in tolerances.
double misfit(std::array<double, 2> const& errors, double tolerance) {
  return std::hypot(errors[0], errors[1]) / tolerance;
}

bool reaches(CalibrationPoint const& point, CalibrateSettings const& c) {
  auto const [repose, slip] = point.errors(c);
  return point.slipped() && std::abs(repose) <= c.tolerance && std::abs(slip) <= c.tolerance;
}

std::size_t closest(std::vector<CalibrationPoint> const& points, CalibrateSettings const& c) {
  auto const distance = [&](CalibrationPoint const& p) { return misfit(p.errors(c), c.tolerance); };
  return static_cast<std::size_t>(std::ranges::min_element(points, {}, distance) - points.begin());
}

std::vector<ContactParameters> map_of(Case const& checked) {
  CalibrateSettings const& c = checked.calibrate;
  SearchRange const range(c);
  std::vector<ContactParameters> sets;
  for (std::int64_t j = 0; j < c.grid; ++j) {
    for (std::int64_t i = 0; i < c.grid; ++i) {
      auto const place = [&](std::int64_t k) {
        return -1 + 2 * static_cast<double>(k) / static_cast<double>(c.grid - 1);
      };
      sets.push_back(at_friction_and_cohesion(checked, range.friction(place(i)), range.cohesion(place(j))));
    }
  }
  return sets;
}

/// Where the fitted surfaces come closest to both targets, away from points that are known.
ContactParameters next_point(std::vector<CalibrationPoint> const& points, Case const& checked) {
  CalibrateSettings const& c = checked.calibrate;
  SearchRange const range(c);
  AngleSurfaces const fitted(points, c);
  double best = std::numeric_limits<double>::infinity(), best_u = 0, best_v = 0;
  for (int j = 0; j <= scan; ++j) {
    for (int i = 0; i <= scan; ++i) {
      double const u = -1 + 2.0 * i / scan, v = -1 + 2.0 * j / scan;
      bool const known = std::ranges::any_of(points, [&](CalibrationPoint const& p) {
        auto const [pu, pv] = range.place(p.parameters);
        return std::hypot(u - pu, v - pv) < nearest_new_point;
      });
      double const distance =
          misfit({fitted.repose(u, v) / c.target_repose - 1, fitted.slip(u, v) / c.target_slip - 1}, c.tolerance);
      if (known || distance >= best) continue;
      best = distance;
      best_u = u;
      best_v = v;
    }
  }
  return at_friction_and_cohesion(checked, range.friction(best_u), range.cohesion(best_v));
}

std::string percent(double share) { return fmt::format("{:+.1f} %", 100 * share); }

std::string in_words(CalibrationPoint const& p) {
  std::string const slip = p.slipped() ? fmt::format("{:.1f} deg", p.slip.value / degree)
                                       : fmt::format("none up to {:.0f} deg", p.largest_tilt / degree);
  return fmt::format("friction {:.3g}, cohesion {:.4g} J/m3: angle of repose {:.1f} deg, slipping angle {}",
                     p.parameters.sliding_friction, p.parameters.cohesion_energy_density, p.repose.value / degree,
                     slip);
}

void conclude(Calibration& found, CalibrateSettings const& c) {
  CalibrationPoint const& best = found.points[found.best];
  auto const [repose, slip] = best.errors(c);
  found.target_reached = reaches(best, c);
  std::string const errors = fmt::format("({} and {} of {:.1f} and {:.1f} deg)", percent(repose), percent(slip),
                                         c.target_repose / degree, c.target_slip / degree);
  found.verdict = fmt::format(
      "{}: {} {}",
      found.target_reached
          ? fmt::format("both targets within {:g} %", 100 * c.tolerance)
          : fmt::format("no point that was tried reaches both targets within {:g} %; the closest", 100 * c.tolerance),
      in_words(best), errors);
}

/// Both angles with every parameter changed up and down, one at a time.
Sensitivity sensitivity_at(CalibrationPoint const& centre, Case const& checked, Communicator const& comm,
                           bool show_progress) {
  double const step = checked.calibrate.parameter_step;
  std::vector<ContactParameters> sets;
  for (std::size_t p = 0; p < ContactParameters::count; ++p) {
    for (double const sign : {1.0, -1.0}) {
      auto values = centre.parameters.values();
      values[p] *= 1 + sign * step;
      sets.push_back(ContactParameters::of(values));
    }
  }
  return sensitivity_of(centre, run_tests(sets, checked, comm, show_progress), step);
}
}  // namespace

Calibration calibrate(Case const& checked, Communicator const& comm, bool show_progress) {
  CalibrateSettings const& c = checked.calibrate;
  Calibration found;
  {
    Stopwatch const timed(found.wall_time);
    std::vector<ContactParameters> sets{parameters_of(checked)};
    if (c.search) {
      std::vector<ContactParameters> const map = map_of(checked);
      sets.insert(sets.end(), map.begin(), map.end());
      found.map_points = map.size();
    }
    found.points = run_tests(sets, checked, comm, show_progress, &found.first);
    found.best = closest(found.points, c);
    for (std::int64_t k = 0; c.search && k < c.refinements && !reaches(found.points[found.best], c); ++k) {
      found.points.push_back(run_tests({next_point(found.points, checked)}, checked, comm, show_progress).front());
      found.best = closest(found.points, c);
    }
    conclude(found, c);
    if (c.search) found.sensitivity = sensitivity_at(found.points[found.best], checked, comm, show_progress);
  }
  return found;
}

}  // namespace layerloop::coupling
