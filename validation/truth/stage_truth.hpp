#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "validation/candidate.hpp"
#include "validation/study.hpp"
#include "validation/truth/hidden_cause.hpp"

namespace layerloop::validation {

/// How the stages tell the truth: on another mesh than the case of a study, and with other grains.
struct StageTruth {
  std::filesystem::path cache;
  std::map<std::string, double> resolution;  ///< case key -> value [SI], of cells, steps and rays
  std::int64_t beds = 1;                     ///< that are measured and averaged
};

/// Values of a study's observables as the world has them [SI]: runs of the stages with the causes in them. An effect is
/// that of the catalogue, or of another form: cohesion by Derjaguin, Muller and Toporov instead of SJKR2, rolling
/// resistance as a spring cut at its torque instead of a constant torque, another frequency of the blade, an oxide of
/// one index at all wavelengths, flow that also mixes downwards, latent heat spread over 400 K, a conductivity linear
/// in temperature. What no catalogue holds acts on the conditions.
/// \param calibration  true values by Study::calibration \param seed  of grains and rays
Eigen::VectorXd stage_truth(StageTruth const& how, Study study, std::vector<Candidate> const& candidates,
                            Eigen::VectorXd const& calibration, std::vector<HiddenCause> const& causes,
                            std::uint64_t seed);

/// Whether there is another form of an effect than the catalogue's.
bool has_other_stage_form(std::string const& effect);

}  // namespace layerloop::validation
