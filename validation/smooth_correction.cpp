#include "validation/smooth_correction.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "validation/gaussian_process.hpp"
#include "validation/maximise.hpp"

namespace layerloop::validation {
namespace {

using Rows = std::vector<Eigen::Index>;

constexpr int evaluations = 150;  // of the likelihood, from each start
constexpr double rank_share = 1e-6;

std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

/// Eigenvectors of a projection's block times the roots of their values: M M^T = block, without its empty directions.
struct Root {
  explicit Root(Eigen::MatrixXd const& block) {
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const of(block);
    double const least = rank_share * std::max(1e-300, of.eigenvalues().maxCoeff());
    Eigen::Index const kept = (of.eigenvalues().array() > least).count();
    vectors = of.eigenvectors().rightCols(kept);
    roots = of.eigenvalues().tail(kept).array().sqrt();
  }
  Eigen::MatrixXd matrix() const { return vectors * roots.asDiagonal(); }
  Eigen::MatrixXd inverse() const { return roots.cwiseInverse().asDiagonal() * vectors.transpose(); }
  Eigen::MatrixXd vectors;
  Eigen::VectorXd roots;
};

double log_likelihood(Eigen::MatrixXd const& covariance, Eigen::VectorXd const& values) {
  Eigen::LLT<Eigen::MatrixXd> const factor(covariance);
  return -0.5 * values.dot(factor.solve(values)) - Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum();
}

/// Most likely kernel of the projected residuals of one quantity: with M M^T the block of P that belongs to it, they
/// are M z, and z has the covariance sigma^2 + M^T K M.
Matern kernel_of(Eigen::MatrixXd const& places, Eigen::VectorXd const& residual, Eigen::MatrixXd const& block,
                 double sigma2) {
  Root const root(block);
  Eigen::VectorXd const z = root.inverse() * residual;
  Eigen::MatrixXd const m = root.matrix();
  Eigen::VectorXd const range = (places.colwise().maxCoeff() - places.colwise().minCoeff()).transpose();
  KernelBox const box(std::sqrt(sigma2), range);
  auto const likelihood = [&](Eigen::VectorXd const& logarithms) {
    Eigen::MatrixXd covariance = m.transpose() * box.at(logarithms)(places, places) * m;
    covariance.diagonal().array() += sigma2;
    return log_likelihood(covariance, z);
  };
  return box.at(maximise(likelihood, box.lower, box.upper, box.starts, evaluations).at);
}

/// Inverse of P C P on what P leaves.
Eigen::MatrixXd projected_inverse(Eigen::MatrixXd const& basis, Eigen::MatrixXd const& covariance) {
  return basis * (basis.transpose() * covariance * basis).llt().solve(basis.transpose());
}

/// Sum over the conditions of the misfit where each is predicted from the others, in the metric of the calibrated
/// model, less what noise would leave. \param inverse  of the projected covariance
double left_out_excess(std::map<std::size_t, Rows> const& by_condition, Eigen::MatrixXd const& inverse,
                       Eigen::MatrixXd const& projection, Eigen::VectorXd const& residual, double sigma2) {
  Eigen::VectorXd const weights = inverse * residual;
  double excess = 0;
  for (auto const& [condition, rows] : by_condition) {
    // Where one condition alone carries a calibration number, that direction cannot be predicted and is left out.
    Eigen::MatrixXd const own = inverse(rows, rows);
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
    decomposition.setThreshold(rank_share);
    decomposition.compute(own);
    Eigen::VectorXd const surprise = decomposition.solve(Eigen::VectorXd(weights(rows)));
    Eigen::MatrixXd const metric = projection(rows, rows);
    excess += surprise.dot(metric * surprise) / sigma2 - static_cast<double>(decomposition.rank());
  }
  return excess;
}

/// Values of every observation; nothing when some condition has none, or all are alike.
void add_column(std::vector<Eigen::VectorXd>& columns, Eigen::VectorXd const& values) {
  if (!values.allFinite()) return;
  double const low = values.minCoeff(), high = values.maxCoeff();
  if (high <= low) return;
  columns.emplace_back((values.array() - low) / (high - low));
}

}  // namespace

Eigen::MatrixXd smooth_inputs(Study const& study) {
  Eigen::Index const n = static_cast<Eigen::Index>(study.observations.size());
  std::set<std::string> keys, words;
  for (Condition const& condition : study.conditions) {
    for (auto const& [key, value] : condition.inputs) keys.insert(key);
    for (auto const& [key, value] : condition.words) words.insert(key);
  }
  std::vector<Eigen::VectorXd> columns;
  auto const add = [&](auto const& value) {
    Eigen::VectorXd column(n);
    for (Eigen::Index i = 0; i < n; ++i) column[i] = value(study.observations[at(i)]);
    add_column(columns, column);
  };
  auto const condition_of = [&](Observation const& seen) -> Condition const& {
    return study.conditions[seen.condition];
  };
  auto const place_of = [&](Observation const& seen) -> Observable const& {
    return study.observables[seen.observable];
  };
  for (std::string const& key : keys)
    add([&](Observation const& seen) {
      auto const found = condition_of(seen).inputs.find(key);
      return found == condition_of(seen).inputs.end() ? std::nan("") : found->second;
    });
  for (std::string const& key : words) {
    std::set<std::string> levels;
    for (Condition const& condition : study.conditions)
      if (condition.words.contains(key)) levels.insert(condition.words.at(key));
    add([&](Observation const& seen) {
      auto const found = condition_of(seen).words.find(key);
      return found == condition_of(seen).words.end()
                 ? std::nan("")
                 : static_cast<double>(std::distance(levels.begin(), levels.find(found->second)));
    });
  }
  add([&](Observation const& seen) { return place_of(seen).layer.value_or(0); });
  add([&](Observation const& seen) { return place_of(seen).x.value_or(0); });
  add([&](Observation const& seen) { return place_of(seen).y.value_or(0); });
  add([&](Observation const& seen) { return static_cast<double>(&seen - study.observations.data()); });
  Eigen::MatrixXd all(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) all.col(static_cast<Eigen::Index>(c)) = columns[c];
  return all;
}

double smooth_share(Study const& study, Eigen::VectorXd const& whitened_residual, Projection const& projection,
                    double sigma2) {
  Eigen::Index const n = whitened_residual.size();
  Eigen::MatrixXd const p = projection(Eigen::MatrixXd::Identity(n, n));
  Eigen::VectorXd const residual = projection(whitened_residual);
  std::map<std::string, Rows> by_quantity;
  std::map<std::size_t, Rows> by_condition;
  for (Eigen::Index i = 0; i < n; ++i) {
    by_quantity[study.observations[at(i)].quantity].push_back(i);
    by_condition[study.observations[at(i)].condition].push_back(i);
  }
  Eigen::MatrixXd const basis = Root(p).vectors;
  double const excess = left_out_excess(by_condition, p / sigma2, p, residual, sigma2);
  if (excess <= 0) return 0;

  Eigen::MatrixXd const places = smooth_inputs(study);
  Eigen::MatrixXd covariance = sigma2 * Eigen::MatrixXd::Identity(n, n);
  for (auto const& [quantity, rows] : by_quantity) {
    Eigen::MatrixXd const own = places(rows, Eigen::all);
    covariance(rows, rows) += kernel_of(own, residual(rows), p(rows, rows), sigma2)(own, own);
  }
  double const left = left_out_excess(by_condition, projected_inverse(basis, covariance), p, residual, sigma2);
  return std::clamp(1 - left / excess, 0.0, 1.0);
}

}  // namespace layerloop::validation
