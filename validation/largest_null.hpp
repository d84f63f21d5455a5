#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace layerloop::validation {

/// How large the largest of many correlated normal scores gets when nothing is there: family-wise levels (Westfall &
/// Young, Resampling-Based Multiple Testing, 1993, max-T).
class LargestNull {
 public:
  LargestNull() = default;  ///< of nothing
  /// \param directions  (n, m) unit columns that unit noise is scored along
  /// \param two_sided   by column: |score| counts, else the score
  LargestNull(Eigen::MatrixXd const& directions, std::vector<bool> const& two_sided, std::uint64_t seed);
  double critical(double family_error) const;  ///< passed with this probability
  /// Of a largest score as high as this; beyond the draws by Sidak's rule with as many independent scores as match
  /// their 95 % level.
  double p(double score) const;

 private:
  std::vector<double> draws_;  ///< ascending
  double independent_ = 1;
};

/// Independent standard normal numbers, a pure function of seed and id (Box & Muller 1958). Shape: n.
Eigen::VectorXd standard_normal(Eigen::Index n, std::uint64_t seed, std::uint64_t id);

}  // namespace layerloop::validation
