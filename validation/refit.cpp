#include "validation/refit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace layerloop::validation {
namespace {

constexpr double prior_weight = 1.0 / 9;  // of calibration: thrice its prior scale
constexpr double strength_weight = 1e-4;  // keeps a strength finite where the data do not see it
constexpr double difference_step = 0.25;  // [prior scales]
constexpr double farther_step = 2;        // where grains that fall otherwise would hide the first
constexpr double farthest = 4.5;          // that calibration may go [prior scales]
constexpr double enough = 0.05;           // gain of the objective that is not worth a pass
constexpr int most_passes = 14;

auto ulong(Eigen::Index i) { return static_cast<std::size_t>(i); }

}  // namespace

bool stands_at_bound(CalibrationParameter const& number, double value) {
  return std::abs(value - number.mean) > 0.99 * farthest * number.sd;
}

std::vector<Eigen::Index> movable_columns(Study const& study, Fit const& fit) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < fit.jacobian.cols(); ++k) {
    bool const is_calibration = ulong(k) < study.calibration.size();
    if (!is_calibration || !stands_at_bound(study.calibration[ulong(k)], fit.point.calibration[k]))
      columns.push_back(k);
  }
  return columns;
}

double Refit::scale(Fit const& fit, Eigen::Index k) const {
  auto const& calibration = frame_.study().calibration;
  if (ulong(k) < calibration.size()) return calibration[ulong(k)].sd;
  return candidates_[fit.active[ulong(k) - calibration.size()]].prior_scale;
}

Eigen::VectorXd Refit::distance(Fit const& fit) const {
  auto const& calibration = frame_.study().calibration;
  Eigen::VectorXd all(static_cast<Eigen::Index>(calibration.size() + fit.active.size()));
  for (Eigen::Index k = 0; k < all.size(); ++k) {
    bool const is_strength = ulong(k) >= calibration.size();
    double const value = is_strength
                             ? fit.point.strengths[static_cast<Eigen::Index>(fit.active[ulong(k) - calibration.size()])]
                             : fit.point.calibration[k] - calibration[ulong(k)].mean;
    all[k] = value / scale(fit, k);
  }
  return all;
}

void Refit::evaluate(Fit& fit) const {
  fit.prediction = model_.predict(fit.point);
  weigh(fit);
}

void Refit::weigh(Fit& fit) const {
  fit.residual = frame_.residual(fit.prediction);
  auto const free = static_cast<Eigen::Index>(frame_.study().calibration.size());
  fit.objective = fit.residual.allFinite()
                      ? fit.residual.squaredNorm() / sigma2_ + prior_weight * distance(fit).head(free).squaredNorm()
                      : std::numeric_limits<double>::infinity();
}

Eigen::VectorXd Refit::within_bounds(Fit const& fit, Eigen::VectorXd step) const {
  auto const& calibration = frame_.study().calibration;
  Eigen::VectorXd const now = distance(fit);
  for (Eigen::Index k = 0; k < step.size(); ++k) {
    double low = -farthest, high = farthest;
    if (ulong(k) < calibration.size()) {
      CalibrationParameter const& number = calibration[ulong(k)];
      if (!number.relative && number.mean > 0) low = std::max(low, -0.9 * number.mean / number.sd);
    } else {
      Candidate const& candidate = candidates_[fit.active[ulong(k) - calibration.size()]];
      high = candidate.largest / candidate.prior_scale;
      low = candidate.two_sided ? -high : 0;
    }
    step[k] = std::clamp(now[k] + step[k], low, high) - now[k];
  }
  return step;
}

Fit Refit::moved(Fit const& fit, Eigen::VectorXd const& step) const {
  Fit next = fit;
  auto const free = static_cast<Eigen::Index>(frame_.study().calibration.size());
  for (Eigen::Index k = 0; k < step.size(); ++k) {
    double& number = k < free ? next.point.calibration[k]
                              : next.point.strengths[static_cast<Eigen::Index>(fit.active[ulong(k - free)])];
    number += step[k] * scale(fit, k);
  }
  evaluate(next);
  return next;
}

Eigen::MatrixXd Refit::differences(Fit const& fit) const {
  auto const free = static_cast<Eigen::Index>(frame_.study().calibration.size() + fit.active.size());
  Eigen::MatrixXd all(frame_.size(), free);
  double const size = frame_.sampling_variance(fit.prediction) < 1 ? difference_step : farther_step;
  for (Eigen::Index k = 0; k < free; ++k) {
    Eigen::VectorXd step = Eigen::VectorXd::Unit(free, k) * size;
    if (within_bounds(fit, step)[k] < 0.5 * size) step = -step;  // stands at its upper bound
    Fit beside = moved(fit, step);
    if (!beside.residual.allFinite()) beside = moved(fit, step = -step);
    Eigen::VectorXd const change = frame_.change(beside.prediction, fit.prediction) / step[k];
    all.col(k) = change.allFinite() ? change : Eigen::VectorXd::Zero(frame_.size());
  }
  return all;
}

