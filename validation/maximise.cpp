#include "validation/maximise.hpp"

#include <nlopt.h>

#include <cmath>
#include <limits>
#include <memory>

namespace layerloop::validation {
namespace {

constexpr double very_low = -1e30;  // BOBYQA fits parabolas through what it is told, so infinity will not do

struct Best {
  std::function<double(Eigen::VectorXd const&)> const& function;
  Maximum found{.at = {}, .value = -std::numeric_limits<double>::infinity()};
};

double evaluate(unsigned size, double const* x, double*, void* data) {
  Best& best = *static_cast<Best*>(data);
  Eigen::VectorXd const at = Eigen::Map<Eigen::VectorXd const>(x, size);
  double const value = best.function(at);
  if (!std::isfinite(value)) return very_low;
  if (value > best.found.value) best.found = {at, value};
  return value;
}

}  // namespace

Maximum maximise(std::function<double(Eigen::VectorXd const&)> const& function, Eigen::VectorXd const& lower,
                 Eigen::VectorXd const& upper, std::vector<Eigen::VectorXd> const& starts, int evaluations) {
  Best best{function};
  for (Eigen::VectorXd const& start : starts) {
    std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> const search(
        nlopt_create(NLOPT_LN_BOBYQA, static_cast<unsigned>(start.size())), nlopt_destroy);
    nlopt_set_lower_bounds(search.get(), lower.data());
    nlopt_set_upper_bounds(search.get(), upper.data());
    nlopt_set_max_objective(search.get(), evaluate, &best);
    nlopt_set_maxeval(search.get(), evaluations);
    nlopt_set_xtol_rel(search.get(), 1e-3);
    nlopt_set_ftol_abs(search.get(), 1e-4);
    Eigen::VectorXd x = start.cwiseMax(lower).cwiseMin(upper);
    double value = 0;
    nlopt_optimize(search.get(), x.data(), &value);  // whatever ends it, `best` holds the best that was seen
  }
  return best.found;
}

}  // namespace layerloop::validation
