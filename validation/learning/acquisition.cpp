#include "validation/learning/acquisition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/random.hpp"
#include "validation/largest_null.hpp"
#include "validation/maximise.hpp"

namespace layerloop::validation {
namespace {

constexpr Eigen::Index scattered = 600;  // places among which a search starts
constexpr std::size_t climbs = 3;        // from the best of them
constexpr int evaluations = 80;          // of a climb
constexpr Eigen::Index dense = 4000, possible = 300;
constexpr std::size_t kernels = 20, draws_of_each = 20;

using Function = std::function<double(Eigen::RowVectorXd const&)>;

/// Largest of a function in the box, by climbs from the best of many places. Where it is not finite it counts as very
/// low.
Eigen::RowVectorXd climb(Function const& function, InputBox const& box, Eigen::MatrixXd const& places) {
  std::vector<std::pair<double, Eigen::Index>> order;
  for (Eigen::Index i = 0; i < places.rows(); ++i) order.emplace_back(-function(places.row(i)), i);
  std::ranges::sort(order);
  Eigen::RowVectorXd const range = box.high - box.low;
  std::vector<Eigen::VectorXd> starts;
  for (std::size_t k = 0; k < std::min(climbs, order.size()); ++k)
    starts.emplace_back((places.row(order[k].second) - box.low).cwiseQuotient(range).transpose());
  auto const of_share = [&](Eigen::VectorXd const& share) { return function(box.at(share.transpose())); };
  Eigen::VectorXd const zero = Eigen::VectorXd::Zero(range.size()), one = Eigen::VectorXd::Ones(range.size());
  Maximum const found = maximise(of_share, zero, one, starts, evaluations);
  if (!std::isfinite(found.value)) return places.row(order.front().second);
  return box.at(found.at.transpose());
}

double best_believed(Surrogate const& surrogate) {
  double best = -INFINITY;
  for (auto const& place : surrogate.places().rowwise()) best = std::max(best, surrogate(place).mean);
  return best;
}

/// Scattered places and, so that a top found before is looked at again, those that were run.
Eigen::MatrixXd starts_of(Surrogate const& surrogate, InputBox const& box, std::uint64_t seed) {
  Eigen::MatrixXd places(scattered + surrogate.places().rows(), box.low.size());
  places << uniform_places(box, scattered, seed), surrogate.places();
  return places;
}

/// Places in boxes of four sizes around `top`, the largest as far to either side as the limits are apart; what falls
/// outside lies on the limit, for many a top does.
Eigen::MatrixXd places_around(Eigen::RowVectorXd const& top, InputBox const& box, std::uint64_t seed) {
  Eigen::RowVectorXd const range = box.high - box.low;
  Eigen::MatrixXd places = uniform_places({-range, range}, dense, seed);
  for (Eigen::Index i = 0; i < dense; ++i)
    places.row(i) =
        (top + std::ldexp(1.0, -static_cast<int>(i % 4)) * places.row(i)).cwiseMax(box.low).cwiseMin(box.high);
  return places;
}

/// Of many places of the region some that can be the top, as far as the surrogate knows: mean + 3 sd above its highest
/// mean. `top` is the first of them.
Eigen::MatrixXd possible_tops(Surrogate const& surrogate, InputBox const& box, Eigen::RowVectorXd const& top,
                              std::uint64_t seed, Region const& region) {
  Eigen::MatrixXd const all = places_around(top, box, seed);
  double const highest = surrogate(top).mean;
  Eigen::MatrixXd kept(possible, box.low.size());
  kept.row(0) = top;
  Eigen::Index n = 1;
  for (Eigen::Index i = 0; i < dense && n < possible; ++i) {
    Estimate const at = surrogate(all.row(i));
    if (at.mean + 3 * at.sd > highest && region(all.row(i))) kept.row(n++) = all.row(i);
  }
  return kept.topRows(n);
}

/// A root of a covariance that rounding may have left with negative eigenvalues.
Eigen::MatrixXd root_of(Eigen::MatrixXd const& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const parts(covariance);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  double const at = share * static_cast<double>(values.size() - 1);
  auto const low = static_cast<std::size_t>(at);
  return std::lerp(values[low], values[std::min(low + 1, values.size() - 1)], at - static_cast<double>(low));
}

}  // namespace

double log_expected_improvement(Estimate const& at, double best) {
  if (at.sd <= 0) return at.mean > best ? std::log(at.mean - best) : -INFINITY;
  double const z = (at.mean - best) / at.sd;
  double const log_density = -0.5 * z * z - 0.5 * std::log(2 * std::numbers::pi);
  if (z < -8) return std::log(at.sd) + log_density - 2 * std::log(-z);
  return std::log(at.sd) + std::log(std::exp(log_density) + z * 0.5 * std::erfc(-z / std::numbers::sqrt2));
}

Eigen::RowVectorXd InputBox::at(Eigen::RowVectorXd const& share) const { return low + share.cwiseProduct(high - low); }

Eigen::MatrixXd uniform_places(InputBox const& box, Eigen::Index n, std::uint64_t seed) {
  Eigen::Index const inputs = box.low.size();
  Eigen::MatrixXd places(n, inputs);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::RowVectorXd share(inputs);
    for (Eigen::Index d = 0; d < inputs; ++d)
      share[d] = uniform4(seed, RandomStream::acquisition, static_cast<std::uint64_t>(i),
                          static_cast<std::uint32_t>(d / 4))[static_cast<std::size_t>(d % 4)];
    places.row(i) = box.at(share);
  }
  return places;
}

