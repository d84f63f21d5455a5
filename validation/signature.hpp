#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "validation/refit.hpp"

namespace layerloop::validation {

/// What every candidate does to the observations, seen through a frame, for one prior scale of its strength: a secant
/// with the same random numbers with and without, so that thresholds are caught and grains cancel.
struct Signatures {
  Eigen::MatrixXd columns;                ///< (observations, candidates); zero where there is none
  std::vector<std::string> not_testable;  ///< by candidate: why there is none; empty: tested
};

/// Probes every candidate at its prior scale, further where it does nothing yet, nearer where the model has no answer.
Signatures probe_candidates(Model& model, std::vector<Candidate> const& candidates, ResidualFrame const& frame,
                            Fit const& fit);

/// The same for some of them at another fit, where they stand for a little else.
void probe_again(Model& model, std::vector<Candidate> const& candidates, ResidualFrame const& frame, Fit const& fit,
                 std::vector<std::size_t> const& which, Signatures& signatures);

}  // namespace layerloop::validation
