#include "validation/noise_level.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <map>
#include <numeric>

namespace layerloop::validation {
namespace {

double median(std::vector<double> values) {
  auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// z of columns in a residual; zero where the projection leaves nothing of a column.
Eigen::VectorXd scores(Eigen::MatrixXd const& columns, Projection const& project, Eigen::VectorXd const& residual) {
  Eigen::MatrixXd const left = project(columns);
  Eigen::VectorXd z(columns.cols());
  for (Eigen::Index k = 0; k < z.size(); ++k)
    z[k] = left.col(k).norm() > 1e-3 * columns.col(k).norm() ? left.col(k).dot(residual) / left.col(k).norm() : 0.0;
  return z;
}

/// Robust scale of a residual: 1 where the uncertainties are right (Rousseeuw & Croux 1993: median absolute deviation).
double robust_scale(Eigen::VectorXd const& residual, Eigen::VectorXd const& diagonal) {
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < residual.size(); ++i)
    if (diagonal[i] > 0.05) sizes.push_back(std::abs(residual[i]) / std::sqrt(diagonal[i]));
  return sizes.empty() ? 1.0 : median(sizes) / 0.6745;
}

/// Columns, and with them those of the level of a label that differs most, if one does: by an F test, because a step in
/// few rows passes for scatter where a scale has to be known first.
Eigen::MatrixXd with_level(Eigen::MatrixXd const& columns, Fit const& fit, ResidualFrame const& frame,
                           std::vector<Jump> const& jumps) {
  constexpr double surely = 1e-3;
  Eigen::Index const n = fit.residual.size();
  Projection const without(n, columns);
  double const left = without(fit.residual).squaredNorm();
  Eigen::MatrixXd best = columns;
  double least = surely / static_cast<double>(std::max<std::size_t>(1, jumps.size()));
  for (Jump const& jump : jumps) {
    if (jump.label == order_of_acquisition) continue;
    Eigen::MatrixXd const wider = beside(columns, frame.without_spared(jump.columns));
    Projection const with(n, wider);
    double const taken = static_cast<double>(with.rank() - without.rank()),
                 dof = static_cast<double>(n - with.rank()) - static_cast<double>(frame.spared().size());
    if (taken < 1 || dof < 3) continue;
    double const rest = with(fit.residual).squaredNorm();
    boost::math::fisher_f const f(taken, dof);
    double const p = boost::math::cdf(boost::math::complement(f, std::max(0.0, (left - rest) / taken / (rest / dof))));
    if (p < least) least = p, best = wider;
  }
  return best;
}

/// Calibration, a label, the best of the candidates and of the patterns: those above a score, the strongest first,
/// while two thirds of the data stay free.
Eigen::MatrixXd permissive_columns(Fit const& fit, ResidualFrame const& frame, Signatures const& signatures,
                                   Patterns const& patterns, std::vector<Jump> const& jumps,
                                   Thresholds const& thresholds) {
  Eigen::Index const n = fit.residual.size();
  Eigen::MatrixXd columns = with_level(fit.jacobian, fit, frame, jumps);
  Eigen::Index const most = std::max<Eigen::Index>(columns.cols(), n / 3);
  double scale = 1;
  while (columns.cols() < most) {
    Projection const project(n, columns);
    Eigen::VectorXd const left = project(fit.residual);
    scale = std::max(1.0, robust_scale(left, project.diagonal()));
    Eigen::VectorXd const a = scores(signatures.columns, project, left) / scale,
                          b = scores(patterns.columns, project, left) / scale;
    Eigen::Index best_a = 0, best_b = 0;
    double const za = a.size() ? a.cwiseAbs().maxCoeff(&best_a) : 0, zb = b.size() ? b.cwiseAbs().maxCoeff(&best_b) : 0;
    if (za < 2.5 && zb < thresholds.outlier_z) break;
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.rightCols(1) = za >= 2.5 ? signatures.columns.col(best_a) : patterns.columns.col(best_b);
  }
  return columns;
}

void count_replicates(ResidualFrame const& frame, NoiseLevel& level) {
  std::map<std::size_t, std::vector<Observation const*>> readings;
  auto const& all = frame.study().observations;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].u_stat > 0 && std::ranges::find(frame.spared(), i) == frame.spared().end())
      readings[all[i].observable].push_back(&all[i]);
  double chi2 = 0;
  level.replicate_dof = 0;
  for (auto const& [observable, same] : readings) {
    double weight = 0, sum = 0;
    for (auto const* seen : same) weight += std::pow(seen->u_stat, -2), sum += seen->value * std::pow(seen->u_stat, -2);
    for (auto const* seen : same) chi2 += std::pow((seen->value - sum / weight) / seen->u_stat, 2);
    level.replicate_dof += static_cast<double>(same.size() - 1);
  }
  level.from_replicates = level.replicate_dof > 0 ? chi2 / level.replicate_dof : 1;
}

