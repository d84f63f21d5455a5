#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "validation/diagnosis.hpp"
#include "validation/refit.hpp"

namespace layerloop::validation {

/// An effect that is to be added, by the name of its candidate.
struct AddedEffect {
  std::string name;
  double strength = 0, u_strength = 0;
};

/// What an explanation found, to start from.
struct Addition {
  std::vector<AddedEffect> effects;
  std::map<std::string, double> calibration_without = {},
                                calibration_with = {};  ///< by parameter; missing: its prior mean
  double sigma2 = 1;                                    ///< square of the factor on all uncertainties
};

/// A model without and with effects, both calibrated on the same data, with the same freedom, mesh and random numbers.
struct BeforeAfter {
  Study study;  ///< with the observations that the model answers
  Fit as_it_stands, before, after;
  double chi2_base = 0, chi2_before = 0, chi2_after = 0;  ///< over sigma^2
  double dof = 0;                                         ///< after
  std::vector<AddedEffect> effects;                       ///< with the strengths found anew
  ObservationTable table;  ///< without signatures; residuals over their standard uncertainties, not projected
};

/// \param candidates  all that the diagnosis had, so that the mesh is the same \param seeds  set of seeds
/// \throws InputError an effect is not among the candidates; PhysicsError
BeforeAfter before_and_after(Study study, Model& model, std::vector<Candidate> const& candidates,
                             Addition const& addition, std::uint64_t seeds);

/// Index of every effect among the candidates. \throws InputError  names those that are not there, with a suggestion
std::vector<std::size_t> indices_of(std::vector<AddedEffect> const& effects, std::vector<Candidate> const& candidates);

/// What model and measurement of some observations look like at three fits.
ObservationTable observation_table(Study const& study, Prediction const& base, Prediction const& before,
                                   Prediction const& after, double sigma2);

/// The study without the observations that one of the predictions has no answer for.
Study answered_by_all(Study study, std::vector<Prediction> const& predictions);

}  // namespace layerloop::validation
