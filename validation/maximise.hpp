#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace layerloop::validation {

struct Maximum {
  Eigen::VectorXd at;
  double value = 0;
};

/// Largest value of a function inside a box, from fixed starts and without derivatives (BOBYQA; Powell, DAMTP
/// 2009/NA06). A value that is not finite counts as very low. \param evaluations  at most, from each start
Maximum maximise(std::function<double(Eigen::VectorXd const&)> const& function, Eigen::VectorXd const& lower,
                 Eigen::VectorXd const& upper, std::vector<Eigen::VectorXd> const& starts, int evaluations);

}  // namespace layerloop::validation