Eigen::RowVectorXd next_place(Surrogate const& surrogate, InputBox const& box, Acquisition acquisition,
                              std::uint64_t seed, Region const& region) {
  double const best = best_believed(surrogate);
  auto const worth = [&](Eigen::RowVectorXd const& place) {
    if (!region(place)) return -std::numeric_limits<double>::infinity();
    Estimate const at = surrogate(place);
    if (acquisition == Acquisition::variance) return at.sd;
    if (acquisition == Acquisition::upper_confidence_bound) return at.mean + 2 * at.sd;
    return log_expected_improvement(at, best);
  };
  return climb(worth, box, starts_of(surrogate, box, seed));
}

Eigen::RowVectorXd highest_mean(Surrogate const& surrogate, InputBox const& box, std::uint64_t seed,
                                Region const& region) {
  auto const mean = [&](Eigen::RowVectorXd const& place) {
    return region(place) ? surrogate(place).mean : -std::numeric_limits<double>::infinity();
  };
  return climb(mean, box, starts_of(surrogate, box, seed));
}

Optimum find_optimum(Surrogate const& surrogate, InputBox const& box, std::uint64_t seed, Region const& region) {
  Eigen::RowVectorXd const top = highest_mean(surrogate, box, seed, region);
  Eigen::MatrixXd const places = possible_tops(surrogate, box, top, seed + 1, region);
  std::vector<double> values;
  std::vector<std::vector<double>> tops(static_cast<std::size_t>(box.low.size()));
  std::uint64_t id = 0;
  for (Surrogate const& one : surrogate.drawn(kernels, seed)) {
    Joint const joint = one.together(places);
    Eigen::MatrixXd const root = root_of(joint.covariance);
    for (std::size_t k = 0; k < draws_of_each; ++k) {
      Eigen::VectorXd const drawn = joint.mean + root * standard_normal(places.rows(), seed, id++);
      Eigen::Index at = 0;
      values.push_back(drawn.maxCoeff(&at));
      for (std::size_t d = 0; d < tops.size(); ++d) tops[d].push_back(places(at, static_cast<Eigen::Index>(d)));
    }
  }
  Optimum found{top, top, top, surrogate(top), quantile(values, 0.025), quantile(values, 0.975)};
  for (std::size_t d = 0; d < tops.size(); ++d) {
    auto const k = static_cast<Eigen::Index>(d);
    found.place_low[k] = std::min(top[k], quantile(tops[d], 0.025));
    found.place_high[k] = std::max(top[k], quantile(tops[d], 0.975));
  }
  return found;
}

}  // namespace layerloop::validation
