#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "validation/blind/judgement.hpp"
#include "validation/error_model.hpp"

namespace layerloop::validation {
namespace {

/// Whitened residual of the calibrated model, and what every candidate changes at its prior scale.
struct Regression {
  Eigen::VectorXd residual;
  Eigen::MatrixXd signatures;
  std::vector<std::size_t> candidates;  ///< of the columns
};

ModelPoint calibrated(Study const& study, Model& model, std::size_t candidates) {
  ModelPoint point{.calibration = prior_means(study), .strengths = Eigen::VectorXd::Zero(index(candidates))};
  auto const rows = index(study.observations.size()), numbers = point.calibration.size();
  for (int iteration = 0; iteration < 3; ++iteration) {  // Gauss and Newton
    Prediction const base = model.predict(point);
    Whitening const whiten(covariance(study, base));
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(rows + numbers, numbers);
    Eigen::VectorXd target = Eigen::VectorXd::Zero(rows + numbers);
    target.head(rows) = whiten(measured_values(study) - at_observations(study, base.value));
    for (Eigen::Index k = 0; k < numbers; ++k) {
      auto const& number = study.calibration[static_cast<std::size_t>(k)];
      ModelPoint stepped = point;
      stepped.calibration[k] += 0.1 * number.sd;
      slopes.col(k).head(rows) = whiten(at_observations(study, model.predict(stepped).value - base.value)) * 10;
      slopes(rows + k, k) = 1;
      target[rows + k] = (number.mean - point.calibration[k]) / number.sd;
    }
    Eigen::VectorXd const step = slopes.colPivHouseholderQr().solve(target);
    for (Eigen::Index k = 0; k < numbers; ++k)
      point.calibration[k] += step[k] * study.calibration[static_cast<std::size_t>(k)].sd;
  }
  return point;
}

Regression regression_of(Study const& study, Model& model, std::vector<Candidate> const& candidates) {
  ModelPoint const point = calibrated(study, model, candidates.size());
  Prediction const base = model.predict(point);
  Whitening const whiten(covariance(study, base));
  Regression regression{whiten(measured_values(study) - at_observations(study, base.value)), {}, {}};
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    ModelPoint probe = point;
    probe.strengths[index(c)] = candidates[c].prior_scale;
    Eigen::VectorXd const column = whiten(at_observations(study, model.predict(probe).value - base.value));
    if (!column.allFinite() || column.norm() == 0) continue;
    columns.push_back(column);
    regression.candidates.push_back(c);
  }
  regression.signatures.resize(regression.residual.size(), index(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) regression.signatures.col(index(c)) = columns[c];
  return regression;
}

using Columns = std::vector<Eigen::Index>;

struct Selected {
  Columns columns;              ///< the largest contribution first
  std::vector<double> factors;  ///< of the prior scale
};

/// n ln(rss/n) + k ln n.
double criterion(double rss, Eigen::Index rows, std::size_t columns) {
  auto const n = static_cast<double>(rows);
  return n * std::log(rss / n) + static_cast<double>(columns) * std::log(n);
}

Eigen::VectorXd least_squares(Regression const& r, Columns const& columns) {
  return r.signatures(Eigen::all, columns).colPivHouseholderQr().solve(r.residual);
}

Selected largest_correlation(Regression const& r) {
  Eigen::VectorXd const correlation = (r.signatures.transpose() * r.residual).array() /
                                      r.signatures.colwise().norm().transpose().array() / r.residual.norm();
  Eigen::Index best = 0;
  double const largest = correlation.cwiseAbs().maxCoeff(&best);
  auto const freedom = static_cast<double>(r.residual.size()) - 2;
  double const t = largest * std::sqrt(freedom / (1 - largest * largest));
  double const p = 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), t));
  if (p * static_cast<double>(correlation.size()) > 0.01) return {};
  return {{best}, {least_squares(r, {best})[0]}};
}

