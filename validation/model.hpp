#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace layerloop::validation {

/// Eigen counts with signed numbers, the standard library without.
inline Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// Where a model is evaluated.
struct ModelPoint {
  Eigen::VectorXd calibration;  ///< values, by Study::calibration [SI]
  Eigen::VectorXd strengths;    ///< by candidate, beyond what the case holds already; 0: not added
  std::uint64_t seeds = 0;      ///< set of seeds: points of one set share their random numbers
};

/// What a model says, by Study::observables [SI]; not a number where it has no answer (nothing melts, a guard stopped).
struct Prediction {
  Eigen::VectorXd value;
  Eigen::VectorXd u_sampling;   ///< standard error from grains and rays of this set of seeds
  Eigen::VectorXd u_numerical;  ///< standard uncertainty from mesh and time step
};

/// A model of a study's observables. Same point, same prediction, bit for bit.
class Model {
 public:
  virtual ~Model() = default;
  virtual Prediction predict(ModelPoint const& point) = 0;
  /// Passes over all conditions that were computed so far; what a cache knew counts nothing.
  virtual double passes() const = 0;
  /// What had no answer, and why, in words.
  virtual std::vector<std::string> notes() const { return {}; }
};

}  // namespace layerloop::validation
