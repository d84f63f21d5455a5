#include "validation/largest_null.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace layerloop::validation {
namespace {

constexpr Eigen::Index draws = 4000;
constexpr Eigen::Index batch = 200;

double beyond(double score) {  // of one score, both sides
  return 2 * boost::math::cdf(boost::math::complement(boost::math::normal(), score));
}

}  // namespace

Eigen::VectorXd standard_normal(Eigen::Index n, std::uint64_t seed, std::uint64_t id) {
  Eigen::VectorXd all(n);
  for (Eigen::Index i = 0; i < n; i += 4) {
    auto const u = uniform4(seed, RandomStream::null_draws, id, static_cast<std::uint32_t>(i / 4));
    for (Eigen::Index pair = 0; pair < 2; ++pair) {
      double const r = std::sqrt(-2 * std::log(u[static_cast<std::size_t>(2 * pair)]));
      double const angle = 2 * std::numbers::pi * u[static_cast<std::size_t>(2 * pair + 1)];
      if (i + 2 * pair < n) all[i + 2 * pair] = r * std::cos(angle);
      if (i + 2 * pair + 1 < n) all[i + 2 * pair + 1] = r * std::sin(angle);
    }
  }
  return all;
}

LargestNull::LargestNull(Eigen::MatrixXd const& directions, std::vector<bool> const& two_sided, std::uint64_t seed) {
  if (directions.cols() == 0) return;
  draws_.reserve(draws);
  for (Eigen::Index first = 0; first < draws; first += batch) {
    Eigen::MatrixXd noise(directions.rows(), batch);
    for (Eigen::Index d = 0; d < batch; ++d)
      noise.col(d) = standard_normal(directions.rows(), seed, static_cast<std::uint64_t>(first + d));
    Eigen::MatrixXd scores = directions.transpose() * noise;
    for (Eigen::Index k = 0; k < scores.rows(); ++k)
      if (two_sided[static_cast<std::size_t>(k)]) scores.row(k) = scores.row(k).cwiseAbs();
    Eigen::VectorXd const largest = scores.colwise().maxCoeff();
    draws_.insert(draws_.end(), largest.begin(), largest.end());
  }
  std::ranges::sort(draws_);
  double const single = beyond(critical(0.05));
  independent_ = std::max(1.0, std::log1p(-0.05) / std::log1p(-single));
}

double LargestNull::critical(double family_error) const {
  if (draws_.empty()) return 0;
  auto const rank = static_cast<std::size_t>((1 - family_error) * static_cast<double>(draws_.size()));
  return draws_[std::min(rank, draws_.size() - 1)];
}

double LargestNull::p(double score) const {
  if (draws_.empty()) return 1;
  auto const above = draws_.end() - std::ranges::lower_bound(draws_, score);
  if (above >= 40) return static_cast<double>(above) / static_cast<double>(draws_.size());
  return -std::expm1(independent_ * std::log1p(-beyond(score)));
}

}  // namespace layerloop::validation
