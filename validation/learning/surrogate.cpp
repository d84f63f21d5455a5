#include "validation/learning/surrogate.hpp"

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "validation/maximise.hpp"

namespace layerloop::validation {
namespace {

constexpr Eigen::Index most_fitted = 300;  // rows that kernel and noise are learnt from; all of them predict
constexpr int evaluations = 150;           // of the posterior, from each start
constexpr int sweeps_between = 3;          // of the hyperparameters, from one draw to the next
constexpr double level_sd = 3;             // of the unknown level, in standard deviations of the values
constexpr double length_factor = 1, noise_median = 0.1, noise_factor = 1.5;  // factors as natural logarithms

struct Box {
  Eigen::VectorXd lower, upper;
  std::vector<Eigen::VectorXd> starts;
};

/// Logarithms of sd, noise and lengths, of values with unit spread at places in [0, 1].
Box hyperparameter_box(Eigen::Index inputs) {
  Box box{
      Eigen::VectorXd::Constant(2 + inputs, std::log(0.08)), Eigen::VectorXd::Constant(2 + inputs, std::log(20)), {}};
  box.lower[1] = std::log(1e-3), box.upper[1] = std::log(1.5);
  for (double const noise : {0.05, 0.5}) {
    Eigen::VectorXd start = Eigen::VectorXd::Constant(2 + inputs, std::log(0.7));
    start[0] = 0, start[1] = std::log(noise);
    box.starts.push_back(start);
  }
  return box;
}

double log_prior(Eigen::VectorXd const& at) {
  return -0.5 * std::pow((at[1] - std::log(noise_median)) / noise_factor, 2) -
         0.5 * (at.tail(at.size() - 2) / length_factor).squaredNorm();
}

GaussianProcess process_at(Eigen::VectorXd const& at, Eigen::MatrixXd const& places, Eigen::VectorXd const& values) {
  return {{std::exp(at[0]), at.tail(at.size() - 2).array().exp(), level_sd},
          0,
          places,
          values,
          Eigen::VectorXd::Constant(values.size(), std::exp(2 * at[1]))};
}

/// Logarithm of the posterior of the hyperparameters, but for a constant.
double log_posterior(Eigen::VectorXd const& at, Eigen::MatrixXd const& places, Eigen::VectorXd const& values) {
  return process_at(at, places, values).log_likelihood() + log_prior(at);
}

/// Some rows of many, drawn once for all.
std::vector<Eigen::Index> some_rows(Eigen::Index n) {
  std::vector<std::pair<double, Eigen::Index>> order;
  for (Eigen::Index i = 0; i < n; ++i)
    order.emplace_back(uniform4(0, RandomStream::acquisition, static_cast<std::uint64_t>(i), 99)[0], i);
  if (n > most_fitted) std::ranges::sort(order);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < std::min(n, most_fitted); ++i) rows.push_back(order[static_cast<std::size_t>(i)].second);
  return rows;
}

Eigen::VectorXd most_probable(Eigen::MatrixXd const& all_places, Eigen::VectorXd const& all_values) {
  std::vector<Eigen::Index> const rows = some_rows(all_places.rows());
  Eigen::MatrixXd const places = all_places(rows, Eigen::all);
  Eigen::VectorXd const values = all_values(rows);
  Box const box = hyperparameter_box(places.cols());
  auto const posterior = [&](Eigen::VectorXd const& at) { return log_posterior(at, places, values); };
  return maximise(posterior, box.lower, box.upper, box.starts, evaluations).at;
}

/// A new value of one coordinate from the density along it: under a level below the present one, shrinking towards it.
double slice_draw(std::function<double(Eigen::VectorXd const&)> const& density, Eigen::VectorXd at, Eigen::Index i,
                  double low, double high, std::uint64_t seed, std::uint64_t id) {
  double const here = at[i], level = density(at) + std::log(uniform4(seed, RandomStream::acquisition, id)[0]);
  for (std::uint32_t draw = 1;; ++draw) {
    at[i] = std::lerp(low, high, uniform4(seed, RandomStream::acquisition, id, draw)[0]);
    if (density(at) > level || high - low < 1e-9) return at[i];
    (at[i] < here ? low : high) = at[i];
  }
}

Eigen::RowVectorXd range_of(Eigen::MatrixXd const& places) {
  Eigen::RowVectorXd const range = places.colwise().maxCoeff() - places.colwise().minCoeff();
  return (range.array() > 0).select(range, 1.0);
}

double spread_of(Eigen::VectorXd const& values) {
  double const sd = std::sqrt((values.array() - values.mean()).square().mean());
  return sd > 0 ? sd : 1;
}

}  // namespace

