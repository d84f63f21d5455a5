#pragma once
#include <Eigen/Dense>
#include <vector>

namespace layerloop::validation {

/// Matern covariance of smoothness 5/2 with one length for each input (Rasmussen & Williams, Gaussian Processes for
/// Machine Learning, MIT Press 2006, eq. 4.17): s^2 (1 + a + a^2/3) exp(-a), a^2 = 5 sum ((x_i - y_i) / length_i)^2.
struct Matern {
  double sd = 1;
  Eigen::VectorXd length;
  double level_sd = 0;  ///< of an unknown constant that the function stands on: level_sd^2 is added
  double variance() const { return sd * sd + level_sd * level_sd; }  ///< at one place
  /// (rows of a, rows of b); a and b hold one place a row.
  Eigen::MatrixXd operator()(Eigen::MatrixXd const& a, Eigen::MatrixXd const& b) const;
};

struct Estimate {
  double mean = 0, sd = 0;  ///< sd: of the function itself, without the noise of a reading
};

/// Several places at once. Shapes: n; (n, n).
struct Joint {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;  ///< of the function itself
};

/// Predictions by point; sd: of the reading, its noise included.
struct LeftOut {
  Eigen::VectorXd mean, sd;
};

/// A smooth function known at some places, with noise: mean and covariance of all functions that agree.
class GaussianProcess {
 public:
  /// \param places  (points, inputs) \param mean  of the function, before any data \param noise  variance by point
  GaussianProcess(Matern kernel, double mean, Eigen::MatrixXd places, Eigen::VectorXd const& values,
                  Eigen::VectorXd const& noise);
  Estimate operator()(Eigen::RowVectorXd const& place) const;
  double log_likelihood() const;
  /// Mean and covariance at several places (one a row) together.
  Joint together(Eigen::MatrixXd const& places) const;
  /// Every value predicted from the points of other groups alone, with the same kernel, in closed form. \param group by
  /// point
  LeftOut left_out(std::vector<std::size_t> const& group) const;
  Matern const& kernel() const { return kernel_; }

 private:
  Matern kernel_;
  double mean_;
  Eigen::MatrixXd places_;
  Eigen::VectorXd values_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd weights_;  ///< C^-1 (values - mean)
};

/// The most likely one, with the average of the values as mean and lengths in [0.15, 20] of the range of each input.
/// An input that never varies plays no part. \param noise  variance by point
GaussianProcess fit_gaussian_process(Eigen::MatrixXd const& places, Eigen::VectorXd const& values,
                                     Eigen::VectorXd const& noise);

/// Logarithms of (sd, lengths) between which the most likely kernel is looked for, and two starts. \param sd  typical
struct KernelBox {
  KernelBox(double sd, Eigen::VectorXd const& range);
  Matern at(Eigen::VectorXd const& logarithms) const;
  Eigen::VectorXd lower, upper;
  std::vector<Eigen::VectorXd> starts;
};

}  // namespace layerloop::validation
