#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "validation/candidate.hpp"
#include "validation/model.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// What is the matter with the model. CONFOUNDED: the effect varies only with a label, so that the data cannot tell it
/// from that. The names are those of the summary.
enum class Verdict {
  CONSISTENT,
  CALIBRATION,
  NOISE,
  IDENTIFIED,
  GROUP,
  IDENTIFIED_FORM_IMPERFECT,
  PARTIAL,
  UNKNOWN,
  CONFOUNDED,
  NUMERICS,
  INSTRUMENT
};
std::string const& name_of(Verdict verdict);

/// Frozen on a development set; docs/find-the-missing-effect.md tells how. Nothing else in the diagnosis can be tuned.
struct Thresholds {
  double family_error = 0.005;  ///< of any false candidate, and of any false pattern
  double adequate_p = 1e-3;     ///< of chi2 after
  double rival_gap = 6;         ///< of -2 ln L, within which rivals are one group
  double drop_z = 2.5;          ///< below it an active effect is dropped
  double outlier_z = 3.9;       ///< under the permissive model
  double outlier_share = 0.05;  ///< of the observations, at most
  double noisy_scale = 1.35;    ///< of sigma^2, above which the noise is called understated
  double large_pull = 3;        ///< of a calibration number
  double whole = 0.9;           ///< share of the structure that a name must take if what it leaves is not noise
  double structure_p = 0.01;    ///< of what one name leaves of the structure
  double several_p = 0.16;      ///< the same of several names: each of them may stand for a share of something else
  double twin_cosine = 0.95;    ///< of signatures, above which no statistics can tell two candidates apart
  int most_effects = 3;         ///< tried; as many as that are no explanation
  double least_share = 0.05;    ///< of the excess chi2 that a further effect must take: less is the form of the first
  int refitted_candidates = 4;  ///< candidates tried by a nonlinear refit at each step of the selection
  /// Switched off in ablations only.
  bool projects = true, gates = true, refits = true, scales = true;
};

/// Parts of the answer that come from a candidate, effect or not.
struct CandidateFinding {
  std::string name;
  EffectStage stage = EffectStage::heat;
  EffectClass kind = EffectClass::physics;
  std::string not_testable = {};        ///< why not; empty: tested
  double strength = 0, u_strength = 0;  ///< refitted where it was, else from the signature
  double z = 0;                         ///< of the signature in what calibration leaves
  double evidence = 0;                  ///< ln of the Bayes factor against nothing
  double kept_fraction = 0;             ///< of the signature that calibration cannot swallow
  double detectable = 0;                ///< strength that would be found in nine of ten studies like this
  double chi2_after = 0;                ///< with this candidate alone, refitted; not a number where it was not
  bool active = false;                  ///< in the final model
  std::vector<std::string> group = {};  ///< candidates that these data cannot separate from it, when active
  std::vector<std::string> twins = {};  ///< candidates with nearly the same signature
};

/// A pattern of the residuals without physics: a yardstick, and words for what is left.
struct PatternFinding {
  std::string text;     ///< "pool.depth rises with laser.power"
  double z = 0, p = 1;  ///< p over the whole family
};

/// All smooth patterns together: faint structure that none of them shows by itself.
struct Structure {
  double excess = 0;  ///< sum of their squared scores less what noise leaves of it
  double p = 1;       ///< that noise alone reaches it
};

struct ParameterFinding {
  std::string name;
  double mean = 0, sd = 0, value = 0, u = 0, pull = 0;  ///< pull: (value - mean) / sqrt(sd^2 + u^2)
};

struct OutlierFinding {
  std::string obs_id;
  double z = 0;
};

/// Vectors by observation, for pictures and tables.
struct ObservationTable {
  std::vector<std::size_t> rows;  ///< of the study's observations: those that the model has an answer for
  Eigen::VectorXd measured, base, calibrated, final_model;  ///< [SI]
  Eigen::VectorXd u_data, u_model;                          ///< standard uncertainties [SI]
  Eigen::VectorXd residual_before, residual_after;          ///< projected, in units of their standard deviation
  /// (observations, candidates) change of the prediction per prior scale, in units of u; what calibration leaves of it.
  Eigen::MatrixXd signatures;
};

struct Diagnosis {
  Verdict verdict = Verdict::CONSISTENT;
  std::string sentence;                                         ///< the verdict in words
  std::vector<CandidateFinding> effects;                        ///< the active ones first, then by evidence
  std::vector<PatternFinding> patterns_before, patterns_after;  ///< strongest first
  std::vector<ParameterFinding> parameters;
  std::vector<OutlierFinding> outliers;
  std::vector<std::string> limits;                        ///< what these data cannot tell
  double chi2_base = 0, chi2_before = 0, chi2_after = 0;  ///< as the case stands; calibrated; with the active effects
  double dof = 0, sigma2 = 1;                             ///< sigma2: square of the factor on all uncertainties
  double explained = 0;                                   ///< share of the structure that the active effects take away
  Structure structure_after{};                            ///< what they leave of it
  double smooth_explained = 0;  ///< the same of any smooth correction, left out condition by condition
  double z_critical = 0, pattern_critical = 0;
  std::vector<std::string> candidate_names;
  Eigen::MatrixXd cosines;  ///< between projected signatures, by candidate
  ModelPoint calibrated, final_point;
  ObservationTable table;
  double passes = 0;  ///< model_runs: passes over the data
};

/// Which physics is missing. The procedure: calibrate, project what calibration can do out of everything, look for
/// structure, probe every candidate, refit the best ones with the model itself, and pass the gate.
/// \pre the study holds training data alone
Diagnosis diagnose(Study const& study, Model& model, std::vector<Candidate> const& candidates,
                   Thresholds const& thresholds, std::uint64_t seed);

}  // namespace layerloop::validation
