#include "validation/proposal.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "validation/rival_fits.hpp"

namespace layerloop::validation {
namespace {

// Squared distance D at which the right one of two leads in 95 of 100 studies, and in 77 by the 6 of -2 ln L that end a
// GROUP: the lead is normal about D with the variance 4 D.
constexpr double told_apart = 10.8;

/// Of the means of so many readings of each quantity.
Eigen::ArrayXd uncertainty(Proposal const& p, Study const& study, double sigma, int readings) {
  Eigen::ArrayXd u(p.value[0].size());
  for (Eigen::Index q = 0; q < u.size(); ++q) {
    ReadingError const error = reading_error(study, p.quantities[static_cast<std::size_t>(q)]);
    u[q] = sigma * std::abs(p.value[0][q]) * std::hypot(error.random / std::sqrt(readings), error.shared);
  }
  return u;
}

/// Least separation of the best explanation from any rival with so many readings more.
double separation_with(Proposal const& p, Standing const& now, Study const& study, double sigma, int readings) {
  Eigen::ArrayXd const weight = uncertainty(p, study, sigma, readings).inverse();
  double least = 1e300;
  for (std::size_t r = 1; r < p.value.size(); ++r) {
    Eigen::VectorXd const d = (p.value[0] - p.value[r]).array() * weight;
    for (std::size_t const refitted : {r, std::size_t{0}}) {
      Eigen::MatrixXd const slopes = weight.matrix().asDiagonal() * p.derivative[refitted];
      least = std::min(least, separation(now.difference[r], now.derivatives[refitted], d, slopes));
    }
  }
  return least;
}

}  // namespace

ReadingError reading_error(Study const& study, std::string const& quantity) {
  std::vector<double> random, shared;
  for (Observation const& seen : study.observations) {
    if (seen.quantity != quantity || seen.value == 0) continue;
    random.push_back(seen.u_stat / std::abs(seen.value));
    shared.push_back(std::hypot(seen.u_sys_rel, seen.u_sys_abs / seen.value));
  }
  if (random.empty()) return {};
  std::ranges::sort(random);
  std::ranges::sort(shared);
  return {random[random.size() / 2], shared[shared.size() / 2]};
}

bool Proposal::is_known() const {
  return std::ranges::all_of(value, [](auto const& v) { return v.allFinite(); }) &&
         std::ranges::all_of(derivative, [](auto const& d) { return d.allFinite(); }) && (value[0].array() != 0).all();
}

Proposal joined(Proposal one, Proposal const& other) {
  one.conditions.insert(one.conditions.end(), other.conditions.begin(), other.conditions.end());
  one.quantities.insert(one.quantities.end(), other.quantities.begin(), other.quantities.end());
  for (std::size_t r = 0; r < one.value.size(); ++r) {
    Eigen::VectorXd value(one.value[r].size() + other.value[r].size());
    value << one.value[r], other.value[r];
    Eigen::MatrixXd derivative(value.size(), one.derivative[r].cols());
    derivative << one.derivative[r], other.derivative[r];
    one.value[r] = value, one.derivative[r] = derivative;
  }
  return one;
}

NextExperiment judged(Proposal const& p, std::vector<Condition> const& grid, Standing const& now, Study const& study,
                      double sigma, std::vector<std::string> const& names) {
  Eigen::ArrayXd const u = uncertainty(p, study, sigma, 1);
  Eigen::ArrayXd nearest = p.value[0] - p.value[1];  // to that rival which is the hardest to tell in each reading
  for (std::size_t r = 2; r < p.value.size(); ++r) {
    Eigen::ArrayXd const d = p.value[0] - p.value[r];
    nearest = (d.abs() < nearest.abs()).select(d, nearest);
  }
  Eigen::Index leading = 0;
  (nearest / u).abs().maxCoeff(&leading);
  std::size_t const place = p.conditions[static_cast<std::size_t>(leading)];
  NextExperiment next{
      .condition = grid[place], .quantity = p.quantities[static_cast<std::size_t>(leading)], .separates = names};
  for (std::string const& quantity : std::set(p.quantities.begin(), p.quantities.end()))
    if (quantity != next.quantity) next.together.push_back(quantity);
  for (std::size_t const other : std::set(p.conditions.begin(), p.conditions.end()))
    if (other != place) next.also_at.push_back(grid[other]);
  next.separation = separation_with(p, now, study, sigma, 1);
  next.u = u[leading];
  next.difference = nearest[leading];
  next.replicates = most_replicates + 1;
  for (int n = most_replicates; n >= 1; --n)
    if (separation_with(p, now, study, sigma, n) >= told_apart) next.replicates = n;
  return next;
}

bool better(NextExperiment const& a, NextExperiment const& b) {
  auto const cost = [](NextExperiment const& e) {
    return std::tuple(e.replicates, e.also_at.size(), e.together.size(), -e.separation);
  };
  return cost(a) < cost(b);
}

}  // namespace layerloop::validation