/// Both estimates together where they agree; where the fit scatters more than replicates do, that is structure.
double agreed(NoiseLevel const& level) {
  if (level.fit_dof < 3) return level.replicate_dof >= 3 ? level.from_replicates : 1.0;
  if (level.replicate_dof < 3) return level.from_fit;
  double const ratio = level.from_fit / level.from_replicates;
  boost::math::fisher_f const f(level.fit_dof, level.replicate_dof);
  if (ratio > 0 && boost::math::cdf(boost::math::complement(f, ratio)) < 0.01) return level.from_replicates;
  return (level.from_fit * level.fit_dof + level.from_replicates * level.replicate_dof) /
         (level.fit_dof + level.replicate_dof);
}

/// The observation that stands out most, if one does.
bool spare_worst(ResidualFrame& frame, Eigen::VectorXd const& left, Eigen::VectorXd const& diagonal, double scale,
                 Thresholds const& thresholds, NoiseLevel& level) {
  Eigen::VectorXd size = Eigen::VectorXd::Zero(left.size());
  for (Eigen::Index i = 0; i < left.size(); ++i)
    if (diagonal[i] > 0.05) size[i] = std::abs(left[i]) / (scale * std::sqrt(diagonal[i]));
  for (std::size_t const k : frame.spared()) size[static_cast<Eigen::Index>(k)] = 0;
  Eigen::Index worst = 0;
  if (!(size.maxCoeff(&worst) > thresholds.outlier_z)) return false;
  auto const k = static_cast<std::size_t>(worst);
  level.outliers.push_back({frame.study().observations[k].id, left[worst] / (scale * std::sqrt(diagonal[worst]))});
  frame.spare(k);
  return true;
}

}  // namespace

std::vector<Jump> jumps_in(ResidualFrame const& frame, Fit const& fit) {
  std::vector<Jump> jumps =
      jumps_of(frame.study(), at_observations(frame.study(), fit.prediction.value), frame.whiten());
  for (Jump& jump : jumps) jump.columns = frame.without_spared(jump.columns);
  return jumps;
}

NoiseLevel find_noise_level(ResidualFrame& frame, Fit& fit, Signatures& signatures, Patterns& patterns,
                            Thresholds const& thresholds) {
  NoiseLevel level;
  if (!thresholds.scales) return level;
  std::vector<Jump> const jumps = jumps_in(frame, fit);
  auto const most = static_cast<std::size_t>(thresholds.outlier_share * static_cast<double>(frame.size()));
  for (;;) {
    Eigen::MatrixXd const columns = permissive_columns(fit, frame, signatures, patterns, jumps, thresholds);
    Projection const project(frame.size(), columns);
    Eigen::VectorXd const left = project(fit.residual);
    double const scale = std::max(1.0, robust_scale(left, project.diagonal()));
    level.fit_dof = static_cast<double>(frame.size() - project.rank()) - static_cast<double>(frame.spared().size());
    level.from_fit = level.fit_dof > 0 ? left.squaredNorm() / level.fit_dof : 1;
    if (frame.spared().size() >= most || !spare_worst(frame, left, project.diagonal(), scale, thresholds, level)) break;
    fit.residual = frame.without_spared(fit.residual);
    fit.jacobian = frame.without_spared(fit.jacobian);
    signatures.columns = frame.without_spared(signatures.columns);
    patterns.columns = frame.without_spared(patterns.columns);
  }
  count_replicates(frame, level);
  level.sigma2 = std::max(1.0, agreed(level));
  return level;
}

}  // namespace layerloop::validation
