#pragma once
#include <cmath>
#include <cstdint>

#include "validation/gaussian_process.hpp"

namespace layerloop::validation {

/// A result of simulations over what was set, as a Gaussian process whose kernel, level and noise are learnt from the
/// results themselves. Places of any scale: every input is brought to [0, 1] over its range.
class Surrogate {
 public:
  /// The most probable kernel: lengths are log-normal about the range of their input, with a factor of e; the noise is
  /// log-normal about a tenth of the spread of the values, with a factor of e^1.5; sd is uniform in its logarithm.
  /// Replicates (rows with the same place) fix the noise by their own spread, as far as they go. Of more than 300 rows
  /// 300 are enough for that; predictions come from all.
  /// \param places (runs, inputs) \param values  by run, finite \pre two runs at least
  Surrogate(Eigen::MatrixXd places, Eigen::VectorXd values);
  /// The same results under kernels drawn from their posterior: what these results leave open of kernel and noise. By
  /// slices along one hyperparameter after the other (Neal, Ann. Stat. 31 (2003) 705).
  std::vector<Surrogate> drawn(std::size_t count, std::uint64_t seed) const;

  Estimate operator()(Eigen::RowVectorXd const& place) const;  ///< of the function, without noise
  Joint together(Eigen::MatrixXd const& places) const;
  LeftOut left_out(std::vector<std::size_t> const& group) const;
  double noise_sd() const { return scale_ * std::exp(hyperparameters_[1]); }  ///< of one run about the function
  Eigen::MatrixXd const& places() const { return places_; }
  Eigen::VectorXd const& values() const { return values_; }
  /// Correlation lengths over the range of each input: short ones matter.
  Eigen::VectorXd const& lengths() const { return process_.kernel().length; }

 private:
  Surrogate(Surrogate const& other, Eigen::VectorXd const& hyperparameters);
  Eigen::MatrixXd unit(Eigen::MatrixXd const& places) const;
  Eigen::VectorXd standard_values() const;

  Eigen::MatrixXd places_;
  Eigen::VectorXd values_;
  Eigen::RowVectorXd low_, range_;   ///< of the inputs; range 1 where one never varies
  double centre_, scale_;            ///< of the values: mean and standard deviation
  Eigen::VectorXd hyperparameters_;  ///< logarithms of sd, noise (both over scale) and lengths (over range)
  GaussianProcess process_;
};

/// Rows that share a place are one group: numbers by row, from 0 in order of appearance.
std::vector<std::size_t> groups_of(Eigen::MatrixXd const& places);

/// How well values are predicted that played no part in the prediction.
struct Skill {
  std::size_t n = 0;
  double rmse = 0;
  double q2 = 0;            ///< 1 - (rmse / standard deviation of the values)^2
  double coverage = 0;      ///< share inside mean +- 1.96 sd
  double coverage_low = 0;  ///< 95 % interval of that share (Wilson, J. Am. Stat. Assoc. 22 (1927) 209)
  double coverage_high = 0;
};
Skill skill_of(Eigen::VectorXd const& values, LeftOut const& predicted);

/// 95 % interval of a share that came out `hits` times in `n` (Wilson).
std::pair<double, double> share_interval(double hits, double n);

}  // namespace layerloop::validation