Selected stepwise(Regression const& r) {
  Columns chosen;
  double best = criterion(r.residual.squaredNorm(), r.residual.size(), 0);
  constexpr std::size_t most = 10;
  while (chosen.size() < most) {
    std::optional<Eigen::Index> next;
    for (Eigen::Index c = 0; c < r.signatures.cols(); ++c) {
      if (std::ranges::find(chosen, c) != chosen.end()) continue;
      Columns trial = chosen;
      trial.push_back(c);
      double const rss = (r.residual - r.signatures(Eigen::all, trial) * least_squares(r, trial)).squaredNorm();
      if (double const bic = criterion(rss, r.residual.size(), trial.size()); bic < best) best = bic, next = c;
    }
    if (!next) break;
    chosen.push_back(*next);
  }
  if (chosen.empty()) return {};
  Eigen::VectorXd const factors = least_squares(r, chosen);
  return {chosen, {factors.begin(), factors.end()}};
}

/// Coordinate descent (Friedman, Hastie & Tibshirani, J. Stat. Softw. 33 (2010) 1) over falling penalties.
Selected lasso(Regression const& r) {
  Eigen::RowVectorXd const norms = r.signatures.colwise().norm();
  Eigen::MatrixXd const unit = r.signatures.array().rowwise() / norms.array();
  Eigen::VectorXd factors = Eigen::VectorXd::Zero(unit.cols()), best_factors = factors;
  double const strongest = (unit.transpose() * r.residual).cwiseAbs().maxCoeff();
  double best = criterion(r.residual.squaredNorm(), r.residual.size(), 0);
  constexpr int penalties = 30;
  for (int step = 1; step <= penalties; ++step) {
    double const penalty = strongest * std::pow(0.01, static_cast<double>(step) / penalties);
    Eigen::VectorXd rest = r.residual - unit * factors;
    for (int sweep = 0; sweep < 100; ++sweep) {
      double moved = 0;
      for (Eigen::Index c = 0; c < unit.cols(); ++c) {
        double const pull = unit.col(c).dot(rest) + factors[c];
        double const fresh = std::copysign(std::max(std::abs(pull) - penalty, 0.0), pull);
        rest += unit.col(c) * (factors[c] - fresh);
        moved = std::max(moved, std::abs(fresh - factors[c]));
        factors[c] = fresh;
      }
      if (moved < 1e-4) break;
    }
    auto const active = static_cast<std::size_t>((factors.array() != 0).count());
    double const bic = criterion(rest.squaredNorm(), r.residual.size(), active);
    if (bic < best) best = bic, best_factors = factors;
  }
  Selected selected;
  for (Eigen::Index c = 0; c < unit.cols(); ++c)
    if (best_factors[c] != 0) selected.columns.push_back(c);
  std::ranges::sort(selected.columns, std::greater(), [&](auto c) { return std::abs(best_factors[c]); });
  for (Eigen::Index const c : selected.columns) selected.factors.push_back(best_factors[c] / norms[c]);
  return selected;
}

Judgement judgement_of(Selected const& selected, Regression const& r, std::vector<Candidate> const& candidates) {
  Judgement judgement;
  judgement.verdict = selected.columns.empty() ? "CONSISTENT" : "IDENTIFIED";
  for (std::size_t i = 0; i < selected.columns.size(); ++i) {
    Candidate const& candidate = candidates[r.candidates[static_cast<std::size_t>(selected.columns[i])]];
    judgement.named.push_back(
        {candidate.name, candidate.kind == EffectClass::physics, selected.factors[i] * candidate.prior_scale});
  }
  return judgement;
}

}  // namespace

std::string const& name_of(Baseline baseline) {
  static std::array<std::string, baselines> const names{"largest correlation", "stepwise BIC", "LASSO"};
  return names.at(static_cast<std::size_t>(baseline));
}

std::vector<Judgement> judge_by_baselines(World const& world, Study const& training,
                                          std::vector<std::string> const& withheld) {
  std::vector<Candidate> const candidates = known_candidates(world, training, withheld);
  auto const model = world.model(training, candidates);
  Regression const regression = regression_of(training, *model, candidates);
  std::vector<Judgement> judgements;
  for (auto const& method : {largest_correlation, stepwise, lasso})
    judgements.push_back(judgement_of(method(regression), regression, candidates));
  return judgements;
}

}  // namespace layerloop::validation