Surrogate::Surrogate(Eigen::MatrixXd places, Eigen::VectorXd values)
    : places_(std::move(places)),
      values_(std::move(values)),
      low_(places_.colwise().minCoeff()),
      range_(range_of(places_)),
      centre_(values_.mean()),
      scale_(spread_of(values_)),
      hyperparameters_(most_probable(unit(places_), standard_values())),
      process_(process_at(hyperparameters_, unit(places_), standard_values())) {}

Surrogate::Surrogate(Surrogate const& other, Eigen::VectorXd const& hyperparameters)
    : places_(other.places_),
      values_(other.values_),
      low_(other.low_),
      range_(other.range_),
      centre_(other.centre_),
      scale_(other.scale_),
      hyperparameters_(hyperparameters),
      process_(process_at(hyperparameters_, unit(places_), standard_values())) {}

std::vector<Surrogate> Surrogate::drawn(std::size_t count, std::uint64_t seed) const {
  std::vector<Eigen::Index> const rows = some_rows(places_.rows());
  Eigen::MatrixXd const places = unit(places_)(rows, Eigen::all);
  Eigen::VectorXd const values = standard_values()(rows);
  Box const box = hyperparameter_box(places.cols());
  auto const density = [&](Eigen::VectorXd const& at) { return log_posterior(at, places, values); };
  Eigen::VectorXd at = hyperparameters_;
  std::vector<Surrogate> all;
  for (std::uint64_t k = 0; all.size() < count; ++k) {
    for (Eigen::Index i = 0; i < at.size(); ++i)
      at[i] = slice_draw(density, at, i, box.lower[i], box.upper[i], seed,
                         static_cast<std::uint64_t>(at.size()) * k + static_cast<std::uint64_t>(i));
    if (k % sweeps_between == sweeps_between - 1) all.push_back(Surrogate(*this, at));
  }
  return all;
}

Eigen::VectorXd Surrogate::standard_values() const { return (values_.array() - centre_) / scale_; }

Eigen::MatrixXd Surrogate::unit(Eigen::MatrixXd const& places) const {
  return (places.rowwise() - low_).array().rowwise() / range_.array();
}

Estimate Surrogate::operator()(Eigen::RowVectorXd const& place) const {
  Estimate const found = process_(unit(place));
  return {centre_ + scale_ * found.mean, scale_ * found.sd};
}

Joint Surrogate::together(Eigen::MatrixXd const& places) const {
  Joint found = process_.together(unit(places));
  found.mean = (centre_ + scale_ * found.mean.array()).matrix();
  found.covariance *= scale_ * scale_;
  return found;
}

LeftOut Surrogate::left_out(std::vector<std::size_t> const& group) const {
  LeftOut const found = process_.left_out(group);
  return {(centre_ + scale_ * found.mean.array()).matrix(), scale_ * found.sd};
}

std::vector<std::size_t> groups_of(Eigen::MatrixXd const& places) {
  std::vector<std::size_t> group;
  std::size_t found = 0;
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    Eigen::Index same = 0;
    while (same < i && places.row(same) != places.row(i)) ++same;
    group.push_back(same < i ? group[static_cast<std::size_t>(same)] : found++);
  }
  return group;
}

std::pair<double, double> share_interval(double hits, double n) {
  double const z2 = 1.96 * 1.96, share = hits / n;
  double const centre = (share + z2 / (2 * n)) / (1 + z2 / n);
  double const half = 1.96 / (1 + z2 / n) * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n));
  return {centre - half, centre + half};
}

Skill skill_of(Eigen::VectorXd const& values, LeftOut const& predicted) {
  auto const n = static_cast<double>(values.size());
  Eigen::ArrayXd const miss = (values - predicted.mean).array();
  auto const inside = static_cast<double>((miss.abs() <= 1.96 * predicted.sd.array()).count());
  double const mean_square = miss.square().mean();
  auto const [low, high] = share_interval(inside, n);
  return {static_cast<std::size_t>(values.size()),
          std::sqrt(mean_square),
          1 - mean_square / (values.array() - values.mean()).square().mean(),
          inside / n,
          low,
          high};
}

}  // namespace layerloop::validation