Fit Refit::at(ModelPoint point, std::vector<std::size_t> active) const {
  Fit fit{.point = std::move(point), .active = std::move(active), .prediction = {}, .residual = {}, .jacobian = {}};
  evaluate(fit);
  fit.jacobian = differences(fit);
  return fit;
}

Fit Refit::from(ModelPoint point, Prediction prediction) const {
  Fit fit{.point = std::move(point), .active = {}, .prediction = std::move(prediction), .residual = {}, .jacobian = {}};
  weigh(fit);
  fit.jacobian = differences(fit);
  return fit;
}

Fit Refit::with(Fit const& fit, std::size_t candidate, Eigen::VectorXd const& change) const {
  Fit wider = fit;
  wider.active.push_back(candidate);
  wider.jacobian.conservativeResize(Eigen::NoChange, fit.jacobian.cols() + 1);
  wider.jacobian.rightCols(1) = change;
  wider.converged = false;
  return wider;
}

Fit Refit::without(Fit fit, std::size_t active) const {
  auto const column = static_cast<Eigen::Index>(frame_.study().calibration.size() + active);
  Eigen::Index const after = fit.jacobian.cols() - column - 1;
  Eigen::MatrixXd left(fit.jacobian.rows(), fit.jacobian.cols() - 1);
  left << fit.jacobian.leftCols(column), fit.jacobian.rightCols(after);
  fit.jacobian = left;
  fit.point.strengths[static_cast<Eigen::Index>(fit.active[active])] = 0;
  fit.active.erase(fit.active.begin() + static_cast<std::ptrdiff_t>(active));
  fit.converged = false;
  evaluate(fit);
  return fit;
}

Fit Refit::improved(Fit fit) const {
  auto const calibration = static_cast<Eigen::Index>(frame_.study().calibration.size());
  Eigen::Index const free = fit.jacobian.cols();
  if (free == 0 || !std::isfinite(fit.objective)) {
    fit.converged = free == 0;
    return fit;
  }
  Eigen::VectorXd weight = Eigen::VectorXd::Constant(free, strength_weight);
  weight.head(calibration).setConstant(prior_weight);
  double const noise = 2 * frame_.sampling_variance(fit.prediction);  // no news: grains that fell otherwise
  double damping = 1e-3;
  for (int pass = 0; pass < most_passes; ++pass) {
    Eigen::MatrixXd normal = fit.jacobian.transpose() * fit.jacobian / sigma2_;
    normal.diagonal() += weight;
    Eigen::VectorXd const slope =
        fit.jacobian.transpose() * fit.residual / sigma2_ - weight.cwiseProduct(distance(fit));
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1 + damping;
    Eigen::VectorXd const step = within_bounds(fit, damped.ldlt().solve(slope));
    double const promised = 2 * slope.dot(step) - step.dot(normal * step);
    if (!(promised > enough)) {
      fit.converged = true;
      break;
    }
    Fit next = moved(fit, step);
    if (next.residual.allFinite()) {
      Eigen::VectorXd const news = frame_.change(next.prediction, fit.prediction) - fit.jacobian * step;
      if (news.squaredNorm() > noise) fit.jacobian += news * step.transpose() / step.squaredNorm();
      next.jacobian = fit.jacobian;
    }
    if (next.objective < fit.objective) {
      damping = std::max(1e-4, damping / 10);
      fit = std::move(next);
    } else {
      damping = std::max(0.1, damping * 10);
      if (damping > 1e5) break;
    }
  }
  return fit;
}

Fit Refit::settled(Fit fit) const {
  for (int round = 0; round < 2; ++round) {
    double const before = fit.objective;
    fit.jacobian = differences(fit);
    fit = improved(std::move(fit));
    if (fit.objective > before - 10 * enough) break;
  }
  return fit;
}

Eigen::VectorXd Refit::uncertainty(Fit const& fit) const {
  Eigen::Index const free = fit.jacobian.cols();
  Eigen::MatrixXd const normal =
      fit.jacobian.transpose() * fit.jacobian / sigma2_ + 1e-12 * Eigen::MatrixXd::Identity(free, free);
  return normal.inverse().diagonal().cwiseMax(0).cwiseSqrt();
}

}  // namespace layerloop::validation
