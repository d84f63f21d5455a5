#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "validation/next_experiment.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// One reading of a quantity: what about it averages out over replicates, and what does not; relative.
struct ReadingError {
  double random = 0.05, shared = 0;  ///< where the study has no reading of it
};
/// The usual one of a study.
ReadingError reading_error(Study const& study, std::string const& quantity);

/// The data as they are, for every pair of the best explanation with a rival.
struct Standing {
  std::vector<Eigen::VectorXd> difference;   ///< by rival, the first is the best one: unused
  std::vector<Eigen::MatrixXd> derivatives;  ///< by rival
};

/// Quantities to be read under one condition or several, and what the rivals say of them.
struct Proposal {
  std::vector<std::size_t> conditions;      ///< (readings), of the grid
  std::vector<std::string> quantities;      ///< (readings)
  std::vector<Eigen::VectorXd> value;       ///< by rival: (readings)
  std::vector<Eigen::MatrixXd> derivative;  ///< by rival: (readings, free numbers)

  bool is_known() const;  ///< every rival has an answer
};
/// Both.
Proposal joined(Proposal one, Proposal const& other);

/// How many readings of each quantity tell the rivals apart. \param sigma  factor on all uncertainties
NextExperiment judged(Proposal const& proposal, std::vector<Condition> const& grid, Standing const& now,
                      Study const& study, double sigma, std::vector<std::string> const& rivals);
/// Readings beyond which nothing is proposed; judged() says one more then.
inline constexpr int most_replicates = 20;

/// Fewer readings, places, quantities; then the larger separation.
bool better(NextExperiment const& a, NextExperiment const& b);

}  // namespace layerloop::validation
