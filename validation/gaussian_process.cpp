#include "validation/gaussian_process.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "validation/maximise.hpp"

namespace layerloop::validation {
namespace {

constexpr double shortest = 0.15, longest = 20;  // lengths over the range of their input
constexpr int evaluations = 250;                 // of the likelihood, from each start
constexpr double jitter = 1e-10;                 // of the variance: keeps equal places apart in floating point

}  // namespace

Eigen::MatrixXd Matern::operator()(Eigen::MatrixXd const& a, Eigen::MatrixXd const& b) const {
  Eigen::MatrixXd squared = Eigen::MatrixXd::Zero(a.rows(), b.rows());
  for (Eigen::Index d = 0; d < length.size(); ++d)
    squared += ((a.col(d).replicate(1, b.rows()) - b.col(d).transpose().replicate(a.rows(), 1)) / length[d])
                   .array()
                   .square()
                   .matrix();
  Eigen::ArrayXXd const r = (5 * squared.array()).sqrt();
  return (sd * sd * (1 + r + r.square() / 3) * (-r).exp() + level_sd * level_sd).matrix();
}

GaussianProcess::GaussianProcess(Matern kernel, double mean, Eigen::MatrixXd places, Eigen::VectorXd const& values,
                                 Eigen::VectorXd const& noise)
    : kernel_(std::move(kernel)), mean_(mean), places_(std::move(places)), values_(values) {
  Eigen::MatrixXd covariance = kernel_(places_, places_);
  covariance.diagonal() += noise;
  covariance.diagonal().array() += jitter * kernel_.variance();
  factor_.compute(covariance);
  weights_ = factor_.solve((values_.array() - mean_).matrix());
}

Estimate GaussianProcess::operator()(Eigen::RowVectorXd const& place) const {
  Eigen::VectorXd const shared = kernel_(places_, place);
  double const variance = kernel_.variance() - shared.dot(factor_.solve(shared));
  return {mean_ + shared.dot(weights_), std::sqrt(std::max(0.0, variance))};
}

Joint GaussianProcess::together(Eigen::MatrixXd const& places) const {
  Eigen::MatrixXd const shared = kernel_(places_, places);
  Eigen::VectorXd mean = shared.transpose() * weights_;
  mean.array() += mean_;
  return {std::move(mean), kernel_(places, places) - shared.transpose() * factor_.solve(shared)};
}

double GaussianProcess::log_likelihood() const {
  double const log_root = Eigen::MatrixXd(factor_.matrixL()).diagonal().array().log().sum();
  return -0.5 * (values_.array() - mean_).matrix().dot(weights_) - log_root -
         0.5 * static_cast<double>(values_.size()) * std::log(2 * std::numbers::pi);
}

/// With A = C^-1: value minus prediction of a group g is (A_gg)^-1 (A r)_g, and its covariance (A_gg)^-1 (Rasmussen &
/// Williams, section 5.4.2, for groups).
LeftOut GaussianProcess::left_out(std::vector<std::size_t> const& group) const {
  Eigen::Index const n = values_.size();
  Eigen::MatrixXd const inverse = factor_.solve(Eigen::MatrixXd::Identity(n, n));
  LeftOut predicted{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (std::size_t const g : std::set(group.begin(), group.end())) {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < group.size(); ++i)
      if (group[i] == g) rows.push_back(static_cast<Eigen::Index>(i));
    Eigen::Index const size = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd const covariance =
        Eigen::MatrixXd(inverse(rows, rows)).ldlt().solve(Eigen::MatrixXd::Identity(size, size));
    predicted.mean(rows) = values_(rows) - covariance * weights_(rows);
    predicted.sd(rows) = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  }
  return predicted;
}

KernelBox::KernelBox(double sd, Eigen::VectorXd const& range) {
  Eigen::VectorXd const unit = (range.array() > 0).select(range, 1.0);
  lower.resize(1 + range.size());
  upper.resize(1 + range.size());
  lower << std::log(1e-3 * sd), (shortest * unit).array().log().matrix();
  upper << std::log(30 * sd), (longest * unit).array().log().matrix();
  for (Eigen::Index d = 0; d < range.size(); ++d)
    if (range[d] <= 0) lower[1 + d] = upper[1 + d] = 0;
  for (double const share : {0.5, 3.0}) {
    Eigen::VectorXd start(1 + range.size());
    start << std::log(sd), (share * unit).array().log().matrix();
    starts.push_back(start.cwiseMax(lower).cwiseMin(upper));
  }
}

Matern KernelBox::at(Eigen::VectorXd const& logarithms) const {
  Eigen::VectorXd const values = logarithms.array().exp();
  return {values[0], values.tail(values.size() - 1)};
}

GaussianProcess fit_gaussian_process(Eigen::MatrixXd const& places, Eigen::VectorXd const& values,
                                     Eigen::VectorXd const& noise) {
  double const mean = values.mean();
  double const sd = std::sqrt((values.array() - mean).square().mean());
  Eigen::VectorXd const range = (places.colwise().maxCoeff() - places.colwise().minCoeff()).transpose();
  KernelBox const box(sd > 0 ? sd : 1, range);
  auto const process = [&](Eigen::VectorXd const& at) {
    return GaussianProcess(box.at(at), mean, places, values, noise);
  };
  return process(maximise([&](Eigen::VectorXd const& at) { return process(at).log_likelihood(); }, box.lower, box.upper,
                          box.starts, evaluations)
                     .at);
}

}  // namespace layerloop::validation
