#include "coupling/calibration_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace layerloop::coupling {
namespace {
constexpr double ridge = 1e-9;           // on the normal equations: with few points the terms share what they explain
constexpr double weight_range = 0.5;     // distance from the best point that halves a point's weight
constexpr double told_change = 0.1;      // of a parameter, whose compensation is told
constexpr double largest_told = 1;       // change that is still called a compensation
constexpr double significant_slope = 1;  // in its own uncertainty

Eigen::Vector<double, 6> terms(double u, double v) { return {1, u, v, u * u, u * v, v * v}; }

ResponseSurface fit(std::vector<CalibrationPoint> const& points, CalibrateSettings const& c, std::size_t angle) {
  SearchRange const range(c);
  auto const distance = [&](CalibrationPoint const& p) { return std::hypot(p.errors(c)[0], p.errors(c)[1]); };
  auto const best = range.place(std::ranges::min_element(points, {}, distance)->parameters);
  std::vector<ResponseSurface::Point> data;
  for (CalibrationPoint const& p : points) {
    auto const [u, v] = range.place(p.parameters);
    double const apart = std::hypot(u - best[0], v - best[1]) / weight_range;
    double const target = angle == 0 ? c.target_repose : c.target_slip;
    data.push_back({u, v, target * (1 + p.errors(c)[angle]), 1 / (1 + apart * apart)});
  }
  return ResponseSurface(data);
}

using Slopes = Eigen::Matrix<double, 2, ContactParameters::count>;
enum Column { sliding, rolling, cohesive, wall_sliding, wall_cohesive };

/// Columns of friction and of cohesion when grains and walls change together.
Eigen::Matrix2d searched(Slopes const& slopes) {
  Eigen::Matrix2d both;
  both.col(0) = slopes.col(sliding) + slopes.col(wall_sliding);
  both.col(1) = slopes.col(cohesive) + slopes.col(wall_cohesive);
  return both;
}

std::string percent(double share) { return fmt::format("{:+.0f} %", 100 * share); }

/// The friction and cohesion that make up for a change of another parameter.
Undetermined compensation(Slopes const& slopes, std::size_t other) {
  Undetermined u{};
  Eigen::Vector2d const made_up =
      searched(slopes).fullPivLu().solve(-told_change * slopes.col(static_cast<long>(other)));
  u.change[other] = told_change;
  u.change[sliding] += made_up(0);
  u.change[wall_sliding] += made_up(0);
  u.change[cohesive] += made_up(1);
  u.change[wall_cohesive] += made_up(1);
  std::string const& name = ContactParameters::names()[other];
  u.text = made_up.cwiseAbs().maxCoeff() <= largest_told
               ? fmt::format(
                     "{} {} changes neither angle when friction changes by {} and cohesion by {} (grains and "
                     "walls alike)",
                     name, percent(told_change), percent(made_up(0)), percent(made_up(1)))
               : fmt::format("{} {} cannot be made up for by friction and cohesion within a factor of two", name,
                             percent(told_change));
  return u;
}

/// The combination of friction and cohesion that moves both angles least, and how far it may go unseen.
Undetermined worst_told(Slopes const& slopes, Eigen::Vector2d const& relative_u) {
  Eigen::Matrix2d const whitened = relative_u.cwiseInverse().asDiagonal() * searched(slopes);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> squares;
  squares.computeDirect(whitened.transpose() * whitened);  // ascending
  double const least = std::sqrt(std::max(squares.eigenvalues()(0), 0.0)), unseen = 1 / std::max(least, 1e-6);
  Eigen::Vector2d const direction = squares.eigenvectors().col(0);
  Undetermined u{};
  u.change = {direction(0), 0, direction(1), direction(0), direction(1)};
  u.text = fmt::format(
      "friction and cohesion changed in the ratio {:.2f} : {:.2f} move the angles least: a change of {:.0f} % in that "
      "direction stays within the uncertainty of the angles",
      direction(0), direction(1), 100 * unseen);
  return u;
}
}  // namespace

ResponseSurface::ResponseSurface(std::vector<Point> const& points) {
  Eigen::Matrix<double, 6, 6> normal = ridge * Eigen::Matrix<double, 6, 6>::Identity();
  Eigen::Vector<double, 6> right = Eigen::Vector<double, 6>::Zero();
  for (Point const& p : points) {
    auto const t = terms(p.u, p.v);
    normal += p.weight * t * t.transpose();
    right += p.weight * p.value * t;
  }
  coefficients_ = normal.ldlt().solve(right);
}

double ResponseSurface::operator()(double u, double v) const { return coefficients_.dot(terms(u, v)); }

AngleSurfaces::AngleSurfaces(std::vector<CalibrationPoint> const& points, CalibrateSettings const& c)
    : repose(fit(points, c, 0)), slip(fit(points, c, 1)) {}

Sensitivity sensitivity_of(CalibrationPoint const& centre, std::vector<CalibrationPoint> const& changed, double step) {
  Sensitivity s;
  Slopes slopes = Slopes::Zero();
  auto const slip_of = [](CalibrationPoint const& p) { return p.slipped() ? p.slip.value : p.largest_tilt; };
  double const angle[2] = {centre.repose.value, slip_of(centre)};
  Eigen::Vector2d const relative_u(std::max(centre.repose.u() / angle[0], 1e-3),
                                   std::max((centre.slipped() ? centre.slip.u() : 0.0) / angle[1], 1e-3));
  auto const values = centre.parameters.values();
  for (std::size_t p = 0; p < ContactParameters::count; ++p) {
    if (values[p] == 0) continue;
    CalibrationPoint const &up = changed[2 * p], &down = changed[2 * p + 1];
    double const rise[2] = {up.repose.value - down.repose.value, slip_of(up) - slip_of(down)};
    double const u[2] = {std::hypot(up.repose.u(), down.repose.u()),
                         std::hypot(up.slipped() ? up.slip.u() : 0.0, down.slipped() ? down.slip.u() : 0.0)};
    for (std::size_t a = 0; a < 2; ++a) {
      s.slope[a][p] = rise[a] / (2 * step * angle[a]);
      s.slope_u[a][p] = u[a] / (2 * step * angle[a]);
      slopes(static_cast<long>(a), static_cast<long>(p)) = s.slope[a][p];
    }
  }
  Slopes const whitened = relative_u.cwiseInverse().asDiagonal() * slopes;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> squares;
  squares.computeDirect(whitened * whitened.transpose(), Eigen::EigenvaluesOnly);  // ascending
  s.singular_values = {std::sqrt(std::max(squares.eigenvalues()(1), 0.0)),
                       std::sqrt(std::max(squares.eigenvalues()(0), 0.0))};
  for (std::size_t const other : {std::size_t{rolling}, std::size_t{wall_sliding}, std::size_t{wall_cohesive}}) {
    if (values[other] == 0) continue;
    bool const felt = std::abs(s.slope[0][other]) > significant_slope * s.slope_u[0][other] ||
                      std::abs(s.slope[1][other]) > significant_slope * s.slope_u[1][other];
    s.undetermined.push_back(compensation(slopes, other));
    if (!felt)
      s.undetermined.back().text =
          fmt::format("{}: a change of {:.0f} % up or down moves neither angle by more than its uncertainty",
                      ContactParameters::names()[other], 100 * step);
  }
  s.undetermined.push_back(worst_told(slopes, relative_u));
  return s;
}

}  // namespace layerloop::coupling
