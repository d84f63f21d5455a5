#pragma once
#include <cstdint>
#include <vector>

#include "validation/diagnosis.hpp"
#include "validation/pattern.hpp"
#include "validation/refit.hpp"
#include "validation/signature.hpp"

namespace layerloop::validation {

/// Whether a fit leaves nothing that needs a cause.
struct Adequacy {
  double chi2 = 0, dof = 0, p = 1;       ///< in units of sigma^2
  std::vector<PatternFinding> patterns;  ///< strongest first
  double pattern_critical = 0;
  bool ok = true;
};

/// How every candidate's signature lies in what calibration and the active candidates leave of the residual.
struct CandidateScores {
  Eigen::VectorXd z;          ///< by candidate; 0 where not testable or active
  Eigen::VectorXd direction;  ///< sign of the strength: -1 only where it is two-sided
  Eigen::VectorXd reach;      ///< norm of the projected signature over sigma: z for one prior scale
  Eigen::VectorXd kept;       ///< share of the squared signature that is left
  Eigen::MatrixXd cosines;
  double critical = 0;  ///< that a false candidate passes with Thresholds::family_error
};

/// A candidate and what the model reaches with it in the place of the chosen one.
struct Trial {
  std::size_t candidate = 0;
  Fit fit;
  double standing = 0;  ///< -2 ln of likelihood times prior: the least is the best
};

struct Selection {
  Fit fit;                                 ///< with the active candidates
  std::vector<std::vector<Trial>> trials;  ///< by active candidate: it and its rivals, best first
  Signatures signatures;                   ///< at the fit that the last choice was made from
  CandidateScores scores;                  ///< of that
  Adequacy adequacy;                       ///< of the fit
};

/// What a diagnosis works with at every step.
struct Workbench {
  Model& model;
  std::vector<Candidate> const& candidates;
  ResidualFrame const& frame;
  Patterns const& patterns;
  LargestNull pattern_null;
  Thresholds const& thresholds;
  double sigma2 = 1;
  std::uint64_t seed = 0;

  Refit refit() const { return {model, candidates, frame, sigma2}; }
  /// Standard deviation of what two refits differ by in -2 ln L because grains fall otherwise each time; 0: they do
  /// not.
  double luck(Fit const& fit) const;
  /// What claims are projected on: free of all that calibration and active candidates can do.
  Projection projection(Fit const& fit) const;
};

Adequacy adequacy_of(Workbench const& bench, Fit const& fit);
/// The same without a look at patterns: chi2, dof and p alone.
Adequacy chi2_of(Workbench const& bench, Fit const& fit);
Structure structure_of(Workbench const& bench, Fit const& fit);
CandidateScores score_candidates(Workbench const& bench, Fit const& fit, Signatures const& signatures);

/// Forward selection by nonlinear refits: the best candidate joins if it passes the family-wise level, those that
/// became superfluous leave, until nothing is left to explain; then every choice is tried against its rivals once more.
/// From the calibrated fit, with what was found out about it already.
Selection select_candidates(Workbench const& bench, Fit calibrated, Signatures signatures, CandidateScores scores,
                            Adequacy before);

}  // namespace layerloop::validation
